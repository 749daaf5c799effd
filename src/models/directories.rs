//! Where models lie.

use std::env;
use std::path::{Path, PathBuf};

use super::Model;

/// The environment variable that names a folder of models.
pub const DIRECTORY_VARIABLE: &str = "COHORT_MODELS";

/// The folder of models when nothing else is said, from the working directory.
pub const DEFAULT_DIRECTORY: &str = "scenes/models";

/// The folders in which models are looked for, the first first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModelDirectories {
    /// Never empty.
    folders: Vec<PathBuf>,
}

impl ModelDirectories {
    /// The folder the user `asked` for if there is one, that of [`DIRECTORY_VARIABLE`] if it is set
    /// and not empty, and [`DEFAULT_DIRECTORY`].
    pub fn new(asked: Option<PathBuf>) -> Self {
        let variable = env::var_os(DIRECTORY_VARIABLE).map(PathBuf::from);
        Self::in_order(asked, variable)
    }

    /// [`ModelDirectories::new`] with the value of the variable as an argument.
    pub(super) fn in_order(asked: Option<PathBuf>, variable: Option<PathBuf>) -> Self {
        let variable = variable.filter(|folder| !folder.as_os_str().is_empty());
        let default = Some(PathBuf::from(DEFAULT_DIRECTORY));
        Self {
            folders: [asked, variable, default].into_iter().flatten().collect(),
        }
    }

    /// The folder into which a missing model is written: the first.
    pub fn destination(&self) -> &Path {
        &self.folders[0]
    }

    /// The file of `model` in the first folder that has it.
    pub fn find(&self, model: Model) -> Option<PathBuf> {
        let mut files = self.folders.iter().map(|f| f.join(model.file_name()));
        files.find(|file| file.is_file())
    }
}
