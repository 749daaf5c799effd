//! What a study keeps in its folder, so that it can be interrupted at any time and resumed.

use std::fs;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::results::Errors;
use super::{Standing, StudyError};
use crate::film::{WholeFile, read_checked, write_checked};
use crate::render::RenderState;

/// Where one competitor stood at a snapshot.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    /// What it had used and done.
    pub standing: Standing,
    /// The errors of its image.
    pub errors: Errors,
}

/// How far a study is.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Kept {
    /// Which study this is.
    pub fingerprint: String,
    /// The reference, while it is rendered.
    pub reference: Option<RenderState>,
    /// What rendering the reference took, when it is done.
    pub reference_cost: Option<ReferenceCost>,
    /// Of every complete repetition, of every competitor: the snapshots.
    pub complete: Vec<Vec<Vec<Record>>>,
    /// The repetition under way.
    pub under_way: Option<UnderWay>,
}

/// What a rendered reference took.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReferenceCost {
    /// Seconds of rendering.
    pub seconds: f64,
    /// Camera paths per pixel in the mean.
    pub samples_per_pixel: f64,
}

/// A repetition under way.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct UnderWay {
    /// The turn that is not complete yet.
    pub turn: usize,
    /// Of every competitor: the snapshots so far.
    pub records: Vec<Vec<Record>>,
    /// Of every competitor: what it has rendered.
    pub states: Vec<Vec<u8>>,
}

/// The folder of a study.
#[derive(Clone, Debug)]
pub struct StudyFolder {
    path: PathBuf,
}

impl StudyFolder {
    /// Makes the folder, if need be, and reads how far the study in it is.
    ///
    /// # Errors
    /// It cannot be made, or it holds another study.
    pub fn open(path: &Path, fingerprint: &str) -> Result<(Self, Kept), StudyError> {
        let folder = Self {
            path: path.to_owned(),
        };
        for path in [path.to_owned(), folder.images()] {
            fs::create_dir_all(&path).map_err(|source| StudyError::Io { path, source })?;
        }
        // Found out now rather than after hours.
        WholeFile::create(&folder.kept_path())?;
        let fresh = Kept {
            fingerprint: fingerprint.to_owned(),
            ..Kept::default()
        };
        let kept = read_checked(&folder.kept_path())?.unwrap_or(fresh);
        if kept.fingerprint != fingerprint {
            return Err(StudyError::AnotherStudy(path.to_owned()));
        }
        Ok((folder, kept))
    }

    /// The folder itself.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The folder of all images.
    pub fn images(&self) -> PathBuf {
        self.path.join("images")
    }

    /// The reference, with its variance.
    pub fn reference(&self) -> PathBuf {
        self.images().join("reference.exr")
    }

    /// The final image of a repetition.
    pub fn repetition(&self, competitor: &str, repetition: usize) -> PathBuf {
        let name = format!("{}-{}.exr", file_name(competitor), repetition + 1);
        self.images().join(name)
    }

    fn kept_path(&self) -> PathBuf {
        self.path.join("resume.bin")
    }

    /// Writes down how far the study is.
    ///
    /// # Errors
    /// The disk refuses.
    pub fn keep(&self, kept: &Kept) -> Result<(), StudyError> {
        Ok(write_checked(&self.kept_path(), kept)?)
    }
}

/// A competitor's name as part of a file name.
pub fn file_name(competitor: &str) -> String {
    let plain = |c: char| {
        if c.is_ascii_alphanumeric() || c == '.' {
            c
        } else {
            '-'
        }
    };
    competitor.chars().map(plain).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that are no others' length are not noticed by the format.
    #[test]
    fn a_damaged_file_is_refused() {
        let home = tempfile::tempdir().unwrap();
        let open = || StudyFolder::open(home.path(), "this study");
        let (folder, mut kept) = open().unwrap();
        kept.reference_cost = Some(ReferenceCost {
            seconds: 1.5,
            samples_per_pixel: 64.0,
        });
        folder.keep(&kept).unwrap();
        let (_, read) = open().unwrap();
        assert_eq!(read.reference_cost, kept.reference_cost);
        let whole = fs::read(folder.kept_path()).unwrap();
        for place in 0..whole.len() {
            let mut damaged = whole.clone();
            damaged[place] ^= 4;
            fs::write(folder.kept_path(), damaged).unwrap();
            let error = open().unwrap_err();
            assert!(matches!(error, StudyError::Damaged(_)), "{place}: {error}");
        }
    }
}
