//! The ranks of particles in their pixel.

use super::SequencePoint;
use super::sobol::scramble;

/// Numbers the particles of each pixel in the order in which they come: those of a pixel side by side.
///
/// A rank counts the samples of all passes before, so that the passes of a pixel go on with one lattice.
pub struct Ranks {
    key: [u32; 4],
    before: u32,
    pixel: Option<u32>,
    next: SequencePoint,
}

impl Ranks {
    /// The ranks of a batch whose sequences `key` names, where each pixel has had `before` samples in all passes before.
    pub(super) fn new(key: [u32; 4], before: u64) -> Self {
        Self {
            key,
            // Beyond 2^32 the lattice begins again.
            before: before as u32,
            pixel: None,
            next: SequencePoint::default(),
        }
    }

    /// The point of the next particle, which is of pixel number `pixel` of the tile.
    #[inline(always)]
    pub fn next(&mut self, pixel: u32) -> SequencePoint {
        if self.pixel != Some(pixel) {
            self.start(pixel);
        }
        let point = self.next;
        self.next = point.successor();
        point
    }

    #[cold]
    fn start(&mut self, pixel: u32) {
        self.pixel = Some(pixel);
        self.next = SequencePoint::ranked(scramble(self.key, pixel), self.before);
    }
}
