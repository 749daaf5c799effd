//! How fast paths were traced.

use std::time::Duration;

use cohort::transport::TraceStatistics;

use super::median::median;

/// Rates of one run.
#[derive(Clone, Copy)]
pub struct Rates {
    /// Camera paths per second.
    pub paths: f64,
    /// Rays per second, shadow rays included.
    pub rays: f64,
    /// The share of the engine's time inside the intersection layer, in [0, 1].
    pub embree_share: f64,
}

impl Rates {
    /// Of what `statistics` counted in the wall-clock time `elapsed`.
    pub fn new(statistics: &TraceStatistics, elapsed: Duration) -> Self {
        let seconds = elapsed.as_secs_f64();
        Self {
            paths: statistics.camera_paths as f64 / seconds,
            rays: statistics.all_rays() as f64 / seconds,
            embree_share: statistics.intersection_share(),
        }
    }

    /// The median of each number.
    pub fn median(runs: &[Self]) -> Self {
        let of = |number: fn(&Self) -> f64| median(runs.iter().map(number));
        Self {
            paths: of(|run| run.paths),
            rays: of(|run| run.rays),
            embree_share: of(|run| run.embree_share),
        }
    }
}

/// The median of the ratios of paths per second, `runs` to `base`, round by round.
pub fn median_ratio(runs: &[Rates], base: &[Rates]) -> f64 {
    median(
        runs.iter()
            .zip(base)
            .map(|(run, base)| run.paths / base.paths),
    )
}
