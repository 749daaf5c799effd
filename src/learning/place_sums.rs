//! Sums of what was observed at one place, and what they say.

use serde::{Deserialize, Serialize};

use super::light_sums::LightSums;
use super::lobe::{LobeMoments, LobeSums};
use super::mixture::MixtureSums;
use super::moments::MomentSums;
use super::square_warp::SIDE;
use super::{Insight, Moments, Observation, SquareWarp};

/// How many observations of its family each bin of a cell is filled up with.
pub(super) const OF_FAMILY: f32 = 4.0;

/// How many observations of its own mean each bin of a family is filled up with.
const OF_MEAN: f32 = 2.0;

/// Directions are guided where so much of the variance at most is left by it: it takes time, and where light comes from everywhere it brings nothing.
const WORTH_GUIDING: f32 = 0.9;

/// The sums of one cell and class of normals.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct PlaceSums {
    pub moments: MomentSums,
    /// Of what was observed where surfaces have lobes.
    lobes: Option<Box<LobeSums>>,
    mixture: MixtureSums,
    pub lights: LightSums,
    bins: [[BinSums; SIDE]; SIDE],
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct BinSums {
    count: f32,
    radiance: f32,
    square: f32,
}

impl BinSums {
    fn add(&mut self, other: Self, share: f32) {
        self.count += share * other.count;
        self.radiance += share * other.radiance;
        self.square += share * other.square;
    }
}

impl PlaceSums {
    /// Adds a `share` of `other` sums.
    pub fn add(&mut self, other: &Self, share: f32) {
        self.moments.add(&other.moments, share);
        if let Some(lobes) = &other.lobes {
            self.lobes.get_or_insert_default().add(lobes, share);
        }
        self.mixture.add(&other.mixture, share);
        self.lights.add(&other.lights, share);
        let bins = self.bins.as_flattened_mut().iter_mut();
        for (bin, other) in bins.zip(other.bins.as_flattened()) {
            bin.add(*other, share);
        }
    }

    /// Adds an observation.
    pub fn observe(&mut self, observation: &Observation) {
        self.moments.observe(observation);
        if let Some(class) = observation.lobe {
            let lobes = self.lobes.get_or_insert_default();
            lobes.of(class).observe(observation);
        }
        if let Some(odds) = &observation.odds {
            self.mixture.observe(odds, observation.value);
        }
        if let Some(bin) = observation.bin {
            let [row, column] = bin.place();
            let bin = &mut self.bins[row][column];
            bin.count += 1.0;
            bin.radiance += observation.radiance;
            bin.square += observation.radiance * observation.radiance;
        }
    }

    /// What these sums say, filled up with [`OF_FAMILY`] observations like those of the `family`.
    pub fn insight(&self, family: &Self) -> Insight {
        let radiance = self.means(family, |bin| bin.radiance);
        let square = self.means(family, |bin| bin.square);
        let warp = SquareWarp::new(&radiance, family.moments.count);
        let guides = warp.variance_left(&radiance, &square) < WORTH_GUIDING;
        Insight {
            moments: self.moments.filled_up(OF_FAMILY, &family.moments.moments()),
            guides,
            mixed_share: family.mixture.best(),
            warp: if guides { warp } else { SquareWarp::UNIFORM },
        }
    }

    /// What these sums say of each class of lobes, if any was seen, where all paths together have the moments `place`.
    pub fn of_lobes(&self, place: &Moments) -> Option<Box<LobeMoments>> {
        let lobes = self.lobes.as_ref()?;
        Some(Box::new(lobes.moments(place)))
    }

    /// The mean of what `sum` adds up, for each bin: filled up by the `family`, and that by the mean of all its bins.
    fn means(&self, family: &Self, sum: impl Fn(&BinSums) -> f32) -> [[f32; SIDE]; SIDE] {
        let of_family = family.bins.as_flattened();
        let mean = ratio(of_family.iter().map(&sum).sum(), family.moments.count);
        let mut means = [[0.0; SIDE]; SIDE];
        let bins = self.bins.as_flattened().iter().zip(of_family);
        for (filled, (own, family)) in means.as_flattened_mut().iter_mut().zip(bins) {
            let of_family = (sum(family) + OF_MEAN * mean) / (family.count + OF_MEAN);
            *filled = (sum(own) + OF_FAMILY * of_family) / (own.count + OF_FAMILY);
        }
        means
    }
}

fn ratio(sum: f32, count: f32) -> f32 {
    if count > 0.0 { sum / count } else { 0.0 }
}
