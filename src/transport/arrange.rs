//! Stage, only for samplers that number the particles of a pixel by where they are: hits are sorted.
//!
//! Neighbours in the order face the same way (one of six classes) and lie close together (Morton order of the position). So what they
//! have yet to see is alike, and points that are spread evenly over neighbours are spread evenly over each part of the scene
//! (array-RQMC: L'Ecuyer, Lécot and Tuffin 2008; Gerber and Chopin 2015, "Sequential quasi-Monte Carlo").

use glam::Vec3;
use multiversion::multiversion;

use super::batch::{CameraPaths, Segments};
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
    /// Where each segment ends, in world space; no number where it has left the scene.
    ends: [Vec<f32>; 3],
    /// Which way what each met faces, or [`LEFT`]; then the place of that as well.
    names: Vec<u32>,
    /// Of one pixel, the name of each, and its number.
    keys: Vec<u64>,
    order: Vec<u32>,
    spare: Segments<C>,
}

impl<C: Colour> Default for Arrangement<C> {
    fn default() -> Self {
        Self {
            ends: Default::default(),
            names: Vec::new(),
            keys: Vec::new(),
            order: Vec::new(),
            spare: Segments::new(),
        }
    }
}

impl<C: Colour> Arrangement<C> {
    /// Sorts the segments of each pixel by what they have hit.
    pub fn arrange(&mut self, paths: &CameraPaths<C>, segments: &mut Segments<C>) {
        let Self {
            ends,
            names,
            keys,
            order,
            spare,
        } = self;
        let count = segments.len();
        ends.iter_mut().for_each(|axis| resize(axis, count));
        resize(names, count);
        look(segments, ends, names);
        make_room(order, count);
        sort(paths, &segments.path, ends, names, keys, order);
        spare.gather(segments, order);
        std::mem::swap(spare, segments);
    }
}

/// Writes where each segment ends, no number on any axis for those who have left the scene, and into its name which way what it met faces.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
fn look<C: Colour>(segments: &Segments<C>, ends: &mut [Vec<f32>; 3], names: &mut [u32]) {
    let (rays, hits) = (&segments.rays, &segments.hits);
    let geometries = hits.geometry_ids();
    let lines = rays.origins().into_iter().zip(rays.directions());
    for (axis, (origins, directions)) in ends.iter_mut().zip(lines) {
        let numbers = origins.iter().zip(directions).zip(rays.tfars());
        for ((end, &geometry), ((origin, direction), t)) in
            axis.iter_mut().zip(geometries).zip(numbers)
        {
            let is_hit = geometry != INVALID_GEOMETRY;
            *end = if is_hit {
                origin + t * direction
            } else {
                f32::NAN
            };
        }
    }
    let ([nx, ny, nz], [dx, dy, dz]) = (hits.normals(), rays.directions());
    for (i, name) in names.iter_mut().enumerate() {
        let normal = Vec3::new(nx[i], ny[i], nz[i]);
        let facing = normal * -1.0_f32.copysign(normal.dot(Vec3::new(dx[i], dy[i], dz[i])));
        let is_hit = geometries[i] != INVALID_GEOMETRY;
        let class = if is_hit { Frame::class(facing) } else { LEFT };
        *name = class << (3 * PLACE_BITS);
    }
}

/// Appends the numbers of all particles to `order`, which is empty: those of each pixel by `names`, to which their places are added. `descent` has the
/// camera path of every particle.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
fn sort<C: Colour>(
    paths: &CameraPaths<C>,
    descent: &[u32],
    ends: &[Vec<f32>; 3],
    names: &mut [u32],
    keys: &mut Vec<u64>,
    order: &mut Vec<u32>,
) {
    let mut first = 0;
    while let Some(path) = descent.get(first) {
        let next_pixel = paths.ends[paths.pixel(*path) as usize];
        let particles = descent[first..].iter();
        let count = particles.take_while(|&&path| path < next_pixel).count();
        let pixel = first..first + count;
        if count == 1 {
            order.push(first as u32);
        } else {
            let ends = ends.each_ref().map(|axis| &axis[pixel.clone()]);
            add_places(ends, &mut names[pixel.clone()]);
            resize(keys, count);
            for ((i, key), &name) in (first as u64..).zip(&mut *keys).zip(&names[pixel]) {
                *key = u64::from(name) << 32 | i;
            }
            keys.sort_unstable();
            order.extend(keys.iter().map(|&key| key as u32));
        }
        first += count;
    }
}

