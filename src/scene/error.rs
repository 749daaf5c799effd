//! What can be wrong with a scene, told to the person who wrote it.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::mesh::MeshError;

/// A place in a scene file.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Location {
    /// The file as it was opened, or the name of a built-in scene in angle brackets.
    pub file: Arc<Path>,
    /// The line, from 1.
    pub line: u32,
    /// The column in characters, from 1.
    pub column: u32,
}

impl fmt::Display for Location {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            formatter,
            "{}:{}:{}",
            self.file.display(),
            self.line,
            self.column
        )
    }
}

/// Why a scene cannot be loaded. The message is one sentence: where, what, and what would be right.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// Something written in a scene file is wrong.
    #[error("{location}: {message}")]
    Invalid {
        /// Where it is written.
        location: Location,
        /// What is wrong and what would be right.
        message: String,
    },
    /// A mesh that the scene names cannot be used.
    #[error("{location}: {error}")]
    Mesh {
        /// The shape or the parameter that names the mesh file.
        location: Location,
        /// What is wrong with the mesh.
        error: Box<MeshError>,
    },
    /// The scene file itself cannot be read.
    #[error("cannot read the scene {}: {error}", path.display())]
    Unreadable {
        /// The file asked for.
        path: PathBuf,
        /// What the system says.
        error: io::Error,
    },
    /// The definitions that come with the scene (`-D name=value`) do not fit it.
    #[error("{0}")]
    Definition(String),
}

impl SceneError {
    /// An error in what is written at `location`.
    pub fn at(location: &Location, message: impl Into<String>) -> Self {
        Self::Invalid {
            location: location.clone(),
            message: message.into(),
        }
    }

    /// An error in the mesh named at `location`.
    pub fn mesh(location: &Location, error: MeshError) -> Self {
        Self::Mesh {
            location: location.clone(),
            error: Box::new(error),
        }
    }
}

/// `items` as a list for a message: "a, b, c", or "none".
pub(crate) fn list<T: fmt::Display>(items: impl IntoIterator<Item = T>) -> String {
    let items: Vec<String> = items.into_iter().map(|item| item.to_string()).collect();
    if items.is_empty() {
        "none".to_owned()
    } else {
        items.join(", ")
    }
}
