//! How much noise each rounding adds.

use super::*;
use crate::walk::{Child, ResidualRest};

/// The variances of the counts of a population with nu = W, and of its estimate of a smooth function's sum.
struct Noise {
    counts: Vec<f64>,
    estimate: f64,
}

fn noise(rounding: Rounding, importance: &[f32]) -> Noise {
    let particles = Particles::white(importance);
    let (mut random, mut offspring) = (random(6), Offspring::new());
    let mut counted = vec![Moments::default(); importance.len()];
    let mut estimated = Moments::default();
    for _ in 0..20_000 {
        filter(rounding).resample(&particles.population(0), &mut random, &mut offspring);
        for (counted, n) in counted.iter_mut().zip(counts(&offspring)) {
            counted.add(n as f64);
        }
        // Each particle contributes its importance; neighbours contribute alike.
        let contribution = |child: &Child| child.weight * importance[child.parent as usize];
        estimated.add(
            offspring
                .children()
                .iter()
                .map(contribution)
                .sum::<f32>()
                .into(),
        );
    }
    Noise {
        counts: counted.iter().map(Moments::variance).collect(),
        estimate: estimated.variance(),
    }
}

const IMPORTANCE: [f32; 12] = [0.1, 0.2, 0.3, 0.5, 0.6, 0.8, 0.9, 1.1, 1.3, 1.6, 2.2, 2.9];

#[test]
fn systematic_and_independent_counts_have_the_least_variance_there_is() {
    for rounding in [Rounding::Systematic, Rounding::Independent] {
        for (variance, nu) in noise(rounding, &IMPORTANCE)
            .counts
            .into_iter()
            .zip(IMPORTANCE)
        {
            let fraction = f64::from(nu.fract());
            let least = fraction * (1.0 - fraction);
            assert!(
                (variance - least).abs() < 0.01,
                "{rounding}: {variance}, {least} for {nu}"
            );
        }
    }
}

/// Figure 5's draws: m' trials of probability nu / N, m' itself floor or ceiling of N.
#[test]
fn multinomial_counts_have_the_variance_of_the_binomial() {
    let total: f64 = IMPORTANCE.iter().map(|&nu| f64::from(nu)).sum();
    let noise = noise(Rounding::Multinomial, &IMPORTANCE);
    for (variance, nu) in noise.counts.into_iter().zip(IMPORTANCE) {
        let p = f64::from(nu) / total;
        let of_total = total.fract() * (1.0 - total.fract());
        let expected = total * p * (1.0 - p) + p * p * of_total;
        assert!(
            (variance - expected).abs() < 0.06 * expected,
            "{variance}, {expected} for {nu}"
        );
    }
}

#[test]
fn roundings_are_ordered_by_their_noise() {
    let total = |rounding| noise(rounding, &IMPORTANCE).counts.iter().sum::<f64>();
    let systematic = total(Rounding::Systematic);
    let stratified = total(Rounding::Stratified);
    let multinomial = total(Rounding::Multinomial);
    let residual = total(Rounding::Residual(ResidualRest::Multinomial));
    let residual_stratified = total(Rounding::Residual(ResidualRest::Stratified));
    assert!(systematic < 0.95 * residual_stratified);
    assert!(residual_stratified < 0.95 * residual);
    assert!(residual < 0.95 * multinomial);
    assert!(systematic < 0.95 * stratified);
    assert!(stratified < 0.95 * multinomial);
}

/// What joint rounding is for: the total hardly varies, while independent decisions add up their noise.
#[test]
fn joint_rounding_steadies_the_estimate() {
    let joint = noise(Rounding::Systematic, &IMPORTANCE).estimate;
    let independent = noise(Rounding::Independent, &IMPORTANCE).estimate;
    assert!(joint < 0.3 * independent, "{joint}, {independent}");
}