/// Adds to the names of the particles of one pixel the Morton codes of their `ends` in the box of all.
#[inline(always)]
fn add_places(ends: [&[f32]; 3], names: &mut [u32]) {
    for (ends, bit) in ends.into_iter().zip([2, 1, 0]) {
        let axis = Axis::of(ends);
        for (name, &end) in names.iter_mut().zip(ends) {
            *name |= axis.place(end) << bit;
        }
    }
}

/// One axis of the box of all particles of a pixel.
#[derive(Clone, Copy)]
struct Axis {
    least: f32,
    scale: f32,
}

impl Axis {
    /// That of these `ends`, where they are numbers.
    #[inline(always)]
    fn of(ends: &[f32]) -> Self {
        const LANES: usize = 8;
        // Comparisons with what is no number are false.
        let lesser = |one: f32, other: f32| if other < one { other } else { one };
        let greater = |one: f32, other: f32| if other > one { other } else { one };
        let (mut least, mut most) = ([f32::INFINITY; LANES], [f32::NEG_INFINITY; LANES]);
        let (chunks, rest) = ends.as_chunks::<LANES>();
        for ends in chunks {
            for lane in 0..LANES {
                least[lane] = lesser(least[lane], ends[lane]);
                most[lane] = greater(most[lane], ends[lane]);
            }
        }
        for (lane, &end) in rest.iter().enumerate() {
            least[lane] = lesser(least[lane], end);
            most[lane] = greater(most[lane], end);
        }
        let least = least.into_iter().fold(f32::INFINITY, lesser);
        let most = most.into_iter().fold(f32::NEG_INFINITY, greater);
        Self {
            least,
            // Where all lie in one plane, this is infinite, and places are not numbers.
            scale: (1 << PLACE_BITS) as f32 / (most - least),
        }
    }

    /// Where on the axis `end` is, in [`PLACE_BITS`] bits with two zeros before each.
    #[inline(always)]
    fn place(self, end: f32) -> u32 {
        const LAST: f32 = ((1 << PLACE_BITS) - 1) as f32;
        /// Sums with it have their integers in the last bits.
        const INTEGERS: f32 = (1 << 23) as f32;
        let place = (end - self.least) * self.scale - 0.5;
        let place = if place < LAST { place } else { LAST };
        let place = if place > 0.0 { place } else { 0.0 };
        spread((place + INTEGERS).to_bits() - INTEGERS.to_bits())
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
    use super::super::path_counts::PathCounts;
    use super::*;
    use crate::spectrum::Rgb;

    #[test]
    fn bits_are_spread() {
        for bits in 0..1 << PLACE_BITS {
            let bit = |i| (bits >> i & 1) << (3 * i);
            assert_eq!(spread(bits), (0..PLACE_BITS).map(bit).sum::<u32>());
        }
    }

    #[test]
    fn neighbours_in_space_are_neighbours_in_the_order() {
        // Of three pixels, the first and the last have one particle. In the other, the fifth faces another way, the sixth has left the scene.
        let mut paths = CameraPaths::<Rgb>::new();
        paths.restart(0..3, PathCounts::Even(4));
        let descent = [3, 4, 5, 5, 7, 4, 6, 7, 8];
        let ends = [
            vec![9.0, 0.0, 1.0, 0.49, 0.51, 0.1, f32::NAN, 0.9, 0.0],
            vec![9.0, 0.0, 1.0, 0.49, 0.1, 0.1, f32::NAN, 0.9, 0.0],
            vec![9.0, 5.0, 5.0, 5.0, 5.0, 5.0, f32::NAN, 5.0, 0.0],
        ];
        let mut names = [0, 2, 2, 2, 2, 1, LEFT, 2, 0].map(|class| class << (3 * PLACE_BITS));
        let (mut keys, mut order) = (Vec::new(), Vec::new());
        sort(&paths, &descent, &ends, &mut names, &mut keys, &mut order);
        assert_eq!(order, [0, 5, 1, 3, 4, 7, 2, 6, 8]);
    }
}
