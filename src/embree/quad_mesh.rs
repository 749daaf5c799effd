//! Meshes of triangles in pairs, checked when they are made.
//!
//! Two triangles that share an edge are one quad to Embree: one leaf less in its tree, half the memory, and rays are up to a
//! quarter faster than through single triangles (`docs/performance.md`, "Triangles in pairs").

use std::sync::Arc;

use super::buffer::{VertexBuffer, VertexLayout};
use super::device::Device;
use super::error::EmbreeError;
use super::geometry::{GeometryHandle, is_valid};
use super::raw;

/// Quads in world space, whose indices are in range and whose vertices are finite.
///
/// A quad (a, b, c, d) is two triangles, (a, b, d) and (c, d, b), which need not lie in a plane. One whose c is its d is the
/// triangle (a, b, d) alone. A hit of the first has its barycentric coordinates, u of b and v of d; a hit of the second has 1 - u and 1 - v
/// of its own, u of d and v of b; [`Half::of`] tells one from the other. The geometric normal is that of the triangle, not normalised:
/// (b - a) × (d - a) or (d - c) × (b - c).
#[derive(Clone, Debug)]
pub struct QuadMesh {
    vertices: Arc<VertexBuffer>,
    quads: Arc<Vec<[u32; 4]>>,
}

/// One of the two triangles of a quad, and where it was hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Half {
    /// Whether it is (c, d, b), not (a, b, d).
    pub is_second: bool,
    /// Barycentric coordinate of its second vertex.
    pub u: f32,
    /// Of its third.
    pub v: f32,
}

impl Half {
    /// The triangle of a quad that was hit at these coordinates of the quad. On the edge between the two it may be either.
    #[inline(always)]
    pub fn of(u: f32, v: f32) -> Self {
        let is_second = u + v > 1.0;
        Self {
            is_second,
            u: if is_second { 1.0 - u } else { u },
            v: if is_second { 1.0 - v } else { v },
        }
    }
}

impl QuadMesh {
    /// Checks and shares the two buffers.
    ///
    /// # Errors
    /// [`EmbreeError::EmptyMesh`], [`EmbreeError::TooManyPrimitives`], [`EmbreeError::BadVertex`] or
    /// [`EmbreeError::IndexOutOfRange`], naming the first offender.
    pub fn new(
        vertices: Arc<VertexBuffer>,
        quads: Arc<Vec<[u32; 4]>>,
    ) -> Result<Self, EmbreeError> {
        if quads.is_empty() {
            return Err(EmbreeError::EmptyMesh);
        }
        if quads.len() >= u32::MAX as usize {
            return Err(EmbreeError::TooManyPrimitives { count: quads.len() });
        }
        for (vertex, position) in vertices.positions().enumerate() {
            if !is_valid(position) {
                return Err(EmbreeError::BadVertex { vertex, position });
            }
        }
        let count = vertices.len();
        for (quad, corners) in quads.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&index| index as usize >= count) {
                return Err(EmbreeError::IndexOutOfRange {
                    quad,
                    index,
                    vertices: count,
                });
            }
        }
        Ok(Self { vertices, quads })
    }

    /// Makes Embree's object of the mesh. It reads the buffers in place, so `self` or a clone of it
    /// must outlive the object and every scene that it is attached to.
    pub(super) fn to_embree(&self, device: &Device) -> Result<GeometryHandle, EmbreeError> {
        let geometry = GeometryHandle::new(device, raw::RTCGeometryType::QUAD)?;
        let VertexLayout { start, stride } = self.vertices.layout();
        // SAFETY: the geometry is alive; the buffers hold as many triples and quadruples of the stated format, at the
        // stated distances, as stated; they never change, 16 bytes are readable at each as
        // Embree asks, and they outlive the geometry (see above); every index was checked.
        unsafe {
            raw::rtcSetSharedGeometryBuffer(
                geometry.raw(),
                raw::RTCBufferType::VERTEX,
                0,
                raw::RTCFormat::FLOAT3,
                start.cast(),
                0,
                stride as _,
                self.vertices.len() as _,
            );
            raw::rtcSetSharedGeometryBuffer(
                geometry.raw(),
                raw::RTCBufferType::INDEX,
                0,
                raw::RTCFormat::UINT4,
                self.quads.as_ptr().cast(),
                0,
                size_of::<[u32; 4]>() as _,
                self.quads.len() as _,
            );
            raw::rtcCommitGeometry(geometry.raw());
        }
        device.check("take a mesh")?;
        Ok(geometry)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(vertices: Vec<[f32; 3]>, quads: Vec<[u32; 4]>) -> Result<QuadMesh, EmbreeError> {
        QuadMesh::new(Arc::new(VertexBuffer::new(vertices)), Arc::new(quads))
    }

    #[test]
    fn bad_meshes_are_errors_that_name_the_offender() {
        let corners = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert!(mesh(corners.clone(), vec![[0, 1, 2, 2]]).is_ok());
        assert_eq!(
            mesh(corners.clone(), vec![]).unwrap_err(),
            EmbreeError::EmptyMesh
        );
        assert_eq!(
            mesh(corners.clone(), vec![[0, 1, 2, 2], [0, 1, 2, 3]]).unwrap_err(),
            EmbreeError::IndexOutOfRange {
                quad: 1,
                index: 3,
                vertices: 3
            }
        );
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 2.0e18] {
            let mut vertices = corners.clone();
            vertices[2][1] = bad;
            let error = mesh(vertices, vec![[0, 1, 2, 2]]).unwrap_err();
            assert!(
                matches!(error, EmbreeError::BadVertex { vertex: 2, .. }),
                "{error}"
            );
        }
    }
}
