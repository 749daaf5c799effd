//! Stage, only for samplers that number the particles of a pixel by where they are: hits are sorted.
//!
//! Neighbours in the order face the same way (one of six classes) and lie close together (Morton order of the position). So what they
//! have yet to see is alike, and points that are spread evenly over neighbours are spread evenly over each part of the scene
//! (array-RQMC: L'Ecuyer, Lécot and Tuffin 2008; Gerber and Chopin 2015, "Sequential quasi-Monte Carlo").

use glam::Vec3;
use multiversion::multiversion;

use super::batch::Segments;
use crate::embree::INVALID_GEOMETRY;
use crate::room::{make_room, resize};
use crate::sampling::Frame;
use crate::spectrum::Colour;

/// Bits of a key for the place along each axis: with the class, all fit 32 bits.
const PLACE_BITS: u32 = 9;
/// Those who have left the scene come last.
const LEFT: u32 = 7;

/// Where segments are sorted: the memory of one thread.
pub(super) struct Arrangement<C: Colour> {
    /// Where each segment ends, in world space.
    ends: [Vec<f32>; 3],
    /// Which way what it met faces, or [`LEFT`].
    classes: Vec<u32>,
    /// The name of each, and its number in its pixel.
    keys: Vec<u64>,
    order: Vec<u32>,
    spare: Segments<C>,
}

impl<C: Colour> Default for Arrangement<C> {
    fn default() -> Self {
        Self {
            ends: Default::default(),
            classes: Vec::new(),
            keys: Vec::new(),
            order: Vec::new(),
            spare: Segments::new(),
        }
    }
}

impl<C: Colour> Arrangement<C> {
    /// Sorts the segments of each pixel, of which there are `samples` camera paths, by what they have hit.
    pub fn arrange(&mut self, samples: u32, segments: &mut Segments<C>) {
        let Self {
            ends,
            classes,
            keys,
            order,
            spare,
        } = self;
        ends.iter_mut()
            .for_each(|axis| resize(axis, segments.len()));
        resize(classes, segments.len());
        look(segments, ends, classes);
        make_room(order, segments.len());
        let pixels = segments
            .path
            .chunk_by(|one, next| one / samples == next / samples);
        for pixel in pixels {
            let first = order.len();
            let sorted = first..first + pixel.len();
            let ends = ends.each_ref().map(|axis| &axis[sorted.clone()]);
            name(ends, &classes[sorted], keys);
            keys.sort_unstable();
            order.extend(keys.iter().map(|&key| first as u32 + key as u32));
        }
        spare.gather(segments, order);
        std::mem::swap(spare, segments);
    }
}

/// Writes where each segment ends, and which way what it met faces.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
fn look<C: Colour>(segments: &Segments<C>, ends: &mut [Vec<f32>; 3], classes: &mut [u32]) {
    let (rays, hits) = (&segments.rays, &segments.hits);
    let lines = rays.origins().into_iter().zip(rays.directions());
    for (axis, (origins, directions)) in ends.iter_mut().zip(lines) {
        let numbers = origins.iter().zip(directions).zip(rays.tfars());
        for (end, ((origin, direction), t)) in axis.iter_mut().zip(numbers) {
            *end = origin + t * direction;
        }
    }
    let ([nx, ny, nz], [dx, dy, dz]) = (hits.normals(), rays.directions());
    let geometries = hits.geometry_ids();
    for (i, class) in classes.iter_mut().enumerate() {
        let normal = Vec3::new(nx[i], ny[i], nz[i]);
        let facing = normal * -1.0_f32.copysign(normal.dot(Vec3::new(dx[i], dy[i], dz[i])));
        let is_hit = geometries[i] != INVALID_GEOMETRY;
        *class = if is_hit { Frame::class(facing) } else { LEFT };
    }
}

/// Makes `keys` those of the particles of one pixel, of which there are `ends` and `classes`: class, Morton code of the place in the box
/// of all, number.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
fn name(ends: [&[f32]; 3], classes: &[u32], keys: &mut Vec<u64>) {
    const CELLS: f32 = (1 << PLACE_BITS) as f32;
    let [x, y, z] = ends.map(|axis| {
        let (mut least, mut most) = (f32::INFINITY, f32::NEG_INFINITY);
        for (&end, &class) in axis.iter().zip(classes) {
            let counts = class != LEFT;
            least = if counts & (end < least) { end } else { least };
            most = if counts & (end > most) { end } else { most };
        }
        // Where all lie in one plane, the scale is infinite, and places are not numbers.
        let scale = CELLS / (most - least);
        move |i: usize| {
            let place = (axis[i] - least) * scale;
            let place = if place < CELLS - 1.0 {
                place
            } else {
                CELLS - 1.0
            };
            let place = if place > 0.0 { place } else { 0.0 };
            spread(place as i32 as u32)
        }
    });
    resize(keys, classes.len());
    for (i, (key, &class)) in keys.iter_mut().zip(classes).enumerate() {
        let place = if class == LEFT {
            0
        } else {
            x(i) << 2 | y(i) << 1 | z(i)
        };
        *key = u64::from(class << (3 * PLACE_BITS) | place) << 32 | i as u64;
    }
}

/// Puts two zeros before each of [`PLACE_BITS`] bits.
#[inline(always)]
fn spread(bits: u32) -> u32 {
    let bits = (bits | bits << 16) & 0x0300_00ff;
    let bits = (bits | bits << 8) & 0x0300_f00f;
    let bits = (bits | bits << 4) & 0x030c_30c3;
    (bits | bits << 2) & 0x0924_9249
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_are_spread() {
        for bits in 0..1 << PLACE_BITS {
            let bit = |i| (bits >> i & 1) << (3 * i);
            assert_eq!(spread(bits), (0..PLACE_BITS).map(bit).sum::<u32>());
        }
    }

    #[test]
    fn neighbours_in_space_are_neighbours_in_the_order() {
        let ends = [
            [0.0, 1.0, 0.49, 0.51, 0.1, f32::NAN, 0.9],
            [0.0, 1.0, 0.49, 0.1, 0.1, 0.0, 0.9],
            [5.0; 7],
        ];
        // The fifth faces another way, the sixth has left the scene.
        let classes = [2, 2, 2, 2, 1, LEFT, 2];
        let mut keys = Vec::new();
        name(ends.each_ref().map(|axis| &axis[..]), &classes, &mut keys);
        keys.sort_unstable();
        let order: Vec<u32> = keys.iter().map(|&key| key as u32).collect();
        assert_eq!(order, [4, 0, 2, 3, 6, 1, 5]);
    }
}
