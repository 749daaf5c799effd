//! Which triangles go together in pairs.

use glam::Vec3;

/// A corner of a triangle, told by 3 times the triangle plus 0, 1 or 2. It also stands for the triangle that begins at it: its
/// corners are this one, the [`next`] and the [`previous`].
pub type Corner = u32;

/// No corner.
const NONE: Corner = Corner::MAX;

/// The corners of so many triangles have numbers.
pub const MOST_TRIANGLES: usize = NONE as usize / 3;

/// The triangles of a mesh, each once: those that stay alone, and pairs that share an edge.
#[derive(Debug, Default, PartialEq)]
pub struct Pairing {
    /// Each triangle begins where it began.
    pub alone: Vec<Corner>,
    /// Both triangles begin at the corner that the other lacks, so that the second goes along the edge that they share against the first:
    /// (a, b, d) and (c, d, b).
    pub pairs: Vec<[Corner; 2]>,
}

impl Pairing {
    /// Pairs triangles greedily, by the longest edge that they share with a neighbour that is still alone; where that leaves a triangle
    /// with at most one such neighbour, it is next. Few stay alone (a hundredth of a scanned surface), and it takes time and memory linear in
    /// the triangles.
    ///
    /// Indices must be below the number of `positions`, and there must be at most [`MOST_TRIANGLES`].
    pub fn new(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Self {
        let corners = triangles.as_flattened();
        Search {
            positions,
            corners,
            opposite: opposite_corners(positions.len(), corners),
            is_done: vec![false; triangles.len()],
            result: Self::default(),
        }
        .run()
    }
}

/// The triangle of a corner.
#[inline]
pub fn triangle_of(corner: Corner) -> usize {
    corner as usize / 3
}

/// Which corner of its triangle it is: 0, 1 or 2.
#[inline]
pub fn place(corner: Corner) -> u8 {
    (corner % 3) as u8
}

/// The corner that follows in its triangle.
#[inline]
pub fn next(corner: Corner) -> Corner {
    if corner % 3 == 2 {
        corner - 2
    } else {
        corner + 1
    }
}

/// The corner before it in its triangle.
#[inline]
pub fn previous(corner: Corner) -> Corner {
    if corner.is_multiple_of(3) {
        corner + 2
    } else {
        corner - 1
    }
}

/// Pairs being found.
struct Search<'m> {
    positions: &'m [[f32; 3]],
    /// By corner: its vertex.
    corners: &'m [u32],
    /// By corner: the one across the edge that it does not touch, or [`NONE`].
    opposite: Vec<Corner>,
    /// By triangle: whether it is in the result.
    is_done: Vec<bool>,
    result: Pairing,
}

impl Search<'_> {
    fn run(mut self) -> Pairing {
        let mut next_ones = Vec::new();
        for triangle in 0..self.is_done.len() {
            next_ones.push(triangle);
            while let Some(triangle) = next_ones.pop() {
                if !self.is_done[triangle] {
                    self.settle(triangle, &mut next_ones);
                }
            }
        }
        self.result
    }

    /// Finds a partner for a triangle, and says which triangles have hardly a choice any more.
    fn settle(&mut self, triangle: usize, next_ones: &mut Vec<usize>) {
        self.is_done[triangle] = true;
        let free = self.free_neighbours(triangle);
        let by_length = |a: &Corner, b: &Corner| self.edge(*a).total_cmp(&self.edge(*b));
        let Some(corner) = free.max_by(by_length) else {
            self.result.alone.push(3 * triangle as Corner);
            return;
        };
        let partner = self.opposite[corner as usize];
        self.result.pairs.push([corner, partner]);
        self.is_done[triangle_of(partner)] = true;
        for done in [triangle, triangle_of(partner)] {
            let neighbours = self.free_neighbours(done);
            let neighbours = neighbours.map(|corner| triangle_of(self.opposite[corner as usize]));
            next_ones.extend(neighbours.filter(|&one| self.free_neighbours(one).count() <= 1));
        }
    }

    /// The corners of a triangle across from which there is one that is still alone.
    fn free_neighbours(&self, triangle: usize) -> impl Iterator<Item = Corner> {
        let first = 3 * triangle as Corner;
        (first..first + 3).filter(move |&corner| {
            let opposite = self.opposite[corner as usize];
            opposite != NONE
                && triangle_of(opposite) != triangle
                && !self.is_done[triangle_of(opposite)]
        })
    }

    /// The squared length of the edge that a corner does not touch.
    fn edge(&self, corner: Corner) -> f32 {
        let [a, b] = [next(corner), previous(corner)]
            .map(|end| Vec3::from(self.positions[self.corners[end as usize] as usize]));
        a.distance_squared(b)
    }
}

