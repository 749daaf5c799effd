//! How a mesh is put in the world: moved, its triangles in pairs, with normals only where they say something.

use glam::{DVec3, Vec3};

use super::faces::{Faces, Reordered};
use super::triangles::{TextureCoordinates, TriangleAttributes, Triangles};
use super::{Geometry, Placement};
use crate::embree::VertexBuffer;
use crate::scene::error::SceneError;
use crate::scene::mesh::pairing::{self, MOST_TRIANGLES};
use crate::scene::mesh::{self, MeshData};
use crate::scene::xml::Object;

impl Placement {
    /// A flat-sided mesh in the world. Its normals follow the transform, even one that mirrors.
    pub(super) fn flat_sided(
        &self,
        mut mesh: MeshData,
        object: &Object,
    ) -> Result<Geometry, SceneError> {
        if self.to_world.determinant() < 0.0 {
            mesh.triangles
                .iter_mut()
                .for_each(|triangle| triangle.reverse());
        }
        self.mesh(mesh, false, object)
    }

    /// A mesh in the world; `smooth` makes vertex normals for it there where it has none.
    pub(super) fn mesh(
        &self,
        mut mesh: MeshData,
        smooth: bool,
        object: &Object,
    ) -> Result<Geometry, SceneError> {
        let count = mesh.triangles.len();
        if count > MOST_TRIANGLES {
            return Err(object.error(format!(
                "this mesh has {count} triangles, more than the {MOST_TRIANGLES} that can be numbered"
            )));
        }
        self.move_positions(&mut mesh.positions, object)?;
        let normals = match mesh.normals.take() {
            Some(normals) => Some(self.moved_normals(&normals)),
            None if smooth => Some(mesh::smooth_normals(&mesh.positions, &mesh.triangles)),
            None => None,
        };
        let normals = normals.filter(|normals| !are_flat(&mesh, normals));
        let Reordered { faces, beginnings } = Faces::of(&mesh.positions, &mesh.triangles);
        let named = mesh.attributes.into_iter().map(|attribute| {
            if attribute.is_of_faces {
                let triangles = beginnings.iter().map(|&first| pairing::triangle_of(first));
                attribute.reordered(triangles)
            } else {
                attribute
            }
        });
        let attributes = TriangleAttributes {
            named: named.collect(),
            coordinates: match mesh.uvs {
                Some(uvs) => TextureCoordinates::OfVertices(uvs),
                None => TextureCoordinates::of_triangles(&beginnings),
            },
            flip_normals: self.flip_normals,
        };
        let vertices = match normals {
            Some(normals) => VertexBuffer::with_normals(mesh.positions.into_iter().zip(normals)),
            None => VertexBuffer::new(mesh.positions),
        };
        Ok(Geometry::Triangles(Triangles::new(
            vertices, faces, attributes,
        )))
    }

    fn move_positions(
        &self,
        positions: &mut [[f32; 3]],
        object: &Object,
    ) -> Result<(), SceneError> {
        for position in positions {
            let local = Vec3::from(*position).as_dvec3();
            let moved = self.to_world.transform_point3(local).as_vec3();
            if !moved.is_finite() {
                let problem = "`to_world` moves vertices beyond all numbers";
                return Err(object.parameter_error("to_world", problem));
            }
            *position = moved.into();
        }
        Ok(())
    }

    /// Vertex normals in the world, of length 1 or 0.
    fn moved_normals(&self, normals: &[[f32; 3]]) -> Vec<[f32; 3]> {
        let to_world = self.normals();
        let moved = normals.iter().map(|normal| {
            let moved = to_world * DVec3::from(normal.map(f64::from));
            moved.as_vec3().normalize_or_zero().into()
        });
        moved.collect()
    }
}

/// Whether vertex normals say no more than the triangles themselves.
fn are_flat(mesh: &MeshData, normals: &[[f32; 3]]) -> bool {
    mesh.triangles.iter().all(|triangle| {
        let [a, b, c] = triangle.map(|i| Vec3::from(mesh.positions[i as usize]));
        let normal = (b - a).cross(c - a).normalize_or_zero();
        triangle
            .iter()
            .all(|&i| Vec3::from(normals[i as usize]).dot(normal) > 1.0 - 1e-6)
    })
}
