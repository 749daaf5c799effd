//! Files of values, such as renders under way: wholly there, and not taken for good where they are damaged.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crc::Crc;
use serde::Serialize;
use serde::de::DeserializeOwned;
use thiserror::Error;

use super::{FilmFileError, WholeFile};

/// What a file ends with.
const CHECK: Crc<u32> = Crc::<u32>::new(&crc::CRC_32_ISCSI);

/// Why a value cannot be written or read.
#[derive(Debug, Error)]
pub enum CheckedFileError {
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] FilmFileError),
    /// The file is there and cannot be read.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The value cannot be encoded.
    #[error("what has been rendered cannot be kept: {0}")]
    Encode(postcard::Error),
    /// The file holds no such value.
    #[error("it is damaged ({0})")]
    Damaged(postcard::Error),
}

/// Writes `value` into the file at `path`, in place of what was there.
///
/// # Errors
/// The disk refuses.
pub fn write_checked<T: Serialize>(path: &Path, value: &T) -> Result<(), CheckedFileError> {
    let bytes =
        postcard::to_stdvec_crc32(value, CHECK.digest()).map_err(CheckedFileError::Encode)?;
    let write = |source| FilmFileError::Write {
        path: path.to_owned(),
        source,
    };
    let file = WholeFile::create(path)?;
    Ok(file.finish(|writer| writer.write_all(&bytes).map_err(write))?)
}

/// The value in the file at `path`; `None` where there is no file.
///
/// # Errors
/// The file cannot be read, or was damaged.
pub fn read_checked<T: DeserializeOwned>(path: &Path) -> Result<Option<T>, CheckedFileError> {
    match fs::read(path) {
        Ok(bytes) => postcard::from_bytes_crc32(&bytes, CHECK.digest())
            .map(Some)
            .map_err(CheckedFileError::Damaged),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(source) => Err(CheckedFileError::Read {
            path: path.to_owned(),
            source,
        }),
    }
}
