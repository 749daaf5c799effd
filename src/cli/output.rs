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
    #[error("{}: this is a folder; name a file in it that ends in .exr", .0.display())]
    Folder(PathBuf),
    #[error("{}: the image is written there; name another file", .0.display())]
    Taken(PathBuf),
    #[error(transparent)]
    File(#[from] FilmFileError),
}

impl OutputFiles {
    /// The files for `output`, which ends in `.exr` or has no extension. Both are proven to be writable, so that no time
    /// is spent on an image that would be lost.
    pub fn check(output: &Path) -> Result<Self, OutputError> {
        if output.is_dir() {
            return Err(OutputError::Folder(output.to_owned()));
        }
        let exr = match output.extension() {
            Some(extension) if extension.eq_ignore_ascii_case("exr") => output.to_owned(),
            None => output.with_extension("exr"),
            Some(_) => return Err(OutputError::Extension(output.to_owned())),
        };
        let png = output.with_extension("png");
        for path in [&exr, &png] {
            WholeFile::create(path)?;
        }
        Ok(Self { exr, png })
    }

    /// Whether a file that is written besides is another than these, however it is named.
    pub fn check_other(&self, path: &Path) -> Result<(), OutputError> {
        let place = |path: &Path| {
            let folder = match path.parent() {
                Some(folder) if folder != Path::new("") => folder,
                _ => Path::new("."),
            };
            (
                folder.canonicalize().ok(),
                path.file_name().map(|name| name.to_owned()),
            )
        };
        if [&self.exr, &self.png]
            .map(|file| place(file))
            .contains(&place(path))
        {
            return Err(OutputError::Taken(path.to_owned()));
        }
        Ok(())
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_files_are_named_after_the_output() {
        let folder = tempfile::tempdir().unwrap();
        let names = |output: &str| {
            let files = OutputFiles::check(&folder.path().join(output)).unwrap();
            [files.exr, files.png].map(|path| path.file_name().unwrap().to_owned())
        };
        assert_eq!(names("a.exr"), ["a.exr", "a.png"]);
        assert_eq!(names("a.EXR"), ["a.EXR", "a.png"]);
        assert_eq!(names("a"), ["a.exr", "a.png"]);
        assert_eq!(names("a.b.exr"), ["a.b.exr", "a.b.png"]);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn a_place_for_one_of_the_two_is_not_enough() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("a.png")).unwrap();
        let refused = OutputFiles::check(&folder.path().join("a.exr")).unwrap_err();
        assert!(refused.to_string().contains("a.png"), "{refused}");
        let refused = OutputFiles::check(folder.path()).unwrap_err();
        assert!(matches!(refused, OutputError::Folder(_)), "{refused}");
    }

    #[test]
    fn the_same_place_by_another_name_is_taken() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("b")).unwrap();
        let files = OutputFiles::check(&folder.path().join("a.exr")).unwrap();
        let is_other = |name: &str| files.check_other(&folder.path().join(name)).is_ok();
        assert!(!is_other("a.exr") && !is_other("b/../a.png"));
        assert!(is_other("a.checkpoint") && is_other("b/a.exr"));
    }

    #[test]
    fn memory_has_been_used() {
        assert!(peak_memory().is_none_or(|mib| mib > 0.5));
    }
}
