//! Fewer triangles for the same shape.

use meshopt::{SimplifyOptions, VertexDataAdapter, typed_to_bytes};

use crate::scene::mesh::MeshData;

use super::ModelsError;

/// How far the triangle count may stay above the one wanted, as a share of it.
const TOLERANCE: f64 = 0.01;

/// Simplifies `mesh` by edge collapses with quadric error metrics (Garland and Heckbert 1997, as
/// in meshoptimizer) to at most about `wanted` triangles.
///
/// The result has positions and triangles only, every position is one of `mesh`'s, unused ones are
/// gone, and no triangle has an area of zero.
///
/// # Errors
/// When the topology does not let the count come within 1 % of `wanted`.
pub fn simplify(mesh: &MeshData, wanted: usize) -> Result<MeshData, ModelsError> {
    let stride = size_of::<[f32; 3]>();
    let reached_nothing = |_| ModelsError::Simplification {
        reached: mesh.triangles.len(),
        wanted,
    };
    let vertices = VertexDataAdapter::new(typed_to_bytes(&mesh.positions), stride, 0)
        .map_err(reached_nothing)?;
    let mut indices = meshopt::simplify(
        mesh.triangles.as_flattened(),
        &vertices,
        3 * wanted,
        f32::MAX,
        SimplifyOptions::None,
        None,
    );
    let reached = indices.len() / 3;
    if reached as f64 > wanted as f64 * (1.0 + TOLERANCE) {
        return Err(ModelsError::Simplification { reached, wanted });
    }
    let positions = meshopt::optimize_vertex_fetch(&mut indices, &mesh.positions);
    let (triangles, _) = indices.as_chunks();
    Ok(MeshData {
        attributes: Vec::new(),
        triangles: triangles
            .iter()
            .copied()
            .filter(|triangle| has_area(&positions, triangle))
            .collect(),
        positions,
        normals: None,
        uvs: None,
    })
}

/// Whether the corners of a triangle are not on one line.
fn has_area(positions: &[[f32; 3]], triangle: &[u32; 3]) -> bool {
    let [a, b, c] = triangle.map(|i| glam::Vec3::from(positions[i as usize]).as_dvec3());
    (b - a).cross(c - a).length_squared() > 0.0
}
