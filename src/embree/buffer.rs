//! Vertices that Embree reads where they are, without a copy.
//!
//! They cannot be changed any more, so they can be shared (by `Arc`) between scenes and with whoever shades the hits.

/// The vertices of a mesh, each in so many bytes as it needs: shading a hit fetches three of them from anywhere, and what lies
/// close together is found in the cache more often.
#[derive(Clone, Debug)]
pub enum VertexBuffer {
    /// Those of a mesh that is shaded flat.
    Flat(Vec<FlatVertex>),
    /// Those of a mesh with vertex normals.
    Smooth(Vec<SmoothVertex>),
}

/// A vertex that is no more than a point.
#[repr(C, align(16))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlatVertex {
    /// Position in world space.
    pub position: [f32; 3],
    /// Embree reads the position with an instruction for four numbers.
    padding: f32,
}

/// A vertex with a normal, in half a cache line.
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SmoothVertex {
    /// Position in world space.
    pub position: [f32; 3],
    /// As in [`FlatVertex`].
    padding: f32,
    /// Unit normal in world space.
    pub normal: [f32; 3],
}

impl VertexBuffer {
    /// Vertices without normals.
    pub fn new(positions: impl IntoIterator<Item = [f32; 3]>) -> Self {
        let vertices = positions.into_iter().map(|position| FlatVertex {
            position,
            padding: 0.0,
        });
        Self::Flat(vertices.collect())
    }

    /// Positions and unit normals.
    pub fn with_normals(vertices: impl IntoIterator<Item = ([f32; 3], [f32; 3])>) -> Self {
        let vertices = vertices.into_iter().map(|(position, normal)| SmoothVertex {
            position,
            padding: 0.0,
            normal,
        });
        Self::Smooth(vertices.collect())
    }

    /// The number of vertices.
    pub fn len(&self) -> usize {
        match self {
            Self::Flat(vertices) => vertices.len(),
            Self::Smooth(vertices) => vertices.len(),
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The position of a vertex, in world space.
    ///
    /// # Panics
    /// When `index` is not below [`len`](Self::len).
    #[inline]
    pub fn position(&self, index: u32) -> [f32; 3] {
        match self {
            Self::Flat(vertices) => vertices[index as usize].position,
            Self::Smooth(vertices) => vertices[index as usize].position,
        }
    }

    /// The positions of all vertices, in world space.
    pub fn positions(&self) -> impl Iterator<Item = [f32; 3]> {
        (0..self.len() as u32).map(|index| self.position(index))
    }

    /// Says that vertex `index` will be wanted soon, so that the processor need not wait for it then. Any index may be given.
    #[inline(always)]
    pub fn prefetch(&self, index: u32) {
        match self {
            Self::Flat(vertices) => prefetch(vertices, index),
            Self::Smooth(vertices) => prefetch(vertices, index),
        }
    }

    /// Where the positions begin, and how many bytes lie from one to the next.
    pub(super) fn layout(&self) -> VertexLayout {
        match self {
            Self::Flat(vertices) => VertexLayout {
                start: vertices.as_ptr().cast(),
                stride: size_of::<FlatVertex>(),
            },
            Self::Smooth(vertices) => VertexLayout {
                start: vertices.as_ptr().cast(),
                stride: size_of::<SmoothVertex>(),
            },
        }
    }
}

/// Where Embree finds the positions of a [`VertexBuffer`].
pub(super) struct VertexLayout {
    pub start: *const f32,
    /// In bytes.
    pub stride: usize,
}

/// Says that entry `index` of `list` will be wanted soon, so that the processor need not wait for it then. Any index may be given.
#[inline(always)]
pub(crate) fn prefetch<T>(list: &[T], index: u32) {
    let place = list.as_ptr().wrapping_add(index as usize);
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
    fn sixteen_bytes_are_readable_at_every_position() {
        let flat = VertexBuffer::new([[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
        let smooth = VertexBuffer::with_normals(
            [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]].map(|position| (position, [0.0, 0.0, 1.0])),
        );
        for (buffer, bytes) in [(flat, 16), (smooth, 32)] {
            assert_eq!(buffer.positions().last(), Some([4.0, 5.0, 6.0]));
            let layout = buffer.layout();
            assert_eq!(layout.stride, bytes);
            // No vertex lies across the border of two cache lines.
            assert_eq!(layout.start as usize % bytes, 0);
        }
    }
}
