//! Where images are written, and what is said about them.

use std::path::{Path, PathBuf};

use cohort::film::{FilmFileError, WholeFile};
use thiserror::Error;

/// The two files of an image: the EXR and the PNG beside it.
#[derive(Clone, Debug)]
pub struct OutputFiles {
    pub exr: PathBuf,
    pub png: PathBuf,
}

/// Why an image cannot be written there.
#[derive(Debug, Error)]
pub enum OutputError {
    #[error("{}: an image is written as EXR with a PNG beside it; name a file that ends in .exr", .0.display())]
    Extension(PathBuf),
    #[error(transparent)]
    File(#[from] FilmFileError),
}

impl OutputFiles {
    /// The files for `output`, which ends in `.exr` or has no extension. Both are proven to be writable, so that no time
    /// is spent on an image that would be lost.
    pub fn check(output: &Path) -> Result<Self, OutputError> {
        match output.extension() {
            Some(extension) if extension.eq_ignore_ascii_case("exr") => {}
            None => {}
            Some(_) => return Err(OutputError::Extension(output.to_owned())),
        }
        let files = Self {
            exr: output.with_extension("exr"),
            png: output.with_extension("png"),
        };
        for path in [&files.exr, &files.png] {
            WholeFile::create(path)?;
        }
        Ok(files)
    }
}

/// The most memory that the process has used, in MiB, where the system tells.
pub fn peak_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes / 1024.0)
}
