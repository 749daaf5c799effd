//! Space, divided into cells where there is something to tell apart.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::lanes::{CHUNK, VectorLanes};

/// Halvings along each axis that a cell may have at the most.
const FINEST: u32 = 21;

/// Halvings along each axis that the table of first nodes takes at once.
const TABLE_BITS: u32 = 5;

/// What marks cells in the table.
const LEAF: u32 = 1 << 31;

/// A binary tree over a cube. A node is halved along x, y and z in turn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CellTree {
    corner: [f32; 3],
    /// How many of the finest cells there are along a unit of length.
    scale: f32,
    nodes: Vec<Node>,
    cells: u32,
    /// For every cell of the grid with 2^[`TABLE_BITS`] cells along each axis, the node that contains it and is not smaller: the number of its cell, from
    /// [`LEAF`] on, or its own if it is an inner node.
    table: Vec<u32>,
}

/// An inner node, or a leaf: a cell.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Node {
    /// The first of its two halves; 0 for a leaf, for the root is no half.
    halves: u32,
    /// The number of the cell, of a leaf.
    cell: u32,
    /// How often the cube was halved to get here.
    depth: u8,
}

impl CellTree {
    /// The cube about the box from `least` to `most` (world space), each axis halved `halvings` times.
    pub fn new([least, most]: [Vec3; 2], halvings: u32) -> Self {
        let extent = (most - least).max_element();
        // An empty scene, or one that is a point, has some cube as well.
        let side = if extent > 0.0 && extent < f32::INFINITY {
            extent
        } else {
            1.0
        };
        let root = Node {
            halves: 0,
            cell: 0,
            depth: 0,
        };
        let corner = 0.5 * (least + most) - 0.5 * side;
        let mut tree = Self {
            corner: if corner.is_finite() {
                corner.to_array()
            } else {
                [0.0; 3]
            },
            scale: (1 << FINEST) as f32 / side,
            nodes: vec![root],
            cells: 1,
            table: Vec::new(),
        };
        for _ in 0..3 * halvings {
            tree.halve(|_| true, |_, _| ());
        }
        tree.tabulate();
        tree
    }

    /// How many cells there are.
    pub fn cells(&self) -> u32 {
        self.cells
    }

    /// The numbers of the cells at the first `count` of `positions` (world space); outside of the cube, of the nearest ones.
    ///
    /// Cells lie scattered in memory. So the arithmetic is one loop over lanes, and what the table says is fetched for all of them before
    /// it is looked at: nobody waits for the memory of one after the other.
    #[inline(always)]
    pub(super) fn cells_at(&self, positions: &VectorLanes<CHUNK>, count: usize) -> [u32; CHUNK] {
        let mut finest = [[0; CHUNK]; 3];
        let mut entries = [0; CHUNK];
        for lane in 0..CHUNK {
            let place = self.finest(positions.get(lane));
            entries[lane] = table_entry(place);
            for (axis, place) in finest.iter_mut().zip(place) {
                axis[lane] = place;
            }
        }
        let mut cells = entries.map(|entry| self.table[entry as usize]);
        for (lane, cell) in cells[..count].iter_mut().enumerate() {
            *cell = self.follow(*cell, finest.map(|axis| axis[lane]));
        }
        cells
    }

    /// Which of the finest cells along each axis `position` lies in; outside of the cube, the nearest.
    #[inline(always)]
    fn finest(&self, position: Vec3) -> [u32; 3] {
        const LAST: f32 = ((1 << FINEST) - 1) as f32;
        const INTEGERS: f32 = (1 << 23) as f32;
        let place = (position - Vec3::from(self.corner)) * self.scale;
        place.to_array().map(|place| {
            // Conversions to integers by `as` do not vectorise; adding 2^23 leaves the nearest integer in the last bits. What is no number
            // becomes 0.
            let place = place - 0.5;
            let place = if place > 0.0 { place } else { 0.0 };
            let place = if place < LAST { place } else { LAST };
            (place + INTEGERS).to_bits() - INTEGERS.to_bits()
        })
    }

