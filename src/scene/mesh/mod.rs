//! Triangle meshes as files hold them and as generators make them.

mod attribute;
mod check;
mod error;
pub mod knot;
mod normals;
pub mod obj;
pub(in crate::scene) mod pairing;
pub mod ply;
pub mod serialized;
mod write;

pub use attribute::{AttributeValues, MeshAttribute};
pub use error::{MeshError, MeshProblem};
pub use normals::smooth_normals;
pub use write::{write_ply, write_ply_to};

/// A triangle mesh in its own space.
///
/// Invariants (kept by every reader and generator): at least one triangle, every index below
/// `positions.len()`, every number finite, optional attributes as long as `positions`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshData {
    /// Vertex positions.
    pub positions: Vec<[f32; 3]>,
    /// Unit vertex normals, one per position, when the source has them.
    pub normals: Option<Vec<[f32; 3]>>,
    /// Texture coordinates, one per position, when the source has them.
    pub uvs: Option<Vec<[f32; 2]>>,
    /// What the source says of vertices and faces beside this.
    pub attributes: Vec<MeshAttribute>,
    /// Vertex indices of the triangles, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

#[cfg(test)]
mod tests;
