//! Why a study cannot go on.

use std::path::PathBuf;

use thiserror::Error;

use super::peer::PeerError;
use super::reference::ReferenceError;
use super::report::ReportError;
use crate::film::{CheckedFileError, FilmFileError};
use crate::render::RenderError;
use crate::walk::SettingError;

/// Why a study cannot go on.
#[derive(Debug, Error)]
pub enum StudyError {
    /// A setting that a strategy does not have.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// A render that cannot start.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// A peer that fails.
    #[error(transparent)]
    Peer(#[from] PeerError),
    /// A reference that is none for this scene.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    /// An image that cannot be written or read.
    #[error(transparent)]
    File(#[from] FilmFileError),
    /// A folder that cannot be made, or a file in it that cannot be read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// What has been rendered cannot be encoded.
    #[error("what has been rendered cannot be kept: {0}")]
    Encode(postcard::Error),
    /// What was kept of an interrupted study is not readable.
    #[error(
        "the study that was begun here is damaged ({0}); delete its folder, or choose another with -o"
    )]
    Damaged(postcard::Error),
    /// The report cannot be written.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// What was kept of an interrupted study is of another image.
    #[error(
        "the study that was begun here is damaged: an image has another size; delete its folder, or choose another with -o"
    )]
    Misfit,
    /// The folder holds another study.
    #[error(
        "{} holds another study, of other settings, scene or program; delete it, or choose another folder with -o",
        .0.display()
    )]
    AnotherStudy(PathBuf),
    /// Two competitors of one name.
    #[error("`{0}` takes part twice")]
    Twice(String),
    /// Nobody takes part.
    #[error("nobody takes part: name at least one strategy")]
    Nobody,
    /// A peer that needs a file to read.
    #[error(
        "`{0}` reads the scene from its file, and the built-in scene has none; name scenes/cornell-knot.xml"
    )]
    NoSceneFile(String),
    /// A budget that a competitor does not count.
    #[error("`{0}` does not count its rays; compare it by --time or --spp")]
    UncountedRays(String),
    /// No strategy is left for the reference.
    #[error(
        "every strategy takes part, so that none is left to render the reference; leave one out, or give a reference with --reference"
    )]
    NoReferenceStrategy,
}

impl From<CheckedFileError> for StudyError {
    fn from(error: CheckedFileError) -> Self {
        match error {
            CheckedFileError::Write(error) => Self::File(error),
            CheckedFileError::Read { path, source } => Self::Io { path, source },
            CheckedFileError::Encode(error) => Self::Encode(error),
            CheckedFileError::Damaged(error) => Self::Damaged(error),
        }
    }
}
