//! The stages of the engine, and the time that each takes.

use std::ops::AddAssign;
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

/// What is done with a batch, in the order of the doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Camera paths start.
    Camera,
    /// Rays are traced: segments, shadow rays, and what looks through hidden emitters.
    Intersect,
    /// The particles of a pixel are sorted, for samplers that want that.
    Arrange,
    /// Paths arrive at surfaces and lights.
    Emission,
    /// Light is drawn, and added where it arrives.
    Direct,
    /// The strategy decides.
    Walk,
    /// Children leave their parents.
    Scatter,
    /// What the paths have brought back is recorded, while the render learns.
    Learn,
    /// Finished paths are added to their pixels.
    Splat,
}

impl Stage {
    /// Every stage.
    pub const ALL: [Self; 9] = [
        Self::Camera,
        Self::Intersect,
        Self::Arrange,
        Self::Emission,
        Self::Direct,
        Self::Walk,
        Self::Scatter,
        Self::Learn,
        Self::Splat,
    ];

    /// The name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Camera => "camera",
            Self::Intersect => "intersect",
            Self::Arrange => "arrange",
            Self::Emission => "emission",
            Self::Direct => "direct",
            Self::Walk => "walk",
            Self::Scatter => "scatter",
            Self::Learn => "learn",
            Self::Splat => "splat",
        }
    }
}

/// The time that each stage took, summed over threads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct StageTimes([Duration; Stage::ALL.len()]);

impl StageTimes {
    /// The time of one stage.
    pub fn of(&self, stage: Stage) -> Duration {
        self.0[stage as usize]
    }

    /// The time of all stages: nothing lies between them.
    pub fn total(&self) -> Duration {
        self.0.iter().sum()
    }
}

impl AddAssign for StageTimes {
    fn add_assign(&mut self, other: Self) {
        for (sum, time) in self.0.iter_mut().zip(other.0) {
            *sum += time;
        }
    }
}

/// Attributes the time since it was last looked at to a stage.
pub(super) struct Stopwatch {
    last: Instant,
}

impl Stopwatch {
    /// Starts now.
    pub fn start() -> Self {
        Self {
            last: Instant::now(),
        }
    }

    /// Adds the time since the start, or since the last lap, to `stage`.
    pub fn lap(&mut self, stage: Stage, times: &mut StageTimes) {
        let now = Instant::now();
        times.0[stage as usize] += now - self.last;
        self.last = now;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn laps_add_up_to_the_time_between_start_and_last_lap() {
        let mut times = StageTimes::default();
        let mut stopwatch = Stopwatch::start();
        let start = stopwatch.last;
        for stage in [Stage::Camera, Stage::Walk, Stage::Camera] {
            std::thread::sleep(Duration::from_millis(1));
            stopwatch.lap(stage, &mut times);
        }
        assert_eq!(times.total(), stopwatch.last - start);
        assert_eq!(
            times.total(),
            times.of(Stage::Camera) + times.of(Stage::Walk)
        );
        assert!(times.of(Stage::Walk) >= Duration::from_millis(1));
        let mut twice = times;
        twice += times;
        assert_eq!(twice.of(Stage::Camera), 2 * times.of(Stage::Camera));
    }
}
