//! What every mesh has to fulfil, whatever file it comes from.

use super::{MeshData, MeshProblem};

/// The mesh has vertices and faces, and their indices fit into 32 bits.
pub(super) fn counts(vertices: u64, faces: u64) -> Result<(), MeshProblem> {
    if vertices == 0 {
        return Err(MeshProblem::NoVertices);
    }
    if faces == 0 {
        return Err(MeshProblem::NoTriangles);
    }
    if vertices > u64::from(u32::MAX) {
        return Err(MeshProblem::Format(format!(
            "{vertices} vertices are too many; there can be {}",
            u32::MAX
        )));
    }
    Ok(())
}

/// The problem that `face` has fewer than three corners.
pub(super) fn too_few_corners(face: u64, corners: usize) -> MeshProblem {
    MeshProblem::Format(format!(
        "face {face} has {corners} corners; it needs at least 3"
    ))
}

/// Checks that all numbers are finite and makes the normals unit vectors.
pub(super) fn finished(mut mesh: MeshData) -> Result<MeshData, MeshProblem> {
    all_finite("position", &mesh.positions)?;
    if let Some(uvs) = &mesh.uvs {
        all_finite("texture coordinate", uvs)?;
    }
    if let Some(normals) = &mut mesh.normals {
        all_finite("normal", normals)?;
        for (vertex, normal) in normals.iter_mut().enumerate() {
            let unit = glam::DVec3::from_array(normal.map(f64::from)).try_normalize();
            let unit = unit.ok_or_else(|| {
                MeshProblem::Format(format!("the normal of vertex {vertex} has no direction"))
            })?;
            *normal = unit.as_vec3().to_array();
        }
    }
    Ok(mesh)
}

fn all_finite<const N: usize>(
    attribute: &'static str,
    vertices: &[[f32; N]],
) -> Result<(), MeshProblem> {
    let infinite = |vertex: &[f32; N]| vertex.iter().any(|number| !number.is_finite());
    match vertices.iter().position(infinite) {
        Some(vertex) => Err(MeshProblem::NotFinite {
            attribute,
            vertex: vertex as u64,
        }),
        None => Ok(()),
    }
}
