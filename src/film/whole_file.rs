//! Files that are either wholly there or not at all.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use super::FilmFileError;

/// A file that is written under a temporary name beside its own, synced, and renamed when it is complete; dropped
/// before that, it leaves nothing behind.
#[derive(Debug)]
pub struct WholeFile {
    path: PathBuf,
    temporary: PathBuf,
    file: Option<File>,
}

impl WholeFile {
    /// Opens the temporary file. Fails at once where `path` cannot be written: its folder is missing or read-only, or
    /// the path is a folder.
    pub fn create(path: &Path) -> Result<Self, FilmFileError> {
        let refuse = |source| FilmFileError::Write {
            path: path.to_owned(),
            source,
        };
        let Some(name) = path.file_name() else {
            return Err(refuse(io::Error::new(
                io::ErrorKind::InvalidInput,
                "it does not name a file",
            )));
        };
        if path.is_dir() {
            return Err(refuse(io::Error::new(
                io::ErrorKind::IsADirectory,
                "it is a folder",
            )));
        }
        let is_missing = |folder: &Path| folder != Path::new("") && !folder.exists();
        if path.parent().is_some_and(is_missing) {
            return Err(refuse(io::Error::new(
                io::ErrorKind::NotFound,
                "its folder does not exist",
            )));
        }
        let mut temporary_name = std::ffi::OsString::from(".");
        temporary_name.push(name);
        temporary_name.push(format!(".{}.partial", std::process::id()));
        let temporary = path.with_file_name(temporary_name);
        let file = OpenOptions::new()
            .write(true)
            .read(true)
            .create(true)
            .truncate(true)
            .open(&temporary)
            .map_err(refuse)?;
        Ok(Self {
            path: path.to_owned(),
            temporary,
            file: Some(file),
        })
    }

    /// Writes all of the content with `write`, syncs it to the disk and gives the file its name.
    pub fn finish(
        mut self,
        write: impl FnOnce(&mut BufWriter<File>) -> Result<(), FilmFileError>,
    ) -> Result<(), FilmFileError> {
        let Some(file) = self.file.take() else {
            return Ok(());
        };
        let mut writer = BufWriter::new(file);
        write(&mut writer)?;
        let place = || -> io::Result<()> {
            writer
                .into_inner()
                .map_err(io::IntoInnerError::into_error)?
                .sync_all()?;
            fs::rename(&self.temporary, &self.path)
        };
        place().map_err(|source| FilmFileError::Write {
            path: self.path.clone(),
            source,
        })
    }
}

impl Drop for WholeFile {
    fn drop(&mut self) {
        // After a rename there is nothing left to remove, and a leftover is no reason to fail.
        let _ = fs::remove_file(&self.temporary);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn appears_only_when_complete() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.txt");
        drop(WholeFile::create(&path).unwrap());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        let file = WholeFile::create(&path).unwrap();
        assert!(!path.exists());
        file.finish(|writer| {
            writer.write_all(b"x").unwrap();
            Ok(())
        })
        .unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"x");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn refuses_at_once_what_cannot_be_written() {
        let folder = tempfile::tempdir().unwrap();
        assert!(WholeFile::create(folder.path()).is_err());
        assert!(WholeFile::create(&folder.path().join("missing/a.exr")).is_err());
        assert!(WholeFile::create(Path::new("/")).is_err());
    }
}
