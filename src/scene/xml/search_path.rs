//! Where the files that a scene names are looked for.

use std::path::{Path, PathBuf};

use crate::scene::error::list;

/// Directories in the order in which they are searched.
#[derive(Clone, Debug)]
pub(super) struct SearchPath {
    directories: Vec<PathBuf>,
}

impl SearchPath {
    /// Only the directory in which the program runs, which is always searched last.
    pub(super) fn working_directory() -> Self {
        Self {
            directories: vec![PathBuf::from(".")],
        }
    }

    /// Searches `directory` before all others.
    pub(super) fn prepend(&mut self, directory: PathBuf) {
        self.directories.insert(0, directory);
    }

    /// The first existing file or directory called `name`, or a message that names the places searched.
    pub(super) fn find(&self, name: &str) -> Result<PathBuf, String> {
        if name.is_empty() {
            return Err("the file name is empty".to_owned());
        }
        let path = Path::new(name);
        if path.is_absolute() {
            return match path.exists() {
                true => Ok(path.to_owned()),
                false => Err(format!("`{name}` does not exist")),
            };
        }
        self.directories
            .iter()
            .map(|directory| match directory.as_os_str() == "." {
                true => path.to_owned(),
                false => directory.join(path),
            })
            .find(|candidate| candidate.exists())
            .ok_or_else(|| {
                let places = self.directories.iter().map(|directory| directory.display());
                format!("`{name}` does not exist; searched in: {}", list(places))
            })
    }
}
