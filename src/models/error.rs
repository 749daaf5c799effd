//! Why a model could not be provided.

use std::io;
use std::path::PathBuf;

/// Why a model could not be provided. No file has been changed then.
#[derive(Debug, thiserror::Error)]
pub enum ModelsError {
    /// The server cannot be reached or does not speak HTTP.
    #[error("cannot reach {url}: {source}")]
    Unreachable {
        /// The address asked for.
        url: String,
        /// What went wrong.
        source: Box<ureq::Error>,
    },
    /// The server answers, but does not give the file.
    #[error("{url}: the server answers with HTTP status {status} instead of the file")]
    Refused {
        /// The address asked for.
        url: String,
        /// The HTTP status.
        status: u16,
    },
    /// The transfer stopped.
    #[error("{url}: the download broke off after {received} of {expected} bytes: {source}")]
    BrokeOff {
        /// The address asked for.
        url: String,
        /// Bytes that arrived.
        received: u64,
        /// Bytes on record.
        expected: u64,
        /// What went wrong.
        source: io::Error,
    },
    /// The server gives a file of another size.
    #[error(
        "{url}: the server sent {received} bytes or more, but the file on record has {expected}"
    )]
    WrongSize {
        /// The address asked for.
        url: String,
        /// Bytes that arrived.
        received: u64,
        /// Bytes on record.
        expected: u64,
    },
    /// The server gives another file.
    #[error("{url}: this is not the file on record: its SHA-256 is\n  {found}, not\n  {expected}")]
    WrongDigest {
        /// The address asked for.
        url: String,
        /// The SHA-256 of what arrived.
        found: String,
        /// The SHA-256 on record.
        expected: String,
    },
    /// The downloaded file cannot be unpacked.
    #[error("{url}: the downloaded file cannot be unpacked: {problem}")]
    Unpack {
        /// The address it came from.
        url: String,
        /// What is wrong with it.
        problem: String,
    },
    /// The mesh in the downloaded file cannot be read.
    #[error("{url}: the downloaded mesh cannot be read: {problem}")]
    Mesh {
        /// The address it came from.
        url: String,
        /// What is wrong with it.
        problem: String,
    },
    /// The mesh is another one than that on record.
    #[error("{url}: the downloaded mesh has {found} triangles instead of {expected}")]
    TriangleCount {
        /// The address it came from.
        url: String,
        /// Triangles that were read.
        found: usize,
        /// Triangles on record.
        expected: usize,
    },
    /// The mesh does not let itself be simplified far enough.
    #[error("simplification stopped at {reached} triangles, {wanted} were wanted")]
    Simplification {
        /// Triangles left.
        reached: usize,
        /// Triangles wanted.
        wanted: usize,
    },
    /// A file or folder cannot be written.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What went wrong.
        source: io::Error,
    },
}

impl ModelsError {
    /// For `map_err`: `path` cannot be written.
    pub(super) fn write(path: impl Into<PathBuf>) -> impl FnOnce(io::Error) -> Self {
        let path = path.into();
        move |source| Self::Write { path, source }
    }
}
