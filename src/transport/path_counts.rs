//! How many camera paths the pixels of a tile get.

use std::ops::Range;

/// How many camera paths each pixel of a tile gets in a batch: at least one.
#[derive(Clone, Copy, Debug)]
pub enum PathCounts<'c> {
    /// All the same number.
    Even(u32),
    /// Each a number of its own, in the order of the tile's pixels.
    Each(&'c [u32]),
}

impl PathCounts<'_> {
    /// How many camera paths the pixel with this index in the tile gets.
    #[inline(always)]
    pub fn of_pixel(self, index: usize) -> u32 {
        match self {
            Self::Even(count) => count,
            Self::Each(counts) => counts[index],
        }
    }

    /// How many all `pixels` together get.
    pub fn of_pixels(self, pixels: Range<usize>) -> u64 {
        match self {
            Self::Even(count) => pixels.len() as u64 * u64::from(count),
            Self::Each(counts) => counts[pixels].iter().map(|&count| u64::from(count)).sum(),
        }
    }
}
