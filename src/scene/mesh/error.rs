//! What can be wrong with a mesh file.

use std::io;
use std::path::{Path, PathBuf};

/// Why a mesh file cannot be used.
#[derive(Debug, thiserror::Error)]
#[error("{}: {problem}", file.display())]
pub struct MeshError {
    /// The file.
    pub file: PathBuf,
    /// What is wrong with it.
    pub problem: MeshProblem,
}

impl MeshError {
    /// A problem of `file`.
    pub fn new(file: &Path, problem: MeshProblem) -> Self {
        Self {
            file: file.to_owned(),
            problem,
        }
    }
}

/// What is wrong with a mesh. Vertices and faces are counted from 0.
#[derive(Debug, thiserror::Error)]
pub enum MeshProblem {
    /// The system cannot read or write the file.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// The file is not of the format that it should be, or says something that has no meaning.
    #[error("{0}")]
    Format(String),
    /// The file ends inside an element.
    #[error("the file is truncated: it ends in {element} {index} of {count}")]
    Truncated {
        /// The kind of element, such as "vertex".
        element: String,
        /// The first element that is not complete.
        index: u64,
        /// How many of them the file claims to have.
        count: u64,
    },
    /// A face names a vertex that does not exist.
    #[error(
        "face {face} refers to vertex {index}, but there are {vertices} vertices, counted from 0"
    )]
    IndexOutOfRange {
        /// The face.
        face: u64,
        /// The vertex that it names.
        index: i64,
        /// How many vertices there are.
        vertices: u64,
    },
    /// A number of a vertex is NaN or infinite.
    #[error("the {attribute} of vertex {vertex} is not finite")]
    NotFinite {
        /// "position", "normal" or "texture coordinate".
        attribute: &'static str,
        /// The vertex.
        vertex: u64,
    },
    /// The mesh has no vertices.
    #[error("the mesh is empty: it has no vertices")]
    NoVertices,
    /// The mesh has no triangles.
    #[error("the mesh is empty: it has no triangles")]
    NoTriangles,
}
