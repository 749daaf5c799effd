//! Mitsuba as a competitor: the same image, the budget met, and errors that say what is wrong.
//!
//! Variants that compile are tested where there is an LLVM for them.

mod support;

use std::num::{NonZeroU32, NonZeroUsize};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

use cohort::film::Image;
use cohort::render::{Budget, ColourMode, Render, Settings, StopFlag};
use cohort::scene::{ImageSize, LoadOptions, Scene};
use cohort::study::peer::{
    MitsubaPeer, PYTHON, PeerError, PeerSpec, PeerState, PeerTarget, SeedSequence,
};

use support::files;

/// Not the size that the scene states, nor its aspect; and no multiple of a block.
const SIZE: ImageSize = ImageSize {
    width: 36,
    height: 48,
};

/// Whether Mitsuba is there; if not, says loudly that `what` is skipped.
fn is_there(what: &str) -> bool {
    let named = std::env::var_os(PYTHON).is_some();
    if !named {
        let why = format!("{PYTHON} does not name a Python with the package mitsuba");
        files::say_skipped(what, &why);
    }
    named
}

fn spec(variant: &str, scene: &Path) -> PeerSpec {
    PeerSpec {
        variant: variant.parse().expect("a name of a variant"),
        scene: scene.to_owned(),
        definitions: vec![("unused".into(), "1".into())],
        size: SIZE,
        threads: NonZeroUsize::MIN,
        max_depth: Some(4),
    }
}

fn camera() -> PathBuf {
    files::of_project("tests/scenes/camera.xml")
}

/// A peer, or `None` after saying loudly that there is no LLVM for it.
fn start(variant: &str) -> Option<MitsubaPeer> {
    match MitsubaPeer::start(spec(variant, &camera())) {
        Err(error @ PeerError::UnusableVariant { .. }) => {
            files::say_skipped(variant, &error.to_string());
            None
        }
        started => Some(started.expect("the scene can be loaded")),
    }
}

fn ours(samples: u32) -> Image {
    let mut scene = Scene::load(camera(), &LoadOptions::default()).expect("a scene");
    let (width, height) = (i64::from(SIZE.width), i64::from(SIZE.height));
    scene.film = scene.film.resized(width, height).expect("a size");
    let settings = Settings {
        colour: ColourMode::Rgb,
        max_depth: NonZeroU32::new(4),
        budget: Budget::SamplesPerPixel(NonZeroU32::new(samples).expect("samples")),
        ..Settings::default()
    };
    let render = Render::new(Arc::new(scene), settings).expect("it can be rendered");
    render.run(&StopFlag::new(), &()).film.image()
}

/// The mean of each channel of each block of 12 x 12 pixels.
fn blocks(image: &Image) -> Vec<f64> {
    let side = 12;
    let mut means = Vec::new();
    for y in (0..SIZE.height).step_by(side) {
        for x in (0..SIZE.width).step_by(side) {
            for channel in 0..3 {
                let sum: f64 = (0..side * side)
                    .map(|i| image.pixel(x + (i % side) as u32, y + (i / side) as u32)[channel])
                    .map(f64::from)
                    .sum();
                means.push(sum / (side * side) as f64);
            }
        }
    }
    means
}

#[test]
fn the_image_is_ours_whatever_the_variant() {
    if !is_there("images by a peer") {
        return;
    }
    let reference = blocks(&ours(2048));
    for variant in ["scalar_rgb", "llvm_ad_rgb"] {
        let Some(mut peer) = start(variant) else {
            continue;
        };
        let mut state = PeerState::new(SIZE, SeedSequence::new(SIZE, 1, 0, 1));
        let target = PeerTarget::SamplesPerPixel(1024);
        let stop = StopFlag::new();
        state.advance(&mut peer, target, &stop).expect("an image");
        assert_eq!(state.samples_per_pixel(), 1024);
        // A block has 147,456 samples: its mean is known to about 0.3 %.
        for (mean, expected) in blocks(&state.image()).iter().zip(&reference) {
            let deviation = mean / expected - 1.0;
            assert!(deviation.abs() < 0.02, "{variant}: {mean} for {expected}");
        }
    }
}

#[test]
fn files_beside_the_scene_are_found() {
    if !is_there("a peer whose scene names other files") {
        return;
    }
    let textures = files::of_project("scenes/gallery/textures.xml");
    let peer = MitsubaPeer::start(spec("scalar_rgb", &textures));
    peer.expect("the scene can be loaded");
}

