//! Adaptive renders: the same image as with even counts, whatever was seen before, with less noise for as many paths, and the same bits in slices.

mod support;

use std::num::{NonZeroU32, NonZeroU64, NonZeroUsize};
use std::sync::Arc;

use cohort::film::Film;
use cohort::render::{Budget, ColourMode, Ended, Render, RenderState, Settings, StopFlag};
use cohort::sampling::SamplerKind;
use cohort::scene::{LoadOptions, Scene};
use cohort::transport::DirectLight;
use cohort::walk::{Objective, StrategyKind, StrategyOptions};

use support::estimate::{Estimate, sidak_threshold};
use support::render::{many_emitters, replicates, replicates_with_rare_highlights};
use support::replicates::Replicates;
use support::room::{View, room};

fn settings(strategy: StrategyKind, sampler: SamplerKind) -> Settings {
    let objective = (strategy == StrategyKind::Ears).then_some(Objective::Mse);
    let options = StrategyOptions {
        objective,
        ..StrategyOptions::default()
    };
    Settings {
        strategy: strategy.build(&options).expect("the settings are valid"),
        sampler,
        adaptive: true,
        ..Settings::default()
    }
}

const CASES: [(StrategyKind, SamplerKind, bool); 5] = [
    (StrategyKind::Roulette, SamplerKind::Independent, false),
    (StrategyKind::Roulette, SamplerKind::Sobol, true),
    (
        StrategyKind::PaperParticleFilter,
        SamplerKind::ArrayQmc,
        false,
    ),
    (StrategyKind::Ears, SamplerKind::ArrayQmc, true),
    (StrategyKind::ParticleFilter, SamplerKind::ArrayQmc, true),
];

/// Without next-event estimation lamps are found by rare paths: pixels that have not found one yet seem to have no noise. If what they get less of weighed
/// less, the image would be too dark.
#[test]
fn what_was_seen_before_has_no_say_in_the_mean() {
    let view = View {
        side: 24,
        field_of_view: 60,
        origin: "0, -0.2, -0.95",
        target: "0, -0.3, 0",
    };
    let lamp = r#"<rotate x="1" angle="90"/><translate y="0.95" z="-0.3"/>"#;
    // Half of the wall that is seen.
    let dark = r#"<shape type="rectangle">
        <transform name="to_world"><scale x="0.5"/><rotate y="1" angle="180"/><translate x="0.5" z="0.99"/></transform>
        <bsdf type="diffuse"><float name="reflectance" value="0.05"/></bsdf>
    </shape>"#;
    let scenes = [
        (many_emitters(24), DirectLight::NextEvent),
        (room(&view, lamp, dark), DirectLight::Off),
    ];
    for (scene, direct_light) in scenes {
        let plain = {
            let settings = Settings {
                adaptive: false,
                colour: ColourMode::Rgb,
                direct_light,
                ..settings(StrategyKind::Roulette, SamplerKind::Independent)
            };
            replicates_with_rare_highlights(&scene, settings, 0..128, 128)
        };
        for (strategy, sampler, guiding) in CASES {
            let settings = Settings {
                guiding,
                colour: ColourMode::Rgb,
                direct_light,
                ..settings(strategy, sampler)
            };
            let adaptive = replicates_with_rare_highlights(&scene, settings, 1000..1128, 64);
            // Of the whole image, which tells most, and of its parts.
            let estimates = |images: &Replicates| -> Vec<Estimate> {
                [24, 8]
                    .iter()
                    .flat_map(|&side| images.blocks(side).concat())
                    .collect()
            };
            let (adaptive, plain) = (estimates(&adaptive), estimates(&plain));
            let pairs = adaptive.iter().zip(&plain);
            let limit = sidak_threshold(1e-3, 2 * CASES.len() * pairs.clone().count());
            let mut largest = 0.0_f64;
            for (one, other) in pairs {
                let z = one.z_of_difference(other);
                largest = largest.max(z.abs());
                assert!(
                    z.abs() < limit,
                    "{strategy}, {sampler}: {one:?} {other:?}, z = {z}"
                );
            }
            println!(
                "{strategy}, {sampler}, {direct_light:?}: |z| up to {largest:.2} of {limit:.2}"
            );
        }
    }
}

