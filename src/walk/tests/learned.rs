//! The strategies that learn: what they ask for where something is known, and where nothing is.

use super::*;
use crate::sampling::{Decisions, Sampler, SamplerKind, SequencePoint, StreamKey};
use crate::walk::{AdjointRoulette, Ears, Learned, Objective};

/// What is known of particles of importance 1 and albedo 1/2, with a value of mean 2 and the given mean squares, in a pixel of brightness 1.
struct Known {
    mean: Vec<f32>,
    square: Vec<f32>,
    cost: Vec<f32>,
    reflected: Vec<f32>,
    brightness: Vec<f32>,
    shininess: Vec<f32>,
}

impl Known {
    fn new(squares: &[f32]) -> Self {
        let all = |value| vec![value; squares.len()];
        Self {
            mean: all(2.0),
            square: squares.to_vec(),
            cost: all(4.0),
            reflected: all(0.5),
            brightness: all(1.0),
            shininess: all(0.0),
        }
    }

    /// What `strategy` asks for.
    fn counts(&self, strategy: &dyn Strategy) -> Vec<f32> {
        self.counts_at(strategy, None)
    }

    /// What it asks for where the particles are at such `points`.
    fn counts_at(&self, strategy: &dyn Strategy, points: Option<Decisions>) -> Vec<f32> {
        let count = self.square.len();
        let (importance, albedo) = (vec![1.0; count], vec![0.5; count]);
        let population = Population {
            importance: &importance,
            albedo: &albedo,
            shininess: &self.shininess,
            group: &vec![0; count],
            paths: 1000,
            depth: 0,
            points,
            learned: Some(Learned {
                mean: &self.mean,
                square: &self.square,
                cost: &self.cost,
                reflected: &self.reflected,
                brightness: &self.brightness,
                relative_factor: 1.0,
                absolute_factor: 2.0,
            }),
        };
        let mut counts = vec![f32::NAN; count];
        strategy.expected_counts(&population, &mut counts);
        counts
    }
}

fn filter(objective: Objective) -> ParticleFilter {
    ParticleFilter::learned(objective, Scope::Pixel, Rounding::Systematic).unwrap()
}

/// nu = 1/2 sqrt(square / 4), which a dead zone of 3/2 draws to 1.
#[test]
fn the_filter_asks_for_the_root_of_second_moment_over_cost() {
    let known = Known::new(&[4.0, 16.0, 25.0, 144.0, 1e-9, 1e9]);
    assert_eq!(
        known.counts(&filter(Objective::Relative)),
        [0.75, 1.0, 1.0, 2.0, 0.02, 20.0]
    );
    // Twice as many by the other factor.
    assert_eq!(known.counts(&filter(Objective::Mse))[..2], [1.0, 2.0 / 1.5]);
    // Copies of what does not vary are worth nothing: the first has no variance, the second 12.
    let mut known = Known::new(&[4.0, 16.0]);
    known.brightness = vec![0.25; 2];
    assert_eq!(known.counts(&filter(Objective::Relative)), [1.0, 4.0 / 1.5]);
}

/// Half of what neighbours have in common is not at risk where they stand side by side: here half of 4.
#[test]
fn the_filter_ends_more_paths_where_neighbours_hold_the_balance() {
    let known = Known::new(&[4.0, 2.0 + 64.0, 1.0, 1e9]);
    let points = [SequencePoint::default(); 4];
    let key = StreamKey {
        seed: 1,
        tile: 0,
        pass: 0,
    };
    let counts = |kind, strategy: &dyn Strategy| {
        let sampler = Sampler::new(kind, key, 1);
        known.counts_at(strategy, sampler.decisions(&points))
    };
    let (filter, ears) = (filter(Objective::Relative), Ears::default());
    let sorted = counts(SamplerKind::ArrayQmc, &filter);
    assert_eq!(sorted, [0.75 * 0.5_f32.sqrt(), 2.0 / 1.5, 0.02, 20.0]);
    for kind in [SamplerKind::Independent, SamplerKind::Sobol] {
        assert_eq!(counts(kind, &filter), known.counts(&filter));
    }
    assert_eq!(counts(SamplerKind::ArrayQmc, &ears), known.counts(&ears));
}

/// Of a mirror, what was learned says how bright its surroundings are on average: not what is seen in it.
#[test]
fn mirrors_neither_split_paths_nor_give_them_up() {
    let mut known = Known::new(&[1e-9, 1e9]);
    known.shininess = vec![f32::INFINITY; 2];
    let strategies: [&dyn Strategy; 3] = [
        &filter(Objective::Relative),
        &Ears::default(),
        &AdjointRoulette,
    ];
    for strategy in strategies {
        assert_eq!(known.counts(strategy), [1.0, 1.0], "{strategy:?}");
        known.mean = vec![1e-3, 1e3];
    }
    let known = Known::new(&[1e-9, 1e9]);
    assert_eq!(known.counts(&Ears::default()), [0.02, 20.0]);
}

/// However much is asked for, a generation has at most four children for each camera path.
#[test]
fn populations_cannot_explode() {
    let known = Known::new(&[1e9; 3000]);
    let strategies: [&dyn Strategy; 2] = [&filter(Objective::Relative), &Ears::default()];
    for strategy in strategies {
        let counts = known.counts(strategy);
        let sum: f32 = counts.iter().sum();
        assert!((sum - 4000.0).abs() < 1.0, "{strategy:?}: {sum}");
    }
}

#[test]
fn ears_ends_by_the_second_moment_and_splits_by_the_variance() {
    let known = Known::new(&[4.0, 16.0, 18.0, 68.0, 1e-9, 1e9]);
    let counts = known.counts(&Ears::default());
    // The last but two has the variance 64; those in between go on alone.
    assert_eq!(counts, [0.5, 1.0, 1.0, 2.0, 0.02, 20.0]);
}

#[test]
fn adjoint_roulette_keeps_what_is_expected_in_its_window() {
    let mut known = Known::new(&[1.0; 4]);
    known.mean = vec![2.0, 0.2, 8.0, 2e9];
    let counts = known.counts(&AdjointRoulette);
    // Expected are 1, 0.1 and 4; the window goes from 1/3 to 5/3.
    let expected = [1.0, 0.3, 2.4, 20.0];
    for (count, expected) in counts.iter().zip(expected) {
        assert!((count - expected).abs() < 1e-6, "{counts:?}");
    }
}

/// Nothing found yet, nothing known, a black pixel: no strategy may give up such particles.
#[test]
fn the_unknown_is_not_given_up() {
    let mut known = Known::new(&[0.0, f32::NAN, 1.0]);
    known.brightness[2] = 0.0;
    let strategies: [&dyn Strategy; 3] = [
        &filter(Objective::Relative),
        &Ears::default(),
        &AdjointRoulette,
    ];
    for strategy in strategies {
        let counts = known.counts(strategy);
        assert!(
            counts.iter().all(|&nu| nu >= 0.5),
            "{strategy:?}: {counts:?}"
        );
    }
}
