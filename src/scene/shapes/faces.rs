//! The triangles of a mesh as the intersection layer takes them: by pairs that share an edge.

use std::sync::Arc;

use crate::embree::prefetch;
use crate::scene::mesh::pairing::{self, Corner, Pairing};

/// The triangles of a mesh: first those that are alone, then those in pairs, both triangles of a pair one after the other.
#[derive(Clone, Debug)]
pub struct Faces {
    /// Vertices: (a, b, d, d) of a triangle (a, b, d) that is alone, (a, b, c, d) of the triangles (a, b, d) and (c, d, b).
    quads: Arc<Vec<[u32; 4]>>,
    /// How many of the triangles are alone.
    alone: u32,
}

/// Triangles in a new order.
#[derive(Debug)]
pub(super) struct Reordered {
    pub faces: Faces,
    /// By triangle in the new order: the corner of the old one with which it begins.
    pub beginnings: Vec<Corner>,
}

impl Faces {
    /// Puts triangles, whose indices must be below the number of `positions`, in order. There must be less than 2^32 of them.
    pub(super) fn of(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Reordered {
        let Pairing { alone, pairs } = Pairing::new(positions, triangles);
        let vertex = |corner: Corner| triangles.as_flattened()[corner as usize];
        let singles = alone.iter().map(|&first| {
            let [second, third] = [pairing::next(first), pairing::previous(first)].map(vertex);
            [vertex(first), second, third, third]
        });
        let doubles = pairs.iter().map(|&[first, second]| {
            [
                first,
                pairing::next(first),
                second,
                pairing::previous(first),
            ]
            .map(vertex)
        });
        Reordered {
            faces: Self {
                quads: Arc::new(singles.chain(doubles).collect()),
                alone: alone.len() as u32,
            },
            beginnings: [&alone, pairs.as_flattened()].concat(),
        }
    }

    /// The quads, as the intersection layer takes them.
    pub fn quads(&self) -> &Arc<Vec<[u32; 4]>> {
        &self.quads
    }

    /// The number of quads, from the first on, that are one triangle; all after them are two.
    pub fn alone(&self) -> u32 {
        self.alone
    }

    /// The number of triangles, at least 1.
    #[expect(clippy::len_without_is_empty, reason = "a mesh has triangles")]
    pub fn len(&self) -> usize {
        2 * self.quads.len() - self.alone as usize
    }

    /// The vertices of a triangle.
    #[inline(always)]
    pub fn corners(&self, triangle: u32) -> [u32; 3] {
        let (quad, is_second) = self.place(triangle);
        let [a, b, c, d] = self.quads[quad as usize];
        if is_second { [c, d, b] } else { [a, b, d] }
    }

    /// Says that [`Self::corners`] of a triangle will be asked for soon.
    #[inline(always)]
    pub fn prefetch(&self, triangle: u32) {
        prefetch(&self.quads, self.place(triangle).0);
    }

    /// The vertices of all triangles.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = [u32; 3]> {
        (0..self.len() as u32).map(|triangle| self.corners(triangle))
    }

    /// The quad of a triangle, and whether the triangle is its second.
    #[inline(always)]
    fn place(&self, triangle: u32) -> (u32, bool) {
        match triangle.checked_sub(self.alone) {
            None => (triangle, false),
            Some(in_pairs) => (self.alone + in_pairs / 2, in_pairs % 2 == 1),
        }
    }
}
