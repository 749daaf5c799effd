//! Meshes to binary little-endian PLY.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use super::{MeshData, MeshError, MeshProblem};

/// Writes the positions, the normals if there are any, and the triangles of `mesh` to a new PLY file.
///
/// # Errors
/// When the system cannot write the file.
pub fn write_ply(path: &Path, mesh: &MeshData) -> Result<(), MeshError> {
    let write = || -> io::Result<()> {
        let mut file = BufWriter::new(File::create(path)?);
        write_ply_to(&mut file, mesh)?;
        file.flush()
    };
    write().map_err(|error| MeshError::new(path, MeshProblem::Io(error)))
}

/// Writes the same to any writer.
pub fn write_ply_to(writer: &mut impl Write, mesh: &MeshData) -> io::Result<()> {
    writeln!(writer, "ply\nformat binary_little_endian 1.0")?;
    writeln!(writer, "element vertex {}", mesh.positions.len())?;
    writeln!(
        writer,
        "property float x\nproperty float y\nproperty float z"
    )?;
    if mesh.normals.is_some() {
        writeln!(
            writer,
            "property float nx\nproperty float ny\nproperty float nz"
        )?;
    }
    writeln!(writer, "element face {}", mesh.triangles.len())?;
    writeln!(writer, "property list uchar int vertex_indices\nend_header")?;
    for (index, position) in mesh.positions.iter().enumerate() {
        let normal = mesh.normals.as_ref().map(|normals| &normals[index]);
        for number in position.iter().chain(normal.into_iter().flatten()) {
            writer.write_all(&number.to_le_bytes())?;
        }
    }
    for triangle in &mesh.triangles {
        writer.write_all(&[3])?;
        for index in triangle {
            writer.write_all(&index.to_le_bytes())?;
        }
    }
    Ok(())
}
