//! The ranks of particles in their pixel.

use super::{PixelSequences, SequencePoint};

/// Numbers the particles of each pixel in the order in which they come: those of a pixel side by side, pixel by pixel.
#[derive(Default)]
pub struct Ranks {
    next: SequencePoint,
    /// The first camera path of the next pixel.
    end: u32,
}

impl Ranks {
    /// The point of the next particle, which descends from camera path number `path` of the batch. `pixels` has the pixel of every path, and of every
    /// pixel `ends` has the first path of the next one, and `sequences` what it draws from.
    #[inline(always)]
    pub fn next(
        &mut self,
        path: u32,
        pixels: &[u32],
        ends: &[u32],
        sequences: &[PixelSequences],
    ) -> SequencePoint {
        if path >= self.end {
            let pixel = pixels[path as usize] as usize;
            self.end = ends[pixel];
            self.next = sequences[pixel].first_rank();
        }
        let point = self.next;
        self.next = point.successor();
        point
    }
}
