//! Second moments of the samples, for films that are asked for them.

use serde::{Deserialize, Serialize};

/// What the pixels of a tile know of the squares of their samples, row by row.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SecondMoments {
    /// Weighted sums over the samples of X^2, Y^2 and Z^2 (CIE).
    sums: Vec<[f64; 3]>,
}

impl SecondMoments {
    /// Those of so many pixels without samples.
    pub(super) fn new(count: usize) -> Self {
        Self {
            sums: vec![[0.0; 3]; count],
        }
    }

    /// The number of pixels.
    pub fn count(&self) -> usize {
        self.sums.len()
    }

    /// Adds a sample of the colour `xyz` (CIE) to the pixel `index`, with a `weight`.
    ///
    /// # Panics
    /// If there are not so many pixels.
    #[inline]
    pub fn add(&mut self, index: usize, xyz: [f64; 3], weight: f64) {
        for (sum, value) in self.sums[index].iter_mut().zip(xyz) {
            *sum += weight * (value * value);
        }
    }

    /// The weighted means of the squares in the pixel `index`, whose samples together have that `weight`; 0 while there are none.
    ///
    /// # Panics
    /// If there are not so many pixels.
    pub fn mean(&self, index: usize, weight: f64) -> [f64; 3] {
        self.sums[index].map(|sum| if weight > 0.0 { sum / weight } else { 0.0 })
    }
}