#[test]
fn budgets_are_met_and_one_thread_is_one() {
    if !is_there("budgets of a peer") {
        return;
    }
    for variant in ["scalar_rgb", "llvm_ad_rgb"] {
        let Some(mut peer) = start(variant) else {
            continue;
        };
        let mut state = PeerState::new(SIZE, SeedSequence::new(SIZE, 1, 0, 1));
        let before = processor_seconds(peer.process());
        // In two turns, and through a file between them.
        for until in [1.0, 2.0] {
            let kept = serde_json::to_string(&state).expect("a state can be kept");
            state = serde_json::from_str(&kept).expect("and read");
            let target = PeerTarget::Seconds(until);
            let stop = StopFlag::new();
            state.advance(&mut peer, target, &stop).expect("an image");
            // 1 % of the whole; nobody can foretell how long a busy machine runs something else.
            let denied = state.seconds() - (processor_seconds(peer.process()) - before);
            let off = (state.seconds() - until).abs();
            assert!(
                off < 0.02 + denied.max(0.0),
                "{variant}: {} s",
                state.seconds()
            );
        }
        assert!(state.samples_per_pixel() > 20);
        // The transfer of images and the like are used beside the rendering.
        let used = processor_seconds(peer.process()) - before;
        assert!(
            used < 1.25 * state.seconds(),
            "{variant}: {used} s of processor time"
        );
    }
}

/// User and system time of a process, from /proc (in hundredths of a second).
fn processor_seconds(process: u32) -> f64 {
    let text = std::fs::read_to_string(format!("/proc/{process}/stat")).expect("a process");
    let after_name = text.rsplit(')').next().expect("fields");
    let fields: Vec<&str> = after_name.split_whitespace().collect();
    let ticks = |field: usize| fields[field].parse::<f64>().expect("a number");
    (ticks(11) + ticks(12)) / 100.0
}

#[test]
fn the_same_seeds_give_the_same_samples_and_others_do_not() {
    if !is_there("seeds of a peer") {
        return;
    }
    let Some(mut peer) = start("scalar_rgb") else {
        return;
    };
    let mut image = |seed| peer.render(4, seed).expect("an image").image;
    assert_eq!(image(5), image(5));
    assert_ne!(image(5), image(6));
}

#[test]
fn a_stop_ends_the_turn() {
    if !is_there("stopping a peer") {
        return;
    }
    let Some(mut peer) = start("scalar_rgb") else {
        return;
    };
    let mut state = PeerState::new(SIZE, SeedSequence::new(SIZE, 1, 0, 1));
    let stop = StopFlag::new();
    stop.raise();
    let target = PeerTarget::Seconds(1e6);
    state.advance(&mut peer, target, &stop).expect("no work");
    assert_eq!((state.samples_per_pixel(), state.seconds()), (0, 0.0));
}

fn message(spec: PeerSpec) -> String {
    MitsubaPeer::start(spec).expect_err("an error").to_string()
}

#[test]
fn errors_say_what_is_wrong() {
    if !is_there("errors of a peer") {
        return;
    }
    let text = message(spec("scalar_nonsense", &camera()));
    let start = "Mitsuba has no variant `scalar_nonsense`; this one has ";
    assert!(
        text.starts_with(start) && text.contains("scalar_rgb"),
        "{text}"
    );

    let text = message(spec("scalar_rgb", Path::new("no such scene.xml")));
    assert!(
        text.starts_with("Mitsuba cannot load no such scene.xml: "),
        "{text}"
    );
    assert!(text.contains("File not found"), "{text}");

    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("bad.xml");
    let scene = r#"<scene version="3.0.0"><shape type="spherical"/></scene>"#;
    std::fs::write(&path, scene).expect("a file");
    let text = message(spec("scalar_rgb", &path));
    assert!(
        text.contains(r#"shape plugin of type "spherical""#),
        "{text}"
    );
}

#[test]
fn a_process_that_dies_is_an_error() {
    if !is_there("a peer that dies") {
        return;
    }
    let Some(mut peer) = start("scalar_rgb") else {
        return;
    };
    let process = peer.process().to_string();
    let killed = Command::new("kill").args(["-9", &process]).status();
    assert!(killed.expect("kill").success());
    let error = peer.render(1, 0).expect_err("an error");
    assert!(matches!(error, PeerError::Died { .. }), "{error}");
    assert!(error.to_string().contains("signal: 9"), "{error}");
}
