//! Buffers that Embree reads where they are, without a copy.

use std::ops::Deref;

/// Triples of numbers, with the padding that Embree asks for.
///
/// Embree loads the last triple with an instruction that reads 16 bytes, 4 more than the triple has;
/// a triple of zeros behind the last one makes those bytes readable. It does not count: the buffer
/// dereferences to the triples it was made from. It cannot be changed any more, so it can be shared
/// (by `Arc`) between scenes and with whoever shades the hits.
#[derive(Clone, Debug)]
pub struct PaddedBuffer<T> {
    /// The triples and one more.
    padded: Vec<[T; 3]>,
}

/// Vertex positions, or another vector of every vertex.
pub type VertexBuffer = PaddedBuffer<f32>;

/// The three vertices of each triangle.
pub type IndexBuffer = PaddedBuffer<u32>;

impl<T: Copy + Default> PaddedBuffer<T> {
    /// Takes over the triples. They move once if the vector has no room for one more.
    pub fn new(mut triples: Vec<[T; 3]>) -> Self {
        triples.push([T::default(); 3]);
        Self { padded: triples }
    }
}

impl<T> PaddedBuffer<T> {
    /// Says that triple `index` will be wanted soon, so that the processor need not wait for it then. Any index may be given.
    #[inline(always)]
    pub fn prefetch(&self, index: usize) {
        #[cfg(target_arch = "x86_64")]
        {
            use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
            // SAFETY: this is a hint; it reads nothing, and no address is wrong.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(self.padded.as_ptr().wrapping_add(index).cast()) }
        }
        #[cfg(not(target_arch = "x86_64"))]
        let _ = index;
    }
}

impl<T> Deref for PaddedBuffer<T> {
    type Target = [[T; 3]];

    fn deref(&self) -> &[[T; 3]] {
        &self.padded[..self.padded.len() - 1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixteen_bytes_are_readable_at_the_last_triple() {
        for length in [0, 1, 2, 1000] {
            let buffer = VertexBuffer::new(vec![[1.0; 3]; length]);
            assert_eq!(buffer.len(), length);
            assert!(buffer.iter().all(|triple| *triple == [1.0; 3]));
            let bytes = size_of_val(buffer.padded.as_slice());
            let last = length.saturating_sub(1) * size_of::<[f32; 3]>();
            assert!(length == 0 || bytes >= last + 16);
        }
    }
}
