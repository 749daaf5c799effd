//! Stage, only for samplers that number the particles of a pixel by where they are: hits are sorted.
//!
//! Neighbours in the order face the same way (one of six classes) and lie close together (Morton order of the position). So what they
//! have yet to see is alike, and points that are spread evenly over neighbours are spread evenly over each part of the scene
//! (array-RQMC: L'Ecuyer, Lécot and Tuffin 2008; Gerber and Chopin 2015, "Sequential quasi-Monte Carlo").

use std::ops::Range;

use glam::Vec3;

use super::batch::Segments;
use crate::room::make_room;
use crate::sampling::Frame;
use crate::spectrum::Colour;

/// Bits of a key for the place along each axis.
const PLACE_BITS: u32 = 12;
/// Bits of a key for the number of the particle in its pixel. Where there are more particles, those beyond stay unsorted.
const NUMBER_BITS: u32 = 25;
/// Those who have left the scene come last.
const LEFT: u64 = 7;

/// Where segments are sorted: the memory of one thread.
pub(super) struct Arrangement<C: Colour> {
    keys: Vec<u64>,
    order: Vec<u32>,
    spare: Segments<C>,
}

impl<C: Colour> Default for Arrangement<C> {
    fn default() -> Self {
        Self {
            keys: Vec::new(),
            order: Vec::new(),
            spare: Segments::new(),
        }
    }
}

impl<C: Colour> Arrangement<C> {
    /// Sorts the segments of each pixel, of which there are `samples` camera paths, by what they have hit.
    pub fn arrange(&mut self, samples: u32, segments: &mut Segments<C>) {
        make_room(&mut self.order, segments.len());
        let mut start = 0;
        for pixel in segments
            .path
            .chunk_by(|one, next| one / samples == next / samples)
        {
            let particles = start..start + pixel.len();
            start = particles.end;
            self.sort(segments, particles);
        }
        self.spare.gather(segments, &self.order);
        std::mem::swap(&mut self.spare, segments);
    }

    /// Appends the `particles` of one pixel to the order.
    fn sort(&mut self, segments: &Segments<C>, particles: Range<usize>) {
        let first = particles.start as u32;
        let most = particles.len().min(1 << NUMBER_BITS);
        let (sorted, rest) = (
            particles.start..particles.start + most,
            particles.start + most..particles.end,
        );
        let places = Places::of(segments, sorted.clone());
        self.keys.clear();
        self.keys.extend((0..).zip(sorted).map(|(number, i)| {
            let place = if segments.hits.is_hit(i) {
                places.key(segments.end(i), segments.facing(i))
            } else {
                LEFT << (3 * PLACE_BITS)
            };
            place << NUMBER_BITS | number
        }));
        self.keys.sort_unstable();
        let number = |key: &u64| first + (key & ((1 << NUMBER_BITS) - 1)) as u32;
        self.order.extend(self.keys.iter().map(number));
        self.order.extend(rest.map(|i| i as u32));
    }
}

/// The box of what the particles of a pixel have hit.
struct Places {
    least: Vec3,
    scale: Vec3,
}

impl Places {
    fn of<C: Colour>(segments: &Segments<C>, particles: Range<usize>) -> Self {
        let hits = particles.filter(|&i| segments.hits.is_hit(i));
        let nothing = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let (least, most) = hits.fold(nothing, |(least, most), i| {
            let end = segments.end(i);
            (least.min(end), most.max(end))
        });
        let cells = (1 << PLACE_BITS) as f32;
        // Where all lie in one plane, the scale is infinite, or not a number; both end in one cell.
        Self {
            least,
            scale: Vec3::splat(cells * (1.0 - f32::EPSILON)) / (most - least),
        }
    }

    /// The sort key of a hit at `position` on a surface that faces `normal`: its class, then the Morton code of its place.
    fn key(&self, position: Vec3, normal: Vec3) -> u64 {
        let [x, y, z] = ((position - self.least) * self.scale)
            .to_array()
            // Conversion saturates, and gives 0 for what is no number.
            .map(|place| spread((place as u32).min((1 << PLACE_BITS) - 1)));
        u64::from(Frame::class(normal)) << (3 * PLACE_BITS) | x << 2 | y << 1 | z
    }
}

/// Puts two zeros before each of 12 bits.
fn spread(bits: u32) -> u64 {
    let mut bits = u64::from(bits);
    bits = (bits | bits << 16) & 0xff00_00ff;
    bits = (bits | bits << 8) & 0x0f00_f00f;
    bits = (bits | bits << 4) & 0xc30c_30c3;
    (bits | bits << 2) & 0x2_4924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_spread() {
        for bits in 0..1 << PLACE_BITS {
            let bit = |i| u64::from(bits >> i & 1) << (3 * i);
            assert_eq!(spread(bits), (0..PLACE_BITS).map(bit).sum::<u64>());
        }
    }

    #[test]
    fn neighbours_in_space_are_neighbours_in_the_order() {
        let places = Places {
            least: Vec3::ZERO,
            scale: Vec3::new(4096.0, 4096.0, f32::INFINITY),
        };
        let key = |x, y, normal| places.key(Vec3::new(x, y, 0.0), normal);
        assert!(key(0.1, 0.1, Vec3::X) < key(0.2, 0.1, Vec3::X));
        assert!(key(0.49, 0.49, Vec3::X) < key(0.51, 0.0, Vec3::X));
        assert!(key(0.9, 0.9, Vec3::X) < key(0.1, 0.1, Vec3::NEG_X));
        assert!(key(0.9, 0.9, Vec3::NEG_Z) < LEFT << (3 * PLACE_BITS));
        // Beyond the box, and where nothing can be said.
        assert_eq!(key(f32::NAN, 9.0, Vec3::X), key(0.0, 1.0, Vec3::X));
    }
}