    /// The cell to which `entry` of the table leads, at a place among the finest cells.
    #[inline(always)]
    fn follow(&self, entry: u32, finest: [u32; 3]) -> u32 {
        if entry >= LEAF {
            return entry - LEAF;
        }
        let mut node = self.nodes[entry as usize];
        while node.halves > 0 {
            let depth = u32::from(node.depth);
            let along = finest[(depth % 3) as usize];
            let half = along >> (FINEST - 1 - depth / 3) & 1;
            node = self.nodes[(node.halves + half) as usize];
        }
        node.cell
    }

    /// Halves every cell of which `divide` says so, once. The first half keeps the cell's number; `halved` is told each cell with the new
    /// number of its second half.
    fn halve(&mut self, divide: impl Fn(u32) -> bool, mut halved: impl FnMut(u32, u32)) {
        for index in 0..self.nodes.len() {
            let Node {
                halves,
                cell,
                depth,
            } = self.nodes[index];
            if halves > 0 || u32::from(depth) >= 3 * FINEST || !divide(cell) {
                continue;
            }
            self.nodes[index].halves = self.nodes.len() as u32;
            for cell in [cell, self.cells] {
                self.nodes.push(Node {
                    halves: 0,
                    cell,
                    depth: depth + 1,
                });
            }
            halved(cell, self.cells);
            self.cells += 1;
        }
    }

    /// Halves cells, again and again, as long as `count` says that more than `most` is in them; or more than twice, four times … as much, where there would
    /// be more than `limit` cells. A half is taken to have half of what was in the whole; `halved` is told each cell with the new number of its
    /// second half.
    pub fn refine(
        &mut self,
        count: &mut Vec<f64>,
        mut most: f64,
        limit: u32,
        mut halved: impl FnMut(u32, u32),
    ) {
        loop {
            let before = self.cells;
            let too_many: Vec<bool> = count.iter().map(|&count| count > most).collect();
            let wanted = too_many.iter().filter(|&&too_many| too_many).count();
            if wanted == 0 {
                break;
            }
            if u64::from(before) + wanted as u64 > u64::from(limit) {
                most *= 2.0;
                continue;
            }
            self.halve(
                |cell| too_many[cell as usize],
                |cell, second| {
                    count[cell as usize] *= 0.5;
                    count.push(count[cell as usize]);
                    halved(cell, second);
                },
            );
            if self.cells == before {
                break;
            }
        }
        self.tabulate();
    }

    /// For every cell, a number that those share which come from the same node `halvings` halvings above (or from the root); these
    /// numbers are below [`Self::nodes`].
    pub fn families(&self, halvings: u8) -> Vec<u32> {
        let mut families = vec![0; self.cells as usize];
        // Nodes stand before their halves.
        let mut parents = vec![0_u32; self.nodes.len()];
        for (index, node) in self.nodes.iter().enumerate() {
            if node.halves > 0 {
                parents[node.halves as usize] = index as u32;
                parents[node.halves as usize + 1] = index as u32;
            } else {
                let up = |index: u32, _| parents[index as usize];
                families[node.cell as usize] = (0..halvings).fold(index as u32, up);
            }
        }
        families
    }

    /// The number of nodes.
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    fn tabulate(&mut self) {
        let side = 1_u32 << TABLE_BITS;
        let mut table = Vec::with_capacity(1 << (3 * TABLE_BITS));
        for (x, y, z) in
            (0..side).flat_map(|x| (0..side).flat_map(move |y| (0..side).map(move |z| (x, y, z))))
        {
            let mut index = 0;
            let mut node = self.nodes[0];
            while node.halves > 0 && u32::from(node.depth) < 3 * TABLE_BITS {
                let depth = u32::from(node.depth);
                let along = [x, y, z][(depth % 3) as usize];
                index = node.halves + (along >> (TABLE_BITS - 1 - depth / 3) & 1);
                node = self.nodes[index as usize];
            }
            table.push(if node.halves > 0 {
                index
            } else {
                LEAF + node.cell
            });
        }
        self.table = table;
    }
}

