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
    /// The point of the next particle, which descends from camera path number `path` of the batch; each pixel has `samples` of these, and one of the
    /// `sequences`.
    #[inline(always)]
    pub fn next(&mut self, path: u32, samples: u32, sequences: &[PixelSequences]) -> SequencePoint {
        if path >= self.end {
            let pixel = path / samples;
            self.end = (pixel + 1) * samples;
            self.next = sequences[pixel as usize].first_rank();
        }
        let point = self.next;
        self.next = point.successor();
        point
    }
}
