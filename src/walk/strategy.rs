//! What makes a random-walk strategy.

use std::fmt::{self, Debug, Display};
use std::str::FromStr;

use serde::Serialize;

use super::{Objective, Offspring, Population, Rounding, SettingError, WalkReport};
use crate::sampling::RandomStream;

/// Decides how many children each particle of a population gets.
///
/// A strategy is three things: a rule for the *expected* number of children nu of each particle, a way of
/// *rounding* these to integers n with E\[n\] = nu, and the *scope* within which the rounding is joint. Since every
/// child carries 1 / nu, any rule and any rounding give an unbiased image; they differ in noise and time.
pub trait Strategy: Send + Sync + Debug {
    /// The name by which users know the strategy.
    fn name(&self) -> &'static str;

    /// Every setting and its value, for the metadata of an image.
    fn settings(&self) -> Vec<(&'static str, String)>;

    /// Which particles round their counts together, and so have the same [`Population::group`].
    /// Unless it says otherwise, each decides alone.
    fn scope(&self) -> Scope {
        Scope::Particle
    }

    /// How the counts are rounded to integers.
    fn rounding(&self) -> Rounding {
        Rounding::Independent
    }

    /// Which scalar of the spectral throughput and albedo the strategy wants as importance and albedo.
    fn scalar(&self) -> Scalar {
        Scalar::Mean
    }

    /// Whether it asks for what the render has [learned](Population::learned).
    fn learns(&self) -> bool {
        false
    }

    /// Which error of the image it makes small, if it can choose.
    fn objective(&self) -> Objective {
        Objective::Relative
    }

    /// Writes the wished-for nu of every particle into `nu`.
    ///
    /// What it writes for a particle with importance or albedo zero, or with impossible numbers, does not count:
    /// [`resample`](Self::resample) gives those no children. All others get at least
    /// [`ExpectedCount::SMALLEST`] and at most [`ExpectedCount::LARGEST`], so that no rule can make an image biased.
    ///
    /// [`ExpectedCount::SMALLEST`]: super::ExpectedCount::SMALLEST
    /// [`ExpectedCount::LARGEST`]: super::ExpectedCount::LARGEST
    fn expected_counts(&self, population: &Population, nu: &mut [f32]);

    /// Replaces `offspring` by children of `population`: particle k gets n_k of weight 1 / nu_k, E\[n_k\] = nu_k.
    ///
    /// # Panics
    /// If the slices of `population` differ in length.
    fn resample(
        &self,
        population: &Population,
        random: &mut RandomStream,
        offspring: &mut Offspring,
    ) -> WalkReport {
        assert!(
            population.is_complete(),
            "every slice of a population has one entry per particle"
        );
        self.expected_counts(population, offspring.wishes_mut(population.len()));
        let report = offspring.settle(population);
        offspring.draw(self.rounding(), population, random);
        report
    }
}

/// Which particles form one joint population.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scope {
    /// Each particle decides alone.
    Particle,
    /// The offspring of one camera path.
    CameraPath,
    /// All paths of a pixel.
    Pixel,
    /// All paths of a tile of pixels.
    Tile,
}

impl Scope {
    /// Every joint scope, as named in scene files and on the command line.
    pub const JOINT: [Self; 3] = [Self::CameraPath, Self::Pixel, Self::Tile];

    fn name(self) -> &'static str {
        match self {
            Self::Particle => "particle",
            Self::CameraPath => "camera-path",
            Self::Pixel => "pixel",
            Self::Tile => "tile",
        }
    }
}

impl Display for Scope {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Reads the name of a joint scope: what a user may choose as population.
impl FromStr for Scope {
    type Err = SettingError;

    fn from_str(text: &str) -> Result<Self, SettingError> {
        SettingError::choose("population", text, &Self::JOINT)
    }
}

/// How a spectral quantity becomes one number. Both are positive wherever a component is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scalar {
    /// The mean over the wavelengths or channels that the path carries.
    Mean,
    /// The largest of them.
    Maximum,
}
