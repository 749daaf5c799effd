//! The report of a study: one page that opens with the answer, and the same as Markdown, CSV, JSON and a figure.

mod answer;
mod cautions;
mod csv_file;
mod facts;
mod log_axis;
mod markdown;
mod numbers;
mod page;
mod pictures;
mod plots;
mod table;
mod tables;
mod viewer;

use std::io::Write;
use std::path::{Path, PathBuf};

use thiserror::Error;

pub use answer::Answer;

use super::results::{Results, StudyKind};
use crate::film::{FilmFileError, WholeFile};

/// The page.
pub const PAGE: &str = "index.html";
/// The same as Markdown.
pub const MARKDOWN: &str = "report.md";
/// Errors of every repetition.
pub const CSV: &str = "results.csv";
/// The data from which everything is made.
pub const JSON: &str = "results.json";
/// The images of a comparison side by side, crops below.
pub const FIGURE: &str = "figure.png";

/// Why a report could not be written.
#[derive(Debug, Error)]
pub enum ReportError {
    /// An image of a competitor is missing.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// An image of a competitor is no PNG.
    #[error("cannot read {} as a PNG: {message}", path.display())]
    Decode {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
    /// An encoder refused.
    #[error("cannot make {what}: {message}")]
    Encode {
        /// What was to be made.
        what: &'static str,
        /// Why.
        message: String,
    },
    /// A file of the report cannot be written.
    #[error(transparent)]
    Write(#[from] FilmFileError),
}

/// Writes the report of a study into `folder`, each file whole or not at all: [`PAGE`], [`MARKDOWN`], [`CSV`], [`JSON`]
/// and, for a comparison, [`FIGURE`].
///
/// The images that `results` names must be in `folder`.
pub fn write_report(results: &Results, folder: &Path) -> Result<(), ReportError> {
    let write = |name: &str, bytes: &[u8]| write_file(&folder.join(name), bytes);
    let answer = Answer::of(results);
    let tables = tables::tables(results);
    write(JSON, &json(results)?)?;
    write(CSV, &csv_file::csv(results)?)?;
    // An accuracy study has too many competitors for one row.
    let figure = match results.kind {
        StudyKind::Compare => pictures::figure(results, folder)?,
        StudyKind::Accuracy => None,
    };
    if let Some(figure) = &figure {
        write(FIGURE, figure)?;
    }
    let markdown = markdown::markdown(results, &answer, &tables, figure.is_some());
    write(MARKDOWN, markdown.as_bytes())?;
    let page = page::page(results, &answer, &tables, folder)?;
    write(PAGE, page.into_string().as_bytes())
}

fn json(results: &Results) -> Result<Vec<u8>, ReportError> {
    serde_json::to_vec_pretty(results).map_err(|error| ReportError::Encode {
        what: JSON,
        message: error.to_string(),
    })
}

fn write_file(path: &Path, bytes: &[u8]) -> Result<(), ReportError> {
    let written = WholeFile::create(path)?.finish(|writer| {
        writer
            .write_all(bytes)
            .map_err(|source| FilmFileError::Write {
                path: path.to_owned(),
                source,
            })
    });
    Ok(written?)
}
