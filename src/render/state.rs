//! A render under way, and what it made in the end.

use std::time::Duration;

use serde::{Deserialize, Serialize};

use super::allocation::Allocation;
use super::trial::Finding;
use super::{Budget, Schedule};
use crate::film::Film;
use crate::learning::{Knowledge, Reliance};
use crate::transport::TraceStatistics;

/// A render under way: what [`Render::advance`](super::Render::advance) goes on from.
///
/// It can be saved and loaded between two advances (it implements serde's traits), and several can take turns on one
/// [`Render`](super::Render).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RenderState {
    pub(super) seed: u64,
    pub(super) film: Film,
    /// Of a render that learns.
    pub(super) knowledge: Option<Knowledge>,
    /// From how many samples of every pixel it learns: settled by the budget with which it began.
    pub(super) lessons: u32,
    /// Of a render that is adaptive.
    pub(super) allocation: Option<Allocation>,
    /// What was found by trying it so far.
    pub(super) findings: Vec<Option<Finding>>,
    /// On which of it the render relies, once it has tried.
    pub(super) reliance: Option<Reliance>,
    pub(super) pass: Pass,
    pub(super) statistics: TraceStatistics,
    pub(super) duration: Duration,
}

/// The pass that is under way, or is the next.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Pass {
    /// Its number, from 0.
    pub index: u32,
    /// Samples per pixel of all passes before it, in the mean over all pixels.
    pub before: u64,
    /// Samples per pixel of this one, likewise, once a tile is done.
    pub samples: u32,
    /// Which tiles are done, in the order of the film.
    pub done: Vec<bool>,
}

/// Why a render ended, or paused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// Every pixel has its samples.
    Complete,
    /// The time is used up.
    OutOfTime,
    /// The rays are used up.
    OutOfRays,
    /// Somebody asked to stop.
    Interrupted,
}

impl Ended {
    /// The name in metadata.
    pub fn name(self) -> &'static str {
        match self {
            Self::Complete => "complete",
            Self::OutOfTime => "out of time",
            Self::OutOfRays => "out of rays",
            Self::Interrupted => "interrupted",
        }
    }
}

/// What a render made.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The image and what is known of its noise.
    pub film: Film,
    /// What was counted.
    pub statistics: TraceStatistics,
    /// Wall-clock time of tracing.
    pub duration: Duration,
    /// Seed of all random streams.
    pub seed: u64,
    /// On which of what it learned it relied in the end; `None` where that was not tried.
    pub reliance: Option<Reliance>,
    /// Why it ended.
    pub ended: Ended,
}

impl RenderState {
    /// A render onto `film` that has not traced anything.
    pub(super) fn new(
        film: Film,
        knowledge: Option<Knowledge>,
        lessons: u32,
        allocation: Option<Allocation>,
        seed: u64,
    ) -> Self {
        Self {
            seed,
            pass: Pass {
                index: 0,
                before: 0,
                samples: 0,
                done: vec![false; film.tiles().len()],
            },
            film,
            knowledge,
            lessons,
            allocation,
            findings: Vec::new(),
            reliance: None,
            statistics: TraceStatistics::default(),
            duration: Duration::ZERO,
        }
    }

    /// The image so far and what is known of its noise. Where a pass was interrupted, some tiles have more samples.
    pub fn film(&self) -> &Film {
        &self.film
    }

    /// What was counted so far.
    pub fn statistics(&self) -> &TraceStatistics {
        &self.statistics
    }

    /// Wall-clock time of tracing so far: all advances together, without what lay between them.
    pub fn duration(&self) -> Duration {
        self.duration
    }

    /// Seed of all random streams.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// What the render made, where it `ended`.
    pub fn into_outcome(self, ended: Ended) -> Outcome {
        Outcome {
            film: self.film,
            statistics: self.statistics,
            duration: self.duration,
            seed: self.seed,
            reliance: self.reliance,
            ended,
        }
    }
}

impl Pass {
    /// Whether some of it is done.
    pub fn is_under_way(&self) -> bool {
        self.done.contains(&true)
    }

    /// Settles how many samples the pass takes, unless it is under way. Returns whether there is anything to do.
    pub fn plan(&mut self, schedule: Schedule, until: Budget) -> bool {
        let samples = schedule.samples(self.index, self.before, until);
        if !self.is_under_way() {
            self.samples = samples;
        }
        samples > 0
    }

    /// Goes to the next pass if all tiles are done. Returns whether they are.
    pub fn finish(&mut self) -> bool {
        let is_done = !self.done.contains(&false);
        if is_done {
            self.index += 1;
            self.before += u64::from(self.samples);
            self.done.fill(false);
        }
        is_done
    }
}