/// A lamp beside the edge of a screen: its half shadow is noisy, all the rest is not.
const HALF_SHADOW: &str = r#"<scene version="3.0.0">
    <integrator type="path"><integer name="max_depth" value="2"/></integrator>
    <sensor type="perspective">
        <float name="fov" value="40"/>
        <transform name="to_world"><lookat origin="0 0 5" target="0 0 0" up="0 1 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="32"/><integer name="height" value="32"/><rfilter type="box"/></film>
    </sensor>
    <shape type="rectangle"><transform name="to_world"><scale value="3"/></transform></shape>
    <shape type="rectangle">
        <transform name="to_world"><scale x="3" y="3"/><rotate y="1" angle="90"/><translate z="4"/></transform>
    </shape>
    <shape type="rectangle">
        <transform name="to_world"><scale value="0.7"/><rotate y="1" angle="180"/><translate x="1.5" z="9"/></transform>
        <emitter type="area"><float name="radiance" value="100"/></emitter>
    </shape>
</scene>"#;

#[test]
fn noise_becomes_less_and_the_film_knows() {
    let scene = Scene::from_xml(HALF_SHADOW, &LoadOptions::default());
    let scene = Arc::new(scene.expect("the scene can be loaded"));
    for sampler in [SamplerKind::Independent, SamplerKind::ArrayQmc] {
        let noise = |adaptive| -> f64 {
            let options = StrategyOptions {
                objective: Some(Objective::Mse),
                ..StrategyOptions::default()
            };
            let strategy = StrategyKind::ParticleFilter.build(&options);
            let settings = Settings {
                strategy: strategy.expect("the settings are valid"),
                adaptive,
                colour: ColourMode::Rgb,
                ..settings(StrategyKind::Roulette, sampler)
            };
            // What the film believes in is checked where numbers are independent; of others it is an upper estimate.
            let images = match sampler {
                SamplerKind::Independent => replicates(&scene, settings, 0..48, 256),
                _ => replicates_with_rare_highlights(&scene, settings, 0..48, 256),
            };
            let pixels = images.blocks(1);
            pixels.iter().flatten().map(|pixel| pixel.variance).sum()
        };
        let [even, adaptive] = [false, true].map(noise);
        println!("{sampler}: {:.2} of the variance", adaptive / even);
        assert!(
            adaptive < 0.8 * even,
            "{sampler}: {adaptive} against {even}"
        );
    }
}

fn spp(samples: u32) -> Budget {
    Budget::SamplesPerPixel(NonZeroU32::new(samples).expect("there are samples"))
}

fn saved_and_loaded(state: &RenderState) -> RenderState {
    let bytes = postcard::to_stdvec(state).expect("a state can be written");
    postcard::from_bytes(&bytes).expect("a state can be read")
}

/// Four tiles, of which three are cut; the render pauses within passes, and is saved and loaded there.
#[test]
fn slices_and_threads_change_no_bit() {
    let render = |case: usize, threads| {
        let (strategy, sampler, guiding) = CASES[case];
        let settings = Settings {
            guiding,
            budget: spp(96),
            threads: NonZeroUsize::new(threads).expect("there is a thread"),
            ..settings(strategy, sampler)
        };
        Render::new(many_emitters(24), settings).expect("the scene can be rendered")
    };
    for (case, &(strategy, sampler, _)) in CASES.iter().enumerate() {
        let alone = render(case, 1);
        let mut at_once = alone.start(7);
        alone.advance(&mut at_once, spp(96), &StopFlag::new(), &());
        let samples = |film: &Film| film.pixels().map(|pixel| pixel.samples).sum::<u64>();
        assert_eq!(
            samples(at_once.film()),
            96 * 24 * 24,
            "{strategy}, {sampler}"
        );
        assert!(
            at_once.film().unequal_samples().is_some(),
            "{strategy}, {sampler}: all got as many"
        );
        let total = at_once.statistics().all_rays();
        for threads in [1, 2, 3] {
            let render = render(case, threads);
            let mut state = render.start(7);
            for slice in 1.. {
                let rays = NonZeroU64::new(slice * total / 23 + 1).expect("there are rays");
                let ended = render.advance(&mut state, Budget::Rays(rays), &StopFlag::new(), &());
                state = saved_and_loaded(&state);
                if ended == Ended::Complete {
                    break;
                }
            }
            assert!(
                state.film() == at_once.film(),
                "{strategy}, {sampler}: {threads} threads"
            );
        }
    }
}
