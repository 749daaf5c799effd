//! Buffers that Embree reads where they are, without a copy.
//!
//! They cannot be changed any more, so they can be shared (by `Arc`) between scenes and with whoever shades the hits.

use std::ops::Deref;

/// The three vertices of each triangle.
///
/// Embree loads the last triple with an instruction that reads 16 bytes, 4 more than the triple has;
/// a triple of zeros behind the last one makes those bytes readable. It does not count: the buffer
/// dereferences to the triples it was made from.
#[derive(Clone, Debug)]
pub struct IndexBuffer {
    /// The triples and one more.
    padded: Vec<[u32; 3]>,
}

/// What is known of a vertex, in half a cache line: shading a hit fetches three of them, and nothing else.
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vertex {
    /// Position in world space.
    pub position: [f32; 3],
    /// Embree reads the position with an instruction for four numbers.
    padding: f32,
    /// Unit normal in world space; zero in a mesh without vertex normals.
    pub normal: [f32; 3],
}

/// The vertices of a mesh; Embree looks at their positions.
#[derive(Clone, Debug)]
pub struct VertexBuffer {
    vertices: Vec<Vertex>,
}

impl IndexBuffer {
    /// Takes over the triples. They move once if the vector has no room for one more.
    pub fn new(mut triples: Vec<[u32; 3]>) -> Self {
        triples.push([0; 3]);
        Self { padded: triples }
    }

    /// Says that triple `index` will be wanted soon, so that the processor need not wait for it then. Any index may be given.
    #[inline(always)]
    pub fn prefetch(&self, index: u32) {
        prefetch(self.padded.as_ptr().wrapping_add(index as usize));
    }
}

impl VertexBuffer {
    /// Vertices without normals.
    pub fn new(positions: impl IntoIterator<Item = [f32; 3]>) -> Self {
        Self::with_normals(positions.into_iter().map(|position| (position, [0.0; 3])))
    }

    /// Positions and unit normals.
    pub fn with_normals(vertices: impl IntoIterator<Item = ([f32; 3], [f32; 3])>) -> Self {
        let vertices = vertices.into_iter().map(|(position, normal)| Vertex {
            position,
            padding: 0.0,
            normal,
        });
        Self {
            vertices: vertices.collect(),
        }
    }

    /// Says that vertex `index` will be wanted soon, so that the processor need not wait for it then. Any index may be given.
    #[inline(always)]
    pub fn prefetch(&self, index: u32) {
        prefetch(self.vertices.as_ptr().wrapping_add(index as usize));
    }
}

impl Deref for IndexBuffer {
    type Target = [[u32; 3]];

    fn deref(&self) -> &[[u32; 3]] {
        &self.padded[..self.padded.len() - 1]
    }
}

impl Deref for VertexBuffer {
    type Target = [Vertex];

    fn deref(&self) -> &[Vertex] {
        &self.vertices
    }
}

#[inline(always)]
fn prefetch<T>(place: *const T) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: this is a hint; it reads nothing, and no address is wrong.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(place.cast()) }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = place;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sixteen_bytes_are_readable_at_the_last_triple() {
        for length in [0, 1, 2, 1000] {
            let buffer = IndexBuffer::new(vec![[1; 3]; length]);
            assert_eq!(buffer.len(), length);
            assert!(buffer.iter().all(|triple| *triple == [1; 3]));
            let bytes = size_of_val(buffer.padded.as_slice());
            let last = length.saturating_sub(1) * size_of::<[u32; 3]>();
            assert!(length == 0 || bytes >= last + 16);
        }
    }

    #[test]
    fn a_vertex_is_half_a_cache_line_and_16_bytes_are_readable_at_its_position() {
        assert_eq!(size_of::<Vertex>(), 32);
        let buffer = VertexBuffer::with_normals([([1.0, 2.0, 3.0], [0.0, 0.0, 1.0])]);
        assert_eq!(buffer.as_ptr() as usize % 32, 0);
        let start = (&raw const buffer[0]) as usize;
        assert_eq!((&raw const buffer[0].position) as usize, start);
        assert_eq!((&raw const buffer[0].normal) as usize, start + 16);
    }
}
