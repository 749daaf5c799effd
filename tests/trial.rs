//! What was learned is tried before it is relied on.

mod support;

use std::num::{NonZeroU32, NonZeroU64, NonZeroUsize};
use std::sync::Arc;
use std::time::Duration;

use cohort::learning::Reliance;
use cohort::render::{Budget, ColourMode, Outcome, Render, Settings, StopFlag};
use cohort::sampling::SamplerKind;
use cohort::scene::{LoadOptions, Scene};
use cohort::walk::{StrategyKind, StrategyOptions};

use support::files;
use support::room::{View, room};

fn settings(kind: StrategyKind, threads: usize) -> Settings {
    let strategy = kind.build(&StrategyOptions::default());
    Settings {
        strategy: strategy.expect("defaults are valid"),
        sampler: SamplerKind::ArrayQmc,
        guiding: true,
        trial: true,
        colour: ColourMode::Rgb,
        threads: NonZeroUsize::new(threads).expect("not zero"),
        // A budget of time has no end of its own.
        budget: Budget::Time(Duration::MAX),
        ..Settings::default()
    }
}

fn scene(path: &str, definition: &str, side: u32) -> Arc<Scene> {
    let options = LoadOptions {
        definitions: vec![(definition.into(), side.to_string())],
        models: None,
    };
    let scene = Scene::load(files::of_project(path), &options);
    Arc::new(scene.expect("the scene can be loaded"))
}

fn render(scene: &Arc<Scene>, settings: Settings, samples: u32) -> Outcome {
    let until = Budget::SamplesPerPixel(NonZeroU32::new(samples).expect("not zero"));
    let render = Render::new(Arc::clone(scene), settings).expect("the scene can be rendered");
    let mut state = render.start(7);
    let ended = render.advance(&mut state, until, &StopFlag::new(), &());
    state.into_outcome(ended)
}

/// A lamp that faces the ceiling: nearly all light arrives from a few directions that only guiding finds.
fn indirect() -> Arc<Scene> {
    let view = View {
        side: 64,
        field_of_view: 70,
        origin: "-0.9, 0, 0",
        target: "1, -0.3, 0.2",
    };
    let lamp = r#"<rotate x="1" angle="-90"/><translate x="0.6" y="0.9" z="0.6"/>"#;
    room(&view, lamp, "")
}

/// Under the sky of the same radiance everywhere, on a plane: light that next-event estimation finds in one step.
const OPEN: &str = r#"<scene version="3.0.0">
    <integrator type="path"/>
    <sensor type="perspective">
        <float name="fov" value="40"/>
        <transform name="to_world"><lookat origin="0, 3, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="64"/><integer name="height" value="64"/><rfilter type="box"/></film>
    </sensor>
    <shape type="rectangle">
        <transform name="to_world"><scale value="20"/><rotate x="1" angle="-90"/></transform>
        <bsdf type="diffuse"><float name="reflectance" value="0.5"/></bsdf>
    </shape>
    <emitter type="constant"><float name="radiance" value="1"/></emitter>
</scene>"#;

fn of_xml(xml: &str) -> Arc<Scene> {
    let scene = Scene::from_xml(xml, &LoadOptions::default());
    Arc::new(scene.expect("the scene can be loaded"))
}

/// 64 x 64 pixels are 16 tiles, half of which are tried: guiding alone costs 64 samples and is tried from 512 on, where passes have grown to 128.
const ENOUGH: u32 = 1024;

#[test]
fn guiding_is_kept_where_it_pays_and_left_aside_where_it_does_not() {
    let relied_on = |scene| render(&scene, settings(StrategyKind::Roulette, 2), ENOUGH).reliance;
    let reliance = |guiding| {
        Some(Reliance {
            counts: false,
            guiding,
        })
    };
    assert_eq!(relied_on(indirect()), reliance(true));
    assert_eq!(relied_on(of_xml(OPEN)), reliance(false));
}

/// What is rendered aside does not become part of the image: where everything is relied on, the image is that of a render that does not try.
#[test]
fn a_trial_leaves_no_trace_in_the_image() {
    let scene = indirect();
    let tried = render(
        &scene,
        settings(StrategyKind::ParticleFilter, 2),
        2 * ENOUGH,
    );
    assert_eq!(tried.reliance, Some(Reliance::ALL));
    let untried = Settings {
        trial: false,
        ..settings(StrategyKind::ParticleFilter, 2)
    };
    let untried = render(&scene, untried, 2 * ENOUGH);
    assert_eq!(untried.reliance, None);
    assert!(tried.film == untried.film, "the images differ");
    assert_eq!(
        tried.statistics.camera_paths,
        untried.statistics.camera_paths
    );
    assert!(tried.statistics.rays > untried.statistics.rays);
}

#[test]
fn the_number_of_threads_and_interruptions_change_no_verdict() {
    let scene = scene("scenes/gallery/plastic.xml", "size", 40);
    const SAMPLES: u32 = 2 * ENOUGH + 300;
    let all = |threads| {
        let settings = settings(StrategyKind::ParticleFilter, threads);
        render(&scene, settings, SAMPLES)
    };
    let one = all(1);
    assert!(one.reliance.is_some(), "nothing was tried");
    let two = all(2);
    assert_eq!(two.reliance, one.reliance);
    assert!(two.film == one.film, "the images differ");

    // In slices of rays, most of which end within a pass, and some within the trial, which takes a twelfth of them.
    let sliced = settings(StrategyKind::ParticleFilter, 2);
    let sliced = Render::new(Arc::clone(&scene), sliced).expect("the scene can be rendered");
    let mut state = sliced.start(7);
    let slice = one.statistics.all_rays() / 40;
    for slices in 1..=39 {
        let rays = NonZeroU64::new(slices * slice).expect("not zero");
        sliced.advance(&mut state, Budget::Rays(rays), &StopFlag::new(), &());
    }
    let rest = Budget::SamplesPerPixel(NonZeroU32::new(SAMPLES).expect("not zero"));
    let ended = sliced.advance(&mut state, rest, &StopFlag::new(), &());
    let in_slices = state.into_outcome(ended);
    assert_eq!(in_slices.reliance, one.reliance);
    assert!(in_slices.film == one.film, "the images differ");
    assert_eq!(in_slices.statistics.rays, one.statistics.rays);
}
