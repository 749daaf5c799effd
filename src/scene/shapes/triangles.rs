//! Triangle meshes in world space, as rays and lights need them.

use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::{Geometry, HitCoordinates, Placement, ShapeSample, SurfacePoint};
use crate::embree::{IndexBuffer, VertexBuffer};
use crate::sampling::{AliasTable, warp};
use crate::scene::error::SceneError;
use crate::scene::mesh::{self, MeshData};
use crate::scene::xml::Object;

/// A triangle mesh in world space. Its buffers are shared with the intersection layer, not copied.
#[derive(Debug)]
pub struct Triangles {
    positions: Arc<VertexBuffer>,
    indices: Arc<IndexBuffer>,
    attributes: TriangleAttributes,
    area: f32,
    /// Triangles by area; built only for meshes that emit.
    by_area: Option<AliasTable>,
}

/// What a mesh carries beside positions and indices.
#[derive(Clone, Debug, Default)]
pub struct TriangleAttributes {
    /// Unit vertex normals in world space; without them the mesh is shaded flat.
    pub normals: Option<Vec<Vec3>>,
    /// Whether the clockwise side of the triangles is the outer one.
    pub flip_normals: bool,
}

impl Triangles {
    /// A flat-sided mesh in the world. Its normals follow the transform, even one that mirrors.
    pub(super) fn place(
        mut mesh: MeshData,
        placement: &Placement,
        object: &Object,
    ) -> Result<Geometry, SceneError> {
        if placement.to_world.determinant() < 0.0 {
            mesh.triangles
                .iter_mut()
                .for_each(|triangle| triangle.reverse());
        }
        Self::place_mesh(mesh, false, placement, object)
    }

    /// A mesh in the world; `smooth` makes vertex normals for it there.
    pub(super) fn place_mesh(
        mut mesh: MeshData,
        smooth: bool,
        placement: &Placement,
        object: &Object,
    ) -> Result<Geometry, SceneError> {
        for position in &mut mesh.positions {
            let local = Vec3::from(*position).as_dvec3();
            *position = placement.to_world.transform_point3(local).as_vec3().into();
        }
        if mesh
            .positions
            .iter()
            .flatten()
            .any(|coordinate| !coordinate.is_finite())
        {
            return Err(
                object.parameter_error("to_world", "`to_world` moves vertices beyond all numbers")
            );
        }
        let to_world = placement.normals();
        let normals = match mesh.normals.take() {
            Some(normals) => Some(
                normals
                    .into_iter()
                    .map(|normal| {
                        (to_world * DVec3::from(normal.map(f64::from)))
                            .as_vec3()
                            .normalize_or_zero()
                    })
                    .collect(),
            ),
            None if smooth => Some(
                mesh::smooth_normals(&mesh.positions, &mesh.triangles)
                    .into_iter()
                    .map(Vec3::from)
                    .collect(),
            ),
            None => None,
        };
        let attributes = TriangleAttributes {
            normals,
            flip_normals: placement.flip_normals,
        };
        let positions = Arc::new(VertexBuffer::new(mesh.positions));
        let indices = Arc::new(IndexBuffer::new(mesh.triangles));
        Ok(Geometry::Triangles(Self::new(
            positions, indices, attributes,
        )))
    }

    /// The mesh over buffers in world space. Indices must be in range and `attributes.normals`, if given, as long as
    /// `positions` (every mesh reader of [`crate::scene::mesh`] keeps this).
    pub fn new(
        positions: Arc<VertexBuffer>,
        indices: Arc<IndexBuffer>,
        attributes: TriangleAttributes,
    ) -> Self {
        let area = triangle_areas(&positions, &indices)
            .map(f64::from)
            .sum::<f64>() as f32;
        Self {
            positions,
            indices,
            attributes,
            area,
            by_area: None,
        }
    }

    /// Makes the mesh ready for [`Self::sample`]. Returns whether it can be: its area must be positive and finite.
    pub fn prepare_sampling(&mut self) -> bool {
        let areas: Vec<f32> = triangle_areas(&self.positions, &self.indices).collect();
        self.by_area = AliasTable::new(&areas);
        self.by_area.is_some()
    }

    /// The vertex positions, in world space.
    pub fn positions(&self) -> &Arc<VertexBuffer> {
        &self.positions
    }

    /// The vertex indices of the triangles.
    pub fn indices(&self) -> &Arc<IndexBuffer> {
        &self.indices
    }

    #[inline]
    pub(super) fn surface(&self, hit: &HitCoordinates) -> SurfacePoint {
        self.point(hit.primitive, hit.u, hit.v)
    }

    /// The point of a triangle at barycentric coordinates of its second and third vertex.
    ///
    /// Interpolating the corners is more precise than going along the ray, whose error grows with the distance
    /// (Wächter and Binder 2019, "A Fast and Robust Method for Avoiding Self-Intersection").
    #[inline]
    fn point(&self, triangle: u32, u: f32, v: f32) -> SurfacePoint {
        let corners = self.indices[triangle as usize];
        let [a, b, c] = corners.map(|i| Vec3::from(self.positions[i as usize]));
        let geometric_normal = (b - a).cross(c - a).normalize_or_zero();
        let shading_normal = match &self.attributes.normals {
            Some(normals) => {
                let [na, nb, nc] = corners.map(|i| normals[i as usize]);
                let interpolated = na + u * (nb - na) + v * (nc - na);
                // Opposite normals can cancel out; then the true surface decides.
                interpolated.try_normalize().unwrap_or(geometric_normal)
            }
            None => geometric_normal,
        };
        let position = a + u * (b - a) + v * (c - a);
        SurfacePoint {
            position,
            geometric_normal,
            shading_normal,
        }
        .flipped_if(self.attributes.flip_normals)
    }

    pub(super) fn area(&self) -> f32 {
        self.area
    }

    pub(super) fn sample(&self, reference: Vec3, u: [f32; 2]) -> ShapeSample {
        // A mesh that was never prepared is no light, and nobody samples it; its first triangle is a valid answer.
        let (triangle, remainder) = match &self.by_area {
            Some(table) => {
                let chosen = table.sample(u[0]);
                (chosen.index, chosen.remainder)
            }
            None => (0, u[0]),
        };
        let [v, w] = warp::triangle([remainder, u[1]]);
        ShapeSample::by_area(reference, self.point(triangle as u32, v, w), self.area)
    }
}

fn triangle_areas(positions: &[[f32; 3]], indices: &[[u32; 3]]) -> impl Iterator<Item = f32> {
    indices.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|i| Vec3::from(positions[i as usize]));
        0.5 * (b - a).cross(c - a).length()
    })
}
