//! The pixels of a tile, whichever numbers they add up in.

use serde::{Deserialize, Serialize};

use super::{CompensatedSum, FilmSums, PixelStatistics};

/// The pixels of a tile, row by row. All tiles of a film have the same kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum TilePixels {
    /// See [`FilmSums::Single`].
    Single(Vec<PixelStatistics<f32>>),
    /// See [`FilmSums::Double`].
    Double(Vec<PixelStatistics<f64>>),
    /// See [`FilmSums::Compensated`].
    Compensated(Vec<PixelStatistics<CompensatedSum>>),
}

impl TilePixels {
    /// So many pixels without samples.
    pub(super) fn new(sums: FilmSums, count: usize) -> Self {
        match sums {
            FilmSums::Single => Self::Single(vec![PixelStatistics::default(); count]),
            FilmSums::Double => Self::Double(vec![PixelStatistics::default(); count]),
            FilmSums::Compensated => Self::Compensated(vec![PixelStatistics::default(); count]),
        }
    }

    /// The numbers in which they add up.
    pub fn sums(&self) -> FilmSums {
        match self {
            Self::Single(_) => FilmSums::Single,
            Self::Double(_) => FilmSums::Double,
            Self::Compensated(_) => FilmSums::Compensated,
        }
    }

    /// The number of pixels.
    pub fn count(&self) -> usize {
        match self {
            Self::Single(pixels) => pixels.len(),
            Self::Double(pixels) => pixels.len(),
            Self::Compensated(pixels) => pixels.len(),
        }
    }

    /// One of them.
    ///
    /// # Panics
    /// If there are not so many.
    pub fn get(&self, index: usize) -> PixelStatistics {
        match self {
            Self::Single(pixels) => pixels[index].in_double(),
            Self::Double(pixels) => pixels[index],
            Self::Compensated(pixels) => pixels[index].in_double(),
        }
    }

    /// All of them.
    pub fn iter(&self) -> impl Iterator<Item = PixelStatistics> {
        (0..self.count()).map(|index| self.get(index))
    }
}
