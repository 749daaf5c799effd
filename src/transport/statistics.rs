//! What the engine counts while it works.

use std::ops::AddAssign;
use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::stages::StageTimes;
use crate::walk::WalkReport;

/// Counts of one or more batches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TraceStatistics {
    /// Camera paths.
    pub camera_paths: u64,
    /// Rays that looked for the nearest surface.
    pub rays: u64,
    /// Rays that only asked whether something is in the way.
    pub shadow_rays: u64,
    /// Surface points at which a strategy decided.
    pub vertices: u64,
    /// Time inside calls of the intersection layer, summed over threads.
    pub intersection_time: Duration,
    /// Time inside the engine, by stage, summed over threads.
    pub stages: StageTimes,
    /// Samples that were dropped, and why.
    pub dropped: DroppedSamples,
    /// What the strategy found wrong with the numbers it was given.
    pub walk: WalkReport,
    /// The longest path met, in segments.
    pub deepest: u32,
}

/// Samples that were not numbers the image may hold; they count as black.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct DroppedSamples {
    /// Not a number.
    pub nan: u64,
    /// Infinite.
    pub infinite: u64,
    /// Negative radiance.
    pub negative: u64,
    /// Batches cut off at the bounce limit that protects against scenes in which light never dies.
    pub endless: u64,
}

impl TraceStatistics {
    /// All rays.
    pub fn all_rays(&self) -> u64 {
        self.rays + self.shadow_rays
    }

    /// The share of the engine's time that was spent inside the intersection layer, in [0, 1].
    pub fn intersection_share(&self) -> f64 {
        let total = self.stages.total().as_secs_f64();
        if total > 0.0 {
            self.intersection_time.as_secs_f64() / total
        } else {
            0.0
        }
    }
}

impl DroppedSamples {
    /// All causes together.
    pub fn total(&self) -> u64 {
        self.nan + self.infinite + self.negative + self.endless
    }

    /// Counts a sample with these components, at least one of which is no radiance.
    pub(super) fn count(&mut self, components: &[f32]) {
        if components.iter().any(|value| value.is_nan()) {
            self.nan += 1;
        } else if components.iter().any(|value| value.is_infinite()) {
            self.infinite += 1;
        } else {
            self.negative += 1;
        }
    }
}

impl AddAssign for DroppedSamples {
    fn add_assign(&mut self, other: Self) {
        self.nan += other.nan;
        self.infinite += other.infinite;
        self.negative += other.negative;
        self.endless += other.endless;
    }
}

impl AddAssign for TraceStatistics {
    fn add_assign(&mut self, other: Self) {
        self.camera_paths += other.camera_paths;
        self.rays += other.rays;
        self.shadow_rays += other.shadow_rays;
        self.vertices += other.vertices;
        self.intersection_time += other.intersection_time;
        self.stages += other.stages;
        self.dropped += other.dropped;
        self.walk += other.walk;
        self.deepest = self.deepest.max(other.deepest);
    }
}
