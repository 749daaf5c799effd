//! What holds for every single draw, whatever arrives from upstream.

use proptest::prelude::{
    ProptestConfig, any, prop, prop_assert, prop_assert_eq, prop_oneof, proptest,
};
use proptest::strategy::Strategy as Generator;

use super::*;
use crate::walk::ExpectedCount;

/// Any float at all, and often the awkward ones.
fn number() -> impl Generator<Value = f32> {
    prop_oneof![
        6 => 0.0_f32..2.0,
        2 => prop::sample::select(vec![0.0, -0.0, 1.0, 1e-30, 1e30, 1e-40, f32::MIN_POSITIVE, f32::MAX]),
        1 => prop::num::f32::ANY,
        1 => prop::sample::select(vec![f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0]),
    ]
}

fn particles() -> impl Generator<Value = Particles> {
    let particle = (number(), number(), number(), prop::bool::weighted(0.2));
    prop::collection::vec(particle, 0..60).prop_map(|rows| {
        let mut particles = Particles::default();
        let mut group = 0;
        for (w, a, s, begins_group) in rows {
            group += u32::from(begins_group);
            particles.push(w, a, s, group);
        }
        particles
    })
}

fn is_sound(w: f32, a: f32, s: f32) -> bool {
    w.is_finite() && a.is_finite() && !s.is_nan() && w >= 0.0 && a >= 0.0 && s >= 0.0
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

    #[test]
    fn every_draw(particles in particles(), seed in any::<u64>()) {
        let population = particles.population(2);
        for strategy in every_strategy() {
            let mut offspring = Offspring::new();
            let report = strategy.resample(&population, &mut random(seed), &mut offspring);
            let (n, nu) = (counts(&offspring), offspring.expected_counts());

            // Children stand in the order of their parents and carry 1 / nu.
            prop_assert!(offspring.children().is_sorted_by_key(|child| child.parent));
            for child in offspring.children() {
                let nu = f64::from(nu[child.parent as usize]);
                prop_assert!(child.weight.is_finite());
                prop_assert!((f64::from(child.weight) * nu - 1.0).abs() < 1e-6);
            }

            // Nothing comes of nothing, everything else has a chance, and what is impossible is reported.
            let mut impossible = 0;
            for (k, &nu) in nu.iter().enumerate() {
                let (w, a) = (particles.importance[k], particles.albedo[k]);
                let sound = is_sound(w, a, particles.shininess[k]);
                impossible += u64::from(!sound);
                prop_assert_eq!(nu > ExpectedCount::ZERO, sound && w > 0.0 && a > 0.0);
                prop_assert!(nu <= ExpectedCount::LARGEST);
                prop_assert!(nu > ExpectedCount::ZERO || n[k] == 0);
            }
            prop_assert_eq!(report.dropped(), impossible);

            // Integers next to the means: each particle's, or the sum of each group.
            let nu = means(&offspring);
            let rounds = |n: u64, nu: f64| n as f64 == nu.floor() || n as f64 == nu.ceil();
            match strategy.rounding() {
                Rounding::Independent | Rounding::Systematic => {
                    prop_assert!(n.iter().zip(&nu).all(|(&n, &nu)| rounds(n, nu)));
                }
                Rounding::Stratified => {
                    prop_assert!(n.iter().zip(&nu).all(|(&n, &nu)| (n as f64 - nu).abs() < 3.0));
                }
                Rounding::Residual(_) => {
                    prop_assert!(n.iter().zip(&nu).all(|(&n, &nu)| n as f64 >= nu.floor()));
                }
                Rounding::Multinomial => {}
            }
            if strategy.rounding() != Rounding::Independent {
                let mut first = 0;
                for group in particles.group.chunk_by(|a, b| a == b) {
                    let members = first..first + group.len();
                    first = members.end;
                    // Exact: at most 60 terms, multiples of 2^-32 below 2^11.
                    prop_assert!(rounds(n[members.clone()].iter().sum(), nu[members].iter().sum()));
                }
            }

            // The same stream, the same children, also in offspring that were used before.
            let first = offspring.children().to_vec();
            let again = strategy.resample(&population, &mut random(seed), &mut offspring);
            prop_assert_eq!(again, report);
            prop_assert_eq!(offspring.children(), first);
        }
    }
}

#[test]
fn impossible_numbers_are_counted_by_cause() {
    let mut particles =
        Particles::white(&[f32::NAN, f32::INFINITY, -1.0, f32::NEG_INFINITY, 1.0, -0.0]);
    particles.push(1.0, f32::NAN, 0.0, 0);
    particles.push(f32::INFINITY, f32::NAN, -1.0, 0);
    particles.push(1.0, 1.0, -1.0, 0);
    particles.push(1.0, 1.0, f32::INFINITY, 0);
    let mut offspring = Offspring::new();
    let mut total = WalkReport::default();
    for _ in 0..2 {
        total += FixedDepth.resample(&particles.population(0), &mut random(1), &mut offspring);
    }
    assert_eq!(
        total,
        WalkReport {
            nan: 6,
            infinite: 4,
            negative: 4
        }
    );
    let parents: Vec<_> = offspring
        .children()
        .iter()
        .map(|child| child.parent)
        .collect();
    assert_eq!(parents, [4, 9]);
}

#[test]
fn offspring_are_replaced_not_added_to() {
    let mut offspring = Offspring::new();
    FixedDepth.resample(
        &Particles::white(&[1.0; 5]).population(0),
        &mut random(1),
        &mut offspring,
    );
    assert_eq!(offspring.children().len(), 5);
    FixedDepth.resample(
        &Particles::white(&[]).population(0),
        &mut random(1),
        &mut offspring,
    );
    assert!(offspring.children().is_empty() && offspring.expected_counts().is_empty());
}

#[test]
#[should_panic(expected = "one entry per particle")]
fn incomplete_populations_are_refused() {
    let mut particles = Particles::white(&[1.0, 1.0]);
    particles.albedo.pop();
    FixedDepth.resample(
        &particles.population(0),
        &mut random(1),
        &mut Offspring::new(),
    );
}