/// By corner: the one across the edge that it does not touch, of a triangle that goes along that edge the other way, as neighbours on
/// an oriented surface do; [`NONE`] where there is none. No corner is that of two others.
fn opposite_corners(vertices: usize, corners: &[u32]) -> Vec<Corner> {
    let fans = Fans::new(vertices, corners);
    let vertex = |corner: Corner| corners[corner as usize];
    let mut opposite = vec![NONE; corners.len()];
    for corner in 0..corners.len() as Corner {
        if opposite[corner as usize] != NONE {
            continue;
        }
        let (from, to) = (vertex(next(corner)), vertex(previous(corner)));
        let is_free = |other: &Corner| *other > corner && opposite[*other as usize] == NONE;
        // An edge from `to` to `from`, looked for where fewer triangles meet.
        let (at_from, at_to) = (fans.at(from), fans.at(to));
        let found = if at_from.len() < at_to.len() {
            let ends = at_from.iter().filter(|&&end| vertex(previous(end)) == to);
            ends.map(|&end| next(end)).find(is_free)
        } else {
            let starts = at_to.iter().filter(|&&start| vertex(next(start)) == from);
            starts.map(|&start| previous(start)).find(is_free)
        };
        if let Some(other) = found {
            opposite[corner as usize] = other;
            opposite[other as usize] = corner;
        }
    }
    opposite
}

/// The corners at each vertex.
struct Fans {
    /// By vertex, and one more: where its corners begin.
    starts: Vec<u32>,
    corners: Vec<Corner>,
}

impl Fans {
    fn new(vertices: usize, corners: &[u32]) -> Self {
        let mut starts = vec![0; vertices + 1];
        for &vertex in corners {
            starts[vertex as usize] += 1;
        }
        let mut sum = 0;
        for start in &mut starts {
            sum += *start;
            *start = sum;
        }
        // Each start is the end of its fan, until the fan is full.
        let mut sorted = vec![NONE; corners.len()];
        for (corner, &vertex) in corners.iter().enumerate().rev() {
            let start = &mut starts[vertex as usize];
            *start -= 1;
            sorted[*start as usize] = corner as Corner;
        }
        Self {
            starts,
            corners: sorted,
        }
    }

    fn at(&self, vertex: u32) -> &[Corner] {
        let vertex = vertex as usize;
        &self.corners[self.starts[vertex] as usize..self.starts[vertex + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::scene::mesh::knot;

    /// Every triangle is there once, and the triangles of a pair share an edge in the way that is promised.
    fn check(pairing: &Pairing, triangles: &[[u32; 3]]) {
        let vertex = |corner: Corner| triangles.as_flattened()[corner as usize];
        let paired = pairing.pairs.iter().flatten();
        let mut all: Vec<usize> = pairing
            .alone
            .iter()
            .chain(paired)
            .map(|&c| triangle_of(c))
            .collect();
        all.sort_unstable();
        assert!(all.into_iter().eq(0..triangles.len()));
        assert!(pairing.alone.iter().all(|corner| corner.is_multiple_of(3)));
        for &[first, second] in &pairing.pairs {
            assert_eq!(vertex(next(first)), vertex(previous(second)));
            assert_eq!(vertex(previous(first)), vertex(next(second)));
        }
    }

    #[test]
    fn a_square_is_a_pair_along_its_diagonal() {
        let positions = [[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        let triangles = [[0, 1, 2], [2, 3, 0]];
        let pairing = Pairing::new(&positions, &triangles);
        check(&pairing, &triangles);
        assert_eq!(pairing.pairs, [[1, 4]]);
        // Neighbours that look to different sides stay alone.
        let turned = [[0, 1, 2], [2, 0, 3]];
        let pairing = Pairing::new(&positions, &turned);
        check(&pairing, &turned);
        assert_eq!(pairing.alone, [0, 3]);
    }

    #[test]
    fn hardly_a_triangle_of_a_closed_surface_stays_alone() {
        let mesh = knot::knot(20_000);
        let pairing = Pairing::new(&mesh.positions, &mesh.triangles);
        check(&pairing, &mesh.triangles);
        let alone = pairing.alone.len();
        assert!(alone * 50 < mesh.triangles.len(), "{alone} stay alone");
    }

    #[test]
    fn a_fan_of_many_triangles_is_paired_in_little_time() {
        let rim = 200_000;
        let positions: Vec<[f32; 3]> = (0..=rim)
            .map(|i| [(i as f32).sin(), i as f32, 0.0])
            .collect();
        let triangles: Vec<[u32; 3]> = (1..rim).map(|i| [0, i, i + 1]).collect();
        let pairing = Pairing::new(&positions, &triangles);
        check(&pairing, &triangles);
        assert!(pairing.alone.len() <= 2);
    }

    proptest! {
        /// Edges of three triangles and more, triangles twice, and triangles without area.
        #[test]
        fn any_triangles_can_be_paired(triangles in prop::collection::vec(prop::array::uniform3(0u32..8), 1..60)) {
            let positions: Vec<[f32; 3]> = (0..8).map(|i| [(i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32]).collect();
            check(&Pairing::new(&positions, &triangles), &triangles);
        }
    }
}
