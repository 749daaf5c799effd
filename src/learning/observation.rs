//! What is observed while paths are traced.

use serde::{Deserialize, Serialize};

use super::lobe::LobeClass;
use super::mixture::Odds;
use super::square_warp::Bin;
use crate::scene::ChosenGroup;

/// What one path segment brought back to the vertex that it had left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// Where the vertex was (one of `Knowledge::addresses`).
    pub address: u32,
    /// Where the lobes of its surface pointed, if it has any and counts are learned.
    pub lobe: Option<LobeClass>,
    /// The direction of the segment, if it is one of those that are learned.
    pub bin: Option<Bin>,
    /// How likely the direction would have been with other shares of guided directions, where they are mixed with others.
    pub odds: Option<Odds>,
    /// The radiance that came along it.
    pub radiance: f32,
    /// What it was worth: an estimate of the light that the vertex reflects, with albedo 1.
    pub value: f32,
    /// What it cost with all its descendants, where a bounce costs 1.
    pub cost: f32,
}

/// What one look at a light brought to a vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightObservation {
    /// Where the vertex was (one of `Knowledge::addresses`).
    pub address: u32,
    /// The group to which the light belongs.
    pub group: ChosenGroup,
    /// What it was worth: an estimate of the light that the vertex reflects, with albedo 1.
    pub value: f32,
}

/// What the camera paths of one pixel brought back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PixelObservation {
    /// Which pixel: row by row.
    pub pixel: u32,
    /// How many paths.
    pub paths: u32,
    /// The sum of their radiance.
    pub radiance: f32,
    /// The sum of the part of it that counts as noise: all, or all that was not seen directly.
    pub noisy: f32,
    /// The sum of the squares of that part.
    pub square: f32,
    /// The sum of what they cost, where a bounce costs 1.
    pub cost: f32,
}

impl PixelObservation {
    /// The variance of the noisy part of its paths' radiance; where there is only one path, that of all radiance about `brightness`.
    pub(super) fn variance(&self, brightness: f64) -> f64 {
        let count = f64::from(self.paths);
        if self.paths > 1 {
            let [mean, square] = [self.noisy, self.square].map(|sum| f64::from(sum) / count);
            ((square - mean * mean) * count / (count - 1.0)).max(0.0)
        } else {
            (f64::from(self.radiance) - brightness).powi(2)
        }
    }

    /// Adds what `other` paths of the same pixel brought; what is not finite is not observed.
    pub(super) fn add(&mut self, other: &Self) {
        if !(other.square >= 0.0 && other.square < f32::INFINITY) {
            return;
        }
        self.paths += other.paths;
        self.radiance += other.radiance;
        self.noisy += other.noisy;
        self.square += other.square;
        self.cost += other.cost;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_set_aside_does_not_vary() {
        // Of four paths, two saw a lamp of radiance 10 and two found 1 reflected.
        let pixel = PixelObservation {
            pixel: 0,
            paths: 4,
            radiance: 22.0,
            noisy: 2.0,
            square: 2.0,
            cost: 8.0,
        };
        assert!((pixel.variance(5.5) - 1.0 / 3.0).abs() < 1e-9);
        let single = PixelObservation { paths: 1, ..pixel };
        assert_eq!(single.variance(20.0), 4.0);
    }

    #[test]
    fn what_is_not_finite_is_not_observed() {
        let mut pixel = PixelObservation::default();
        for square in [1.0, f32::NAN, f32::INFINITY, 4.0] {
            pixel.add(&PixelObservation {
                pixel: 0,
                paths: 1,
                radiance: 1.0,
                noisy: 1.0,
                square,
                cost: 5.0,
            });
        }
        assert_eq!((pixel.paths, pixel.square, pixel.cost), (2, 5.0, 10.0));
        assert_eq!((pixel.radiance, pixel.noisy), (2.0, 2.0));
    }
}
