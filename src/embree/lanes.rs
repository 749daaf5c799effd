//! One component of a structure of arrays.

use std::ops::{Deref, DerefMut};

/// The widest packet: arrays are padded to a multiple of it.
pub(super) const WIDTH: usize = 16;

/// A growing array of 4-byte numbers, aligned to 64 bytes and padded to a multiple of 16 numbers.
///
/// It never gives memory back, so that one that is used again and again stops allocating.
#[derive(Clone, Debug)]
pub(super) struct Lanes<T> {
    blocks: Vec<Block<T>>,
    len: usize,
}

/// A cache line.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
struct Block<T>([T; WIDTH]);

impl<T: Copy + Default> Lanes<T> {
    /// Changes the length. Numbers that come into sight are whatever was there before, or 0.
    pub(super) fn resize(&mut self, len: usize) {
        let needed = len.div_ceil(WIDTH);
        if needed > self.blocks.len() {
            // Batches differ a little in size: the first makes room for those that follow.
            let room = (needed + needed / 4).next_power_of_two();
            self.blocks.resize(room, Block([T::default(); WIDTH]));
        }
        self.len = len;
    }

    /// Becomes `source` in another order, number `order[i]` in place i; or nothing, if `source` is.
    pub(super) fn gather(&mut self, source: &Self, order: &[u32]) {
        self.resize(order.len().min(source.len));
        for (place, &i) in self.iter_mut().zip(order) {
            *place = source[i as usize];
        }
    }

    /// The numbers in chunks of `K`, 4, 8 or 16, the padding included.
    #[cfg(embree4)]
    pub(super) fn chunks<const K: usize>(&self) -> &[[T; K]] {
        const { assert!(WIDTH.is_multiple_of(K)) }
        let padded = self.len.div_ceil(WIDTH) * WIDTH;
        self.all()[..padded].as_chunks().0
    }

    /// The numbers in chunks of `K`, 4, 8 or 16, the padding included.
    #[cfg(embree4)]
    pub(super) fn chunks_mut<const K: usize>(&mut self) -> &mut [[T; K]] {
        const { assert!(WIDTH.is_multiple_of(K)) }
        let padded = self.len.div_ceil(WIDTH) * WIDTH;
        self.all_mut()[..padded].as_chunks_mut().0
    }
}

impl<T> Lanes<T> {
    /// A block is 16 numbers without a gap before, between or behind them.
    const DENSE: () = assert!(size_of::<Block<T>>() == WIDTH * size_of::<T>());

    /// Puts a number in its place.
    ///
    /// # Safety
    /// `i` must be below the length.
    #[inline]
    pub(super) unsafe fn set_unchecked(&mut self, i: usize, value: T) {
        const { Self::DENSE }
        // SAFETY: the blocks are dense numbers in a row, at least as many as the length.
        unsafe { self.blocks.as_mut_ptr().cast::<T>().add(i).write(value) }
    }

    fn all(&self) -> &[T] {
        const { Self::DENSE }
        // SAFETY: the blocks are that many dense numbers in a row.
        unsafe {
            std::slice::from_raw_parts(self.blocks.as_ptr().cast(), self.blocks.len() * WIDTH)
        }
    }

    fn all_mut(&mut self) -> &mut [T] {
        const { Self::DENSE }
        let count = self.blocks.len() * WIDTH;
        // SAFETY: the blocks are that many dense numbers in a row, borrowed mutably.
        unsafe { std::slice::from_raw_parts_mut(self.blocks.as_mut_ptr().cast(), count) }
    }
}

impl<T> Default for Lanes<T> {
    fn default() -> Self {
        Self {
            blocks: Vec::new(),
            len: 0,
        }
    }
}

impl<T> Deref for Lanes<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.all()[..self.len]
    }
}

impl<T> DerefMut for Lanes<T> {
    fn deref_mut(&mut self) -> &mut [T] {
        let len = self.len;
        &mut self.all_mut()[..len]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_aligned_padded_and_keeps_its_memory() {
        let mut lanes = Lanes::<f32>::default();
        for len in [0, 1, 15, 16, 17, 1000] {
            lanes.resize(len);
            assert_eq!(lanes.len(), len);
            assert!(lanes.blocks.len() * WIDTH >= len);
            assert_eq!(lanes.as_ptr() as usize % 64, 0);
        }
        lanes[999] = 1.0;
        let before = lanes.as_ptr();
        lanes.resize(3);
        lanes.resize(1000);
        assert_eq!((lanes.as_ptr(), lanes[999]), (before, 1.0));
    }
}
