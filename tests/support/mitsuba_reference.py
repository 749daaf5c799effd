"""Renders a scene with Mitsuba 3 once per seed and writes all images, for the tests to judge their spread.

The output is raw little-endian 32-bit floats, image after image, row by row from the top, R, G, B per pixel.
"""

import argparse

import mitsuba
import numpy

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("scene")
parser.add_argument("output")
parser.add_argument("--variant", required=True)
parser.add_argument("--seeds", type=int, required=True, help="number of independent renders")
parser.add_argument("--spp", type=int, required=True, help="samples per pixel of each render")
parser.add_argument("--max-depth", type=int, help="of the path integrator, instead of what the scene says")
parser.add_argument("-D", dest="definitions", action="append", default=[], metavar="NAME=VALUE")
arguments = parser.parse_args()

mitsuba.set_variant(arguments.variant)
definitions = dict(definition.split("=", 1) for definition in arguments.definitions)
scene = mitsuba.load_file(arguments.scene, **definitions)
integrator = scene.integrator()
if arguments.max_depth is not None:
    integrator = mitsuba.load_dict({"type": "path", "max_depth": arguments.max_depth})
with open(arguments.output, "wb") as output:
    # Seeds far apart: how Mitsuba makes streams of random numbers from them is its own affair.
    for seed in numpy.random.SeedSequence(0).generate_state(arguments.seeds).tolist():
        image = mitsuba.render(scene, integrator=integrator, spp=arguments.spp, seed=seed)
        rgb = numpy.array(image, dtype="<f4")[:, :, :3]
        output.write(numpy.ascontiguousarray(rgb).tobytes())
