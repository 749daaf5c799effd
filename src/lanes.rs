//! Numbers of many particles side by side: arithmetic over them is one loop, which compilers turn into vector
//! instructions.

use std::ops::Range;

use glam::Vec3;

use crate::room::make_room;

/// Particles that a stage takes together: all of their numbers fit the first-level cache.
pub(crate) const CHUNK: usize = 64;

/// `N` vectors: all x, all y, all z.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct VectorLanes<const N: usize>(pub [[f32; N]; 3]);

impl<const N: usize> Default for VectorLanes<N> {
    fn default() -> Self {
        Self([[0.0; N]; 3])
    }
}

impl<const N: usize> VectorLanes<N> {
    /// The vector in a lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Vec3 {
        let [x, y, z] = &self.0;
        Vec3::new(x[lane], y[lane], z[lane])
    }

    /// Puts a vector into its lane.
    #[inline(always)]
    pub fn put(&mut self, lane: usize, vector: Vec3) {
        let [x, y, z] = &mut self.0;
        x[lane] = vector.x;
        y[lane] = vector.y;
        z[lane] = vector.z;
    }

    /// The first vectors are those of three equally long slices, at most `N`; the other lanes stay what they were.
    #[inline(always)]
    pub fn load(&mut self, slices: [&[f32]; 3]) {
        for (lanes, slice) in self.0.iter_mut().zip(slices) {
            load(lanes, slice);
        }
    }
}

/// The first lanes are those of `slice`, at most `N`; the others stay what they were.
#[inline(always)]
pub(crate) fn load<const N: usize>(lanes: &mut [f32; N], slice: &[f32]) {
    // Of a full chunk the length is known, and nobody need be called to copy it.
    match <&[f32; N]>::try_from(slice) {
        Ok(full) => *lanes = *full,
        Err(_) => lanes[..slice.len()].copy_from_slice(slice),
    }
}

/// A growing list of vectors: all x, all y, all z.
#[derive(Clone, Debug, Default)]
pub(crate) struct VectorColumn([Vec<f32>; 3]);

impl VectorColumn {
    /// Empties the list and makes room for `count` vectors.
    pub fn restart(&mut self, count: usize) {
        self.0.iter_mut().for_each(|axis| make_room(axis, count));
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.0[0].is_empty()
    }

    /// The vector at `index`.
    #[inline(always)]
    pub fn get(&self, index: usize) -> Vec3 {
        let [x, y, z] = &self.0;
        Vec3::new(x[index], y[index], z[index])
    }

    /// Appends the lanes that `kept` names.
    #[inline(always)]
    pub fn append(&mut self, lanes: &VectorLanes<CHUNK>, kept: &KeptLanes) {
        for (axis, lanes) in self.0.iter_mut().zip(&lanes.0) {
            append_kept(axis, lanes, kept);
        }
    }

    /// The vectors of `range`, each component in a slice.
    #[inline(always)]
    pub fn slices(&self, range: Range<usize>) -> [&[f32]; 3] {
        self.0.each_ref().map(|axis| &axis[range.clone()])
    }
}

/// Which lanes of a chunk go on.
pub(crate) struct KeptLanes {
    lanes: [u8; CHUNK],
    count: usize,
}

impl KeptLanes {
    /// None so far.
    #[inline(always)]
    pub fn none() -> Self {
        Self {
            lanes: [0; CHUNK],
            count: 0,
        }
    }

    /// Adds `lane`, which is greater than all before, if `keep` says so: without a jump, for nobody can foresee it.
    #[inline(always)]
    pub fn add_if(&mut self, lane: usize, keep: bool) {
        self.lanes[self.count % CHUNK] = lane as u8;
        self.count += usize::from(keep);
    }

    /// How many there are.
    #[inline(always)]
    pub fn len(&self) -> usize {
        self.count
    }

    /// The lanes in increasing order.
    #[inline(always)]
    pub fn iter(&self) -> impl ExactSizeIterator<Item = usize> + Clone {
        // The remainder says to the compiler what is true anyway: a lane is one of the chunk.
        self.lanes[..self.count]
            .iter()
            .map(|&lane| usize::from(lane) % CHUNK)
    }
}

/// Appends the numbers in the lanes that `kept` names to `column`; `lanes` are those of one chunk.
#[inline(always)]
pub(crate) fn append_kept<T: Copy>(column: &mut Vec<T>, lanes: &[T], kept: &KeptLanes) {
    match <&[T; CHUNK]>::try_from(lanes) {
        Ok(lanes) if kept.len() == CHUNK => column.extend_from_slice(lanes),
        // Though not all are kept, the compiler knows here that no lane is outside.
        Ok(lanes) => column.extend(kept.iter().map(|lane| lanes[lane])),
        Err(_) => column.extend(kept.iter().map(|lane| lanes[lane])),
    }
}

/// Copies the lanes that `kept` names into `column`, which is as long.
#[inline(always)]
pub(crate) fn copy_kept(column: &mut [f32], lanes: &[f32; CHUNK], kept: &KeptLanes) {
    if let Ok(all) = <&mut [f32; CHUNK]>::try_from(&mut *column) {
        *all = *lanes;
        return;
    }
    for (place, lane) in column.iter_mut().zip(kept.iter()) {
        *place = lanes[lane];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kept_lanes_are_appended_in_order() {
        let mut lanes = VectorLanes::<CHUNK>::default();
        let mut kept = KeptLanes::none();
        for lane in 0..CHUNK {
            lanes.put(lane, Vec3::new(lane as f32, 1.0, -(lane as f32)));
            kept.add_if(lane, lane % 3 == 0);
        }
        let mut column = VectorColumn::default();
        column.restart(2 * CHUNK);
        column.append(&lanes, &kept);
        column.append(&lanes, &kept);
        assert_eq!(kept.len(), 22);
        assert_eq!(column.get(1), Vec3::new(3.0, 1.0, -3.0));
        assert_eq!(column.get(22 + 21), Vec3::new(63.0, 1.0, -63.0));
        let mut loaded = VectorLanes::<CHUNK>::default();
        loaded.load(column.slices(20..24));
        assert_eq!(loaded.get(1), Vec3::new(63.0, 1.0, -63.0));
        assert_eq!(loaded.get(2), Vec3::new(0.0, 1.0, 0.0));
    }

    #[test]
    fn all_lanes_can_be_kept() {
        let mut kept = KeptLanes::none();
        (0..CHUNK).for_each(|lane| kept.add_if(lane, true));
        assert!(kept.iter().eq(0..CHUNK));
    }
}
