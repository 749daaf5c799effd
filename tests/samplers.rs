//! Sobol points, and sorted populations with lattices: the same image as by independent numbers, by every strategy, with less noise.

mod support;

use std::num::{NonZeroU32, NonZeroUsize};
use std::sync::Arc;

use cohort::render::{Budget, Render, Settings, StopFlag};
use cohort::sampling::SamplerKind;
use cohort::walk::{StrategyKind, StrategyOptions};

use support::estimate::sidak_threshold;
use support::render::{many_emitters, replicates, replicates_in_growing_passes};
use support::replicates::Replicates;

fn settings(strategy: StrategyKind, sampler: SamplerKind) -> Settings {
    Settings {
        strategy: strategy
            .build(&StrategyOptions::default())
            .expect("defaults are valid"),
        sampler,
        // For the strategy that never ends a path.
        max_depth: NonZeroU32::new(12),
        ..Settings::default()
    }
}

/// The mean over pixels and channels of the variance between images.
fn noise(images: &Replicates) -> f64 {
    let blocks = images.blocks(1);
    let pixels = blocks.iter().flatten();
    let count = pixels.clone().count() as f64;
    pixels.map(|pixel| pixel.variance).sum::<f64>() / count
}

#[test]
fn every_strategy_renders_the_same_image_by_every_sampler() {
    let scene = many_emitters(24);
    const SPP: u32 = 16;
    let reference = replicates(
        &scene,
        settings(StrategyKind::Roulette, SamplerKind::Independent),
        0..64,
        SPP,
    );
    let expected = reference.blocks(8);
    let samplers = [SamplerKind::Sobol, SamplerKind::ArrayQmc];
    let cases = samplers
        .into_iter()
        .flat_map(|sampler| StrategyKind::ALL.map(|strategy| (sampler, strategy)));
    for (index, (sampler, strategy)) in (1..).zip(cases.clone()) {
        let seeds = 1000 * index..1000 * index + 32;
        // Passes go on with one sequence, and together leave less noise than the film can know of.
        let images = replicates_in_growing_passes(&scene, settings(strategy, sampler), seeds, SPP);
        let blocks = images.blocks(8);
        let pairs = blocks.iter().flatten().zip(expected.iter().flatten());
        let limit = sidak_threshold(1e-3, cases.clone().count() * pairs.clone().count());
        for (block, (a, b)) in pairs.enumerate() {
            let z = a.z_of_difference(b);
            assert!(
                z.abs() < limit,
                "{strategy}, {sampler}, block {block}: {a:?} {b:?}, z = {z}"
            );
        }
    }
}

#[test]
fn points_of_sequences_leave_less_noise() {
    let scene = many_emitters(24);
    let of = |sampler| {
        let settings = settings(StrategyKind::Roulette, sampler);
        noise(&replicates(&scene, settings, 0..96, 16))
    };
    let [independent, sobol, array] = SamplerKind::ALL.map(of);
    println!("variance: independent {independent}, sobol {sobol}, array-qmc {array}");
    assert!(sobol < 0.8 * independent, "{sobol} against {independent}");
    assert!(array < 0.8 * independent, "{array} against {independent}");
}

/// Threads, slices and the passes of other budgets do not matter.
#[test]
fn renders_by_sequences_are_deterministic() {
    for sampler in [SamplerKind::Sobol, SamplerKind::ArrayQmc] {
        assert_deterministic(sampler);
    }
}

fn assert_deterministic(sampler: SamplerKind) {
    let scene = many_emitters(40);
    let spp = |samples| Budget::SamplesPerPixel(NonZeroU32::new(samples).expect("not zero"));
    let image = |threads: usize, slices: &[u32]| {
        let settings = Settings {
            threads: NonZeroUsize::new(threads).expect("not zero"),
            budget: spp(40),
            ..settings(StrategyKind::GoWithTheWinners, sampler)
        };
        let render = Render::new(Arc::clone(&scene), settings).expect("it can be rendered");
        let mut state = render.start(5);
        for &slice in slices {
            render.advance(&mut state, spp(slice), &StopFlag::new(), &());
        }
        state.film().image().pixels().to_vec()
    };
    let one = image(1, &[40]);
    assert!(one == image(2, &[40]), "two threads made another image");
    // Whole passes: a pass that is cut short is another batch, with other shared decisions.
    assert!(one == image(2, &[16, 32, 40]), "slices made another image");
}
