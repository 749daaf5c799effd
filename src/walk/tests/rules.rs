//! The expected counts are those of the formulas.

use super::*;

/// nu of one particle.
fn nu(strategy: &dyn Strategy, w: f32, a: f32, s: f32, depth: u32) -> f64 {
    let mut particles = Particles::default();
    particles.push(w, a, s, 0);
    let mut offspring = Offspring::new();
    let report = strategy.resample(&particles.population(depth), &mut random(1), &mut offspring);
    assert_eq!(report, WalkReport::default());
    means(&offspring)[0]
}

fn assert_close(one: f64, other: f64) {
    assert!(
        (one - other).abs() <= 1e-6 * other.abs(),
        "{one} is not {other}"
    );
}

#[test]
fn fixed_depth_gives_one_child() {
    assert_eq!(nu(&FixedDepth, 1e-20, 0.3, 5.0, 1000), 1.0);
}

#[test]
fn roulette_is_played_below_the_threshold() {
    let roulette = Roulette::new(0.1, 0.7).unwrap();
    assert_eq!(nu(&roulette, 0.25, 0.5, 0.0, 0), 1.0);
    assert_close(nu(&roulette, 0.19, 0.5, 0.0, 0), 0.3);
    // The threshold itself is not below the threshold.
    let roulette = Roulette::new(0.125, 0.7).unwrap();
    assert_eq!(nu(&roulette, 0.25, 0.5, 0.0, 0), 1.0);
}

/// As Mitsuba counts: with `rr_depth` 5, the fifth reflection is the first that can fail.
#[test]
fn throughput_roulette_begins_where_mitsuba_does() {
    let roulette = ThroughputRoulette::new(5);
    assert_eq!(nu(&roulette, 0.5, 0.5, 0.0, 3), 1.0);
    assert_close(nu(&roulette, 0.5, 0.5, 0.0, 4), 0.25);
    assert_close(nu(&roulette, 1.0, 0.99, 0.0, 4), 0.95);
    assert_close(nu(&roulette, 0.5, 0.5, 0.0, u32::MAX), 0.25);
    assert_close(nu(&ThroughputRoulette::new(1), 0.5, 0.5, 0.0, 0), 0.25);
}

#[test]
fn go_with_the_winners_splits_by_gloss() {
    let winners = GoWithTheWinners::new(10.0).unwrap();
    assert_close(nu(&winners, 0.5, 0.8, 0.0, 0), 4.0);
    assert_close(nu(&winners, 0.5, 0.8, 2.0, 0), 0.4 * 12.0_f64.sqrt());
    assert_close(nu(&winners, 0.5, 0.8, 1e30, 0), 0.4);
    assert_close(nu(&winners, 0.5, 0.8, f32::INFINITY, 0), 0.4);
}

#[test]
fn the_particle_filter_aims_at_n_max() {
    assert_close(nu(&ParticleFilter::paper(), 0.5, 0.5, 9.0, 0), 2.5);
    assert_close(nu(&filter(Rounding::Systematic), 0.5, 0.5, 9.0, 0), 0.25);
}