/// The entry of the table at a place among the finest cells.
#[inline(always)]
fn table_entry(finest: [u32; 3]) -> u32 {
    let [x, y, z] = finest.map(|place| place >> (FINEST - TABLE_BITS));
    (x << TABLE_BITS | y) << TABLE_BITS | z
}

#[cfg(test)]
mod tests {
    use super::*;

    impl CellTree {
        /// The number of the cell at `position`.
        pub fn cell(&self, position: Vec3) -> u32 {
            let mut positions = VectorLanes::default();
            positions.put(0, position);
            self.cells_at(&positions, 1)[0]
        }
    }

    fn unit(halvings: u32) -> CellTree {
        CellTree::new([Vec3::ZERO, Vec3::ONE], halvings)
    }

    #[test]
    fn cells_are_a_grid_at_first() {
        let tree = unit(3);
        assert_eq!(tree.cells(), 512);
        let centre = |k: u32| (k as f32 + 0.5) / 8.0;
        let mut seen = std::collections::BTreeSet::new();
        for (x, y, z) in
            (0..8).flat_map(|x| (0..8).flat_map(move |y| (0..8).map(move |z| (x, y, z))))
        {
            let position = Vec3::new(centre(x), centre(y), centre(z));
            let cell = tree.cell(position);
            assert_eq!(tree.cell(position + 0.06), cell);
            seen.insert(cell);
        }
        assert_eq!(seen.len(), 512);
    }

    /// Many observations in one corner: cells there become small, others stay as they were.
    #[test]
    fn cells_are_halved_where_much_is_in_them() {
        let mut tree = unit(1);
        let corner = tree.cell(Vec3::splat(0.01));
        let other = tree.cell(Vec3::splat(0.9));
        let mut counts = vec![1.0; 8];
        counts[corner as usize] = 1000.0;
        let mut born = Vec::new();
        tree.refine(&mut counts, 10.0, 1000, |cell, second| {
            born.push((cell, second))
        });
        // 1000 halved seven times is below 10.
        assert_eq!(tree.cells(), 7 + 128);
        assert_eq!(born.len(), 127);
        assert_eq!(tree.cell(Vec3::splat(0.9)), other);
        assert_ne!(tree.cell(Vec3::splat(0.01)), tree.cell(Vec3::splat(0.4)));
        let families = tree.families(7);
        assert_eq!(
            families[tree.cell(Vec3::splat(0.01)) as usize],
            families[tree.cell(Vec3::splat(0.4)) as usize]
        );
        assert!(
            families
                .iter()
                .all(|&family| (family as usize) < tree.nodes())
        );
    }

    #[test]
    fn there_are_never_more_cells_than_allowed() {
        let mut tree = unit(0);
        tree.refine(&mut vec![1e30], 1.0, 300, |_, _| ());
        assert_eq!(tree.cells(), 256);
        // Where not all can be halved, the fullest are.
        let mut grid = unit(1);
        let mut counts = vec![10.0; 8];
        counts[5] = 1000.0;
        grid.refine(&mut counts, 1.0, 12, |_, _| ());
        assert_eq!(grid.cells(), 11);
        assert_eq!(counts[5], 250.0);
        // Nor smaller ones than coordinates can tell apart.
        let mut deep = unit(0);
        let mut counts = vec![1e30];
        for _ in 0..100 {
            let first = deep.cell(Vec3::ZERO) as usize;
            counts
                .iter_mut()
                .enumerate()
                .for_each(|(i, c)| *c = if i == first { 2.0 } else { 0.0 });
            deep.refine(&mut counts, 1.0, u32::MAX, |_, _| ());
        }
        assert_eq!(deep.cells(), 3 * FINEST + 1);
    }

    #[test]
    fn every_position_has_a_cell() {
        for bounds in [
            [Vec3::ZERO, Vec3::ONE],
            [Vec3::ZERO, Vec3::ZERO],
            [Vec3::INFINITY, Vec3::NEG_INFINITY],
            [Vec3::splat(-1e18), Vec3::splat(1e18)],
        ] {
            let tree = CellTree::new(bounds, 2);
            for position in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY, Vec3::splat(-1e30)] {
                assert!(tree.cell(position) < tree.cells());
            }
        }
    }
}
