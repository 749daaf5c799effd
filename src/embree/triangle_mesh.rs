//! Triangle meshes, checked when they are made.

use std::sync::Arc;

use super::buffer::{IndexBuffer, VertexBuffer, VertexLayout};
use super::device::Device;
use super::error::EmbreeError;
use super::geometry::{GeometryHandle, is_valid};
use super::raw;

/// A triangle mesh in world space, whose indices are in range and whose vertices are finite.
///
/// A hit on a triangle (a, b, c) has barycentric coordinates u of b and v of c, and the unnormalised
/// geometric normal (b - a) × (c - a).
#[derive(Clone, Debug)]
pub struct TriangleMesh {
    vertices: Arc<VertexBuffer>,
    triangles: Arc<IndexBuffer>,
}

impl TriangleMesh {
    /// Checks and shares the two buffers.
    ///
    /// # Errors
    /// [`EmbreeError::EmptyMesh`], [`EmbreeError::TooManyPrimitives`], [`EmbreeError::BadVertex`] or
    /// [`EmbreeError::IndexOutOfRange`], naming the first offender.
    pub fn new(
        vertices: Arc<VertexBuffer>,
        triangles: Arc<IndexBuffer>,
    ) -> Result<Self, EmbreeError> {
        if triangles.is_empty() {
            return Err(EmbreeError::EmptyMesh);
        }
        if triangles.len() >= u32::MAX as usize {
            return Err(EmbreeError::TooManyPrimitives {
                count: triangles.len(),
            });
        }
        for (vertex, position) in vertices.positions().enumerate() {
            if !is_valid(position) {
                return Err(EmbreeError::BadVertex { vertex, position });
            }
        }
        let count = vertices.len();
        for (triangle, corners) in triangles.iter().enumerate() {
            if let Some(&index) = corners.iter().find(|&&index| index as usize >= count) {
                return Err(EmbreeError::IndexOutOfRange {
                    triangle,
                    index,
                    vertices: count,
                });
            }
        }
        Ok(Self {
            vertices,
            triangles,
        })
    }

    /// The vertices.
    pub fn vertices(&self) -> &Arc<VertexBuffer> {
        &self.vertices
    }

    /// The three vertices of each triangle.
    pub fn triangles(&self) -> &Arc<IndexBuffer> {
        &self.triangles
    }

    /// Makes Embree's object of the mesh. It reads the buffers in place, so `self` or a clone of it
    /// must outlive the object and every scene that it is attached to.
    pub(super) fn to_embree(&self, device: &Device) -> Result<GeometryHandle, EmbreeError> {
        let geometry = GeometryHandle::new(device, raw::RTCGeometryType::TRIANGLE)?;
        let VertexLayout { start, stride } = self.vertices.layout();
        // SAFETY: the geometry is alive; the buffers hold as many triples of the stated format, at the
        // stated distances, as stated; they never change, 16 bytes are readable at each triple as
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
                raw::RTCFormat::UINT3,
                self.triangles.as_ptr().cast(),
                0,
                size_of::<[u32; 3]>() as _,
                self.triangles.len() as _,
            );
            raw::rtcCommitGeometry(geometry.raw());
        }
        device.check("take a triangle mesh")?;
        Ok(geometry)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(
        vertices: Vec<[f32; 3]>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<TriangleMesh, EmbreeError> {
        TriangleMesh::new(
            Arc::new(VertexBuffer::new(vertices)),
            Arc::new(IndexBuffer::new(triangles)),
        )
    }

    #[test]
    fn bad_meshes_are_errors_that_name_the_offender() {
        let corners = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        assert!(mesh(corners.clone(), vec![[0, 1, 2]]).is_ok());
        assert_eq!(
            mesh(corners.clone(), vec![]).unwrap_err(),
            EmbreeError::EmptyMesh
        );
        assert_eq!(
            mesh(corners.clone(), vec![[0, 1, 2], [0, 3, 1]]).unwrap_err(),
            EmbreeError::IndexOutOfRange {
                triangle: 1,
                index: 3,
                vertices: 3
            }
        );
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 2.0e18] {
            let mut vertices = corners.clone();
            vertices[2][1] = bad;
            let error = mesh(vertices, vec![[0, 1, 2]]).unwrap_err();
            assert!(
                matches!(error, EmbreeError::BadVertex { vertex: 2, .. }),
                "{error}"
            );
        }
    }
}
