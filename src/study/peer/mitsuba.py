"""Renders one scene with Mitsuba 3, chunk by chunk, for the program that started it.

Every request is one line of JSON on standard input, every reply one line of JSON on standard output. A reply about a
rendered chunk is followed by the image: width x height x 3 little-endian 32-bit floats, row by row from the top. The
module `wire` is the other side. The process ends when its standard input does.
"""

import json
import os
import signal
import sys
import time

# Whoever interrupts the study wants its state kept: the parent decides when this process ends.
signal.signal(signal.SIGINT, signal.SIG_IGN)

# Mitsuba and its plugins may print: the replies get a stream of their own, and everything else goes to standard error.
replies = os.fdopen(os.dup(1), "wb")
os.dup2(2, 1)


def reply(kind, image=b"", **fields):
    replies.write(json.dumps({"reply": kind, **fields}).encode() + b"\n" + image)
    replies.flush()


def requests():
    for line in sys.stdin:
        yield json.loads(line)


class Refused(Exception):
    """Something that the person who started the study can put right."""

    def __init__(self, kind, **fields):
        super().__init__(kind)
        self.kind, self.fields = kind, fields


def import_packages():
    global dr, mi, numpy
    try:
        import drjit as dr
        import mitsuba as mi
        import numpy
    except ImportError as error:
        raise Refused("no-package", message=str(error))
    if not hasattr(mi, "parser"):
        raise Refused("too-old", version=mi.__version__)


def set_variant(name, threads):
    if name not in mi.variants():
        raise Refused("unknown-variant", offered=mi.variants())
    # Dr.Jit's pool is the one that all variants render with; the calling thread counts as one of it.
    dr.set_thread_count(threads)
    try:
        mi.set_variant(name)
    except ImportError as error:
        raise Refused("unusable-variant", message=str(error))
    mi.set_log_level(mi.LogLevel.Warn)


def load(path, definitions, width, height, max_depth):
    """The scene, with the size of its film and the depth of its paths replaced before anything is made of them."""
    config = mi.parser.ParserConfig(mi.variant())
    # Cohort has read the same file and judged them.
    config.unused_parameters = mi.LogLevel.Debug
    # Files that the scene names lie beside it.
    mi.file_resolver().prepend(os.path.dirname(os.path.abspath(path)))
    try:
        state = mi.parser.parse_file(config, path, **definitions)
        mi.parser.transform_all(config, state)
        for node in state.nodes:
            if node.type == mi.ObjectType.Film:
                for key in [key for key in node.props.keys() if key.startswith("crop_")]:
                    del node.props[key]
                node.props["width"] = width
                node.props["height"] = height
                # What is compared is linear sRGB, whatever the scene wants in its file.
                node.props["pixel_format"] = "rgb"
            elif node.type == mi.ObjectType.Integrator and max_depth is not None:
                node.props["max_depth"] = max_depth
        scene = mi.parser.instantiate(config, state)
    except Exception as error:
        raise Refused("bad-scene", message=str(error))
    scene = scene[0] if isinstance(scene, list) else scene
    size = tuple(scene.sensors()[0].film().size()) if scene.sensors() else None
    if size != (width, height):
        raise Refused("bad-scene", message="its first sensor must state a film, so that its size can be set")
    return scene


def render(scene, spp, seed):
    """The image as bytes, the samples per pixel that the scene's sampler made of those asked for, and the seconds."""
    sampler = scene.sensors()[0].sampler().clone()
    sampler.set_sample_count(spp)
    try:
        start = time.perf_counter()
        image = mi.render(scene, spp=spp, seed=seed)
        dr.eval(image)
        dr.sync_thread()
        seconds = time.perf_counter() - start
    except Exception as error:
        raise Refused("cannot-render", message=str(error))
    pixels = numpy.array(image, dtype="<f4")
    if pixels.ndim != 3 or pixels.shape[2] != 3:
        message = f"its images have the shape {pixels.shape} instead of three channels"
        raise Refused("bad-scene", message=message)
    return numpy.ascontiguousarray(pixels).tobytes(), sampler.sample_count(), seconds


def start(variant, threads, scene, definitions, width, height, max_depth):
    import_packages()
    set_variant(variant, threads)
    scene = load(scene, definitions, width, height, max_depth)
    # Dr.Jit compiles one kernel for 1 sample per pixel, another for powers of two and another for other numbers.
    for spp in (1, 2, 3):
        render(scene, spp, seed=0)
    _, spp, seconds = render(scene, 4, seed=0)
    reply("started", mitsuba=mi.__version__, drjit=dr.__version__, seconds_per_sample=seconds / spp)
    return scene


def serve():
    incoming = requests()
    scene = start(**next(incoming))
    for request in incoming:
        image, spp, seconds = render(scene, **request)
        reply("rendered", image, spp=spp, seconds=seconds)


try:
    serve()
except Refused as refused:
    reply(refused.kind, **refused.fields)
