//! The multinomial filter against figure 5 of the paper, taken literally.

use std::collections::BTreeMap;

use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::*;

/// Figure 5, line by line: the counts of one resampling.
fn figure_5(importance: &[f32], albedo: &[f32], n_max: f64, random: &mut RandomStream) -> Vec<u64> {
    let mut cumulative = vec![0.0];
    for (&w, &a) in importance.iter().zip(albedo) {
        cumulative.push(cumulative[cumulative.len() - 1] + f64::from(w) * f64::from(a) * n_max);
    }
    let total = cumulative[cumulative.len() - 1];
    let mut counts = vec![0; importance.len()];
    let mut draw_with_replacement = |random: &mut RandomStream| {
        let point = random.uniform_f64() * total;
        let j = cumulative[1..].partition_point(|&end| end <= point);
        counts[j] += 1;
    };
    let certain = total.floor();
    for _ in 0..certain as u64 {
        draw_with_replacement(random);
    }
    if random.uniform_f64() < total - certain {
        draw_with_replacement(random);
    }
    counts
}

/// The joint distribution of all counts is the same: two-sample chi-square test over their outcomes.
#[test]
fn the_multinomial_filter_is_figure_5() {
    const DRAWS: usize = 100_000;
    let particles = Particles {
        importance: vec![0.1, 0.05, 0.08, 0.1],
        albedo: vec![0.9, 0.0, 0.5, 0.7],
        shininess: vec![0.0; 4],
        group: vec![0; 4],
    };
    let mut outcomes: BTreeMap<Vec<u64>, [f64; 2]> = BTreeMap::new();
    let (mut random, mut offspring) = (random(8), Offspring::new());
    for _ in 0..DRAWS {
        let literal = figure_5(&particles.importance, &particles.albedo, 10.0, &mut random);
        outcomes.entry(literal).or_default()[0] += 1.0;
        ParticleFilter::paper().resample(&particles.population(0), &mut random, &mut offspring);
        outcomes.entry(counts(&offspring)).or_default()[1] += 1.0;
    }

    // N = 2: three ways to give both children to one particle, three to give them to two.
    assert_eq!(outcomes.len(), 6, "{outcomes:?}");
    let chi_square: f64 = outcomes
        .values()
        .map(|[a, b]| (a - b).powi(2) / (a + b))
        .sum();
    let p_value = ChiSquared::new(5.0).unwrap().sf(chi_square);
    assert!(p_value > 1e-4, "p = {p_value}: {outcomes:?}");
}
