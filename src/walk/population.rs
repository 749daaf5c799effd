//! What a strategy sees of the particles, and what it reports about them.

use std::ops::AddAssign;

use serde::{Deserialize, Serialize};

use super::Learned;
use super::learned::is_known;
use crate::sampling::Decisions;

/// What a strategy may know of the particles of a batch: one entry per particle in every slice.
///
/// A batch can hold several joint populations, the *groups*: the particles of a group stand side by side, and
/// those of one group decide nothing for those of another.
#[derive(Clone, Copy, Debug)]
pub struct Population<'a> {
    /// W, the share of what arrives at the particle that reaches its pixel, relative to the start of its own
    /// camera path, where it is 1 (paper, eq. 4). It must be positive wherever a component of the throughput is.
    pub importance: &'a [f32],
    /// a, the share of the arriving light that the surface reflects. It must be positive wherever a component is.
    pub albedo: &'a [f32],
    /// s, the exponent of the surface's gloss: 0 for a perfectly diffuse surface, infinite for a perfect mirror.
    pub shininess: &'a [f32],
    /// Which group the particle belongs to, as [`Strategy::scope`](super::Strategy::scope) asks; nondecreasing.
    pub group: &'a [u32],
    /// How many camera paths they descend from, those that have ended included.
    pub paths: u32,
    /// How often these particles have been scattered so far: 0 at the first vertex seen from the camera.
    pub depth: u32,
    /// Where the particles stand in sequences of evenly spread points, if they do: those who decide alone do so by
    /// these. Without them, all decisions are independent.
    pub points: Option<Decisions<'a>>,
    /// What was learned of them, for strategies that [ask for it](super::Strategy::learns).
    pub learned: Option<Learned<'a>>,
}

impl Population<'_> {
    /// The number of particles.
    pub fn len(&self) -> usize {
        self.importance.len()
    }

    /// Whether there are no particles.
    pub fn is_empty(&self) -> bool {
        self.importance.is_empty()
    }

    /// Whether every slice has one entry per particle.
    pub(super) fn is_complete(&self) -> bool {
        let points = self.points.map_or(self.len(), |points| points.len());
        let learned_is_complete = self
            .learned
            .is_none_or(|learned| learned.is_complete(self.len()));
        learned_is_complete
            && [
                self.albedo.len(),
                self.shininess.len(),
                self.group.len(),
                points,
            ] == [self.len(); 4]
    }

    /// What was learned, if anything was of particle number `index`.
    #[inline(always)]
    pub(super) fn known(&self, index: usize) -> Option<&Learned<'_>> {
        let is_known =
            |learned: &&Learned| is_known(learned.square[index], learned.brightness[index]);
        self.learned.as_ref().filter(is_known)
    }

    /// Each particle in turn.
    pub(super) fn particles(&self) -> impl ExactSizeIterator<Item = Particle> {
        let numbers = self.importance.iter().zip(self.albedo).zip(self.shininess);
        numbers.map(|((&importance, &albedo), &shininess)| Particle {
            importance,
            albedo,
            shininess,
        })
    }
}

/// The numbers of one particle of a [`Population`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Particle {
    pub importance: f32,
    pub albedo: f32,
    pub shininess: f32,
}

impl Particle {
    /// Whether the numbers can be those of a particle: finite and not negative, but for a mirror's shininess.
    #[inline(always)]
    pub fn is_sound(self) -> bool {
        let finite = |number: f32| (0.0..=f32::MAX).contains(&number);
        finite(self.importance) & finite(self.albedo) & (self.shininess >= 0.0)
    }

    /// Whether anything that the particle still finds can reach its pixel. The factors are asked one by one:
    /// their product can vanish although neither does.
    #[inline(always)]
    pub fn matters(self) -> bool {
        (self.importance > 0.0) & (self.albedo > 0.0)
    }
}

/// How many particles a strategy had to end because of impossible numbers arriving from upstream.
///
/// Each particle is counted once, under the first cause that applies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct WalkReport {
    /// Particles with a number that is not one.
    pub nan: u64,
    /// Particles with an infinite importance or albedo.
    pub infinite: u64,
    /// Particles with a negative number.
    pub negative: u64,
}

impl WalkReport {
    /// The number of particles that were ended.
    pub fn dropped(&self) -> u64 {
        self.nan + self.infinite + self.negative
    }

    /// Counts the impossible numbers of `population`.
    #[cold]
    pub(super) fn on(population: &Population) -> Self {
        let mut report = Self::default();
        for particle in population
            .particles()
            .filter(|particle| !particle.is_sound())
        {
            let Particle {
                importance,
                albedo,
                shininess,
            } = particle;
            if importance.is_nan() || albedo.is_nan() || shininess.is_nan() {
                report.nan += 1;
            } else if importance.is_infinite() || albedo.is_infinite() {
                report.infinite += 1;
            } else {
                report.negative += 1;
            }
        }
        report
    }
}

impl AddAssign for WalkReport {
    fn add_assign(&mut self, other: Self) {
        self.nan += other.nan;
        self.infinite += other.infinite;
        self.negative += other.negative;
    }
}
