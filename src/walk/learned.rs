//! What a render has learned of its particles.

use super::SettingError;
use crate::walk::population::Population;

use std::fmt::{self, Display};
use std::str::FromStr;

use serde::Serialize;

/// What was learned before about the particles of a [`Population`]: one entry per particle in every slice.
///
/// The *value* of going on at a particle is what one child of it would bring back if the surface's albedo and the particle's throughput were
/// 1. All of it comes from paths traced before: to a strategy these are numbers fixed in advance.
#[derive(Clone, Copy, Debug)]
pub struct Learned<'a> {
    /// The mean of the value, in radiance; not a number where nothing is known.
    pub mean: &'a [f32],
    /// The mean of its square.
    pub square: &'a [f32],
    /// The rays that a child takes, those of its descendants included.
    pub cost: &'a [f32],
    /// Throughput times albedo, as a mean over wavelengths: what multiplies the value.
    pub reflected: &'a [f32],
    /// The mean radiance of the particle's pixel; 0 where nothing is known.
    pub brightness: &'a [f32],
    /// The square root of what a camera path costs over its relative variance, each as a mean over the image.
    pub relative_factor: f32,
    /// The same with the variance itself.
    pub absolute_factor: f32,
}

/// Which error of the image is to become small.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Objective {
    /// Relative to the brightness of each pixel.
    #[default]
    Relative,
    /// As it is: bright pixels count most.
    Mse,
}

impl Objective {
    /// Every objective.
    pub const ALL: [Self; 2] = [Self::Relative, Self::Mse];

    fn name(self) -> &'static str {
        match self {
            Self::Relative => "relative",
            Self::Mse => "mse",
        }
    }
}

impl Display for Objective {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Objective {
    type Err = SettingError;

    fn from_str(text: &str) -> Result<Self, SettingError> {
        SettingError::choose("objective", text, &Self::ALL)
    }
}

impl Learned<'_> {
    /// Whether every slice has `count` entries.
    pub(super) fn is_complete(&self, count: usize) -> bool {
        let columns = [
            self.mean,
            self.square,
            self.cost,
            self.reflected,
            self.brightness,
        ];
        columns.iter().all(|column| column.len() == count)
    }

    /// The efficient number of children of particle number `index`, where `spread` is the mean square, or the variance, of the value; not
    /// a number where nothing is known.
    ///
    /// Of all counts it makes variance times cost least: nu = t sqrt(spread / cost), divided by the square root of the image's variance over
    /// its cost (Rath et al. 2022, "EARS: Efficiency-Aware Russian Roulette and Splitting", equations 11 to 15; there t is the throughput relative to the pixel's
    /// brightness).
    #[inline(always)]
    pub(super) fn efficient_count(&self, objective: Objective, index: usize, spread: f32) -> f32 {
        let root = (spread / self.cost[index]).sqrt();
        match objective {
            Objective::Relative => {
                let relative = self.reflected[index] / self.brightness[index];
                self.relative_factor * relative * root
            }
            Objective::Mse => self.absolute_factor * self.reflected[index] * root,
        }
    }
}

/// What a strategy asks of a particle of which nothing is known yet: one child for each that matters, every other one of those that hardly do.
#[inline(always)]
pub(super) fn before_lessons(population: &Population, index: usize) -> f32 {
    if population.importance[index] * population.albedo[index] >= 0.1 {
        1.0
    } else {
        0.5
    }
}
