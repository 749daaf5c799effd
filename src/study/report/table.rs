//! A table of text, before it becomes HTML or Markdown.

use super::numbers::{Shown, shown};
use crate::study::statistics::Interval;

/// A table whose first column names the rows.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// What it shows.
    pub title: String,
    /// What to know when reading it; may be empty.
    pub note: String,
    /// Heads of the columns.
    pub columns: Vec<String>,
    /// Rows of as many cells.
    pub rows: Vec<Vec<Cell>>,
}

/// A cell: a value, and what is said of it in small print.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cell {
    /// The value.
    pub value: String,
    /// Its interval or another remark; may be empty.
    pub detail: String,
}

impl From<Shown> for Cell {
    fn from(shown: Shown) -> Self {
        Self {
            value: shown.value,
            detail: shown.range.unwrap_or_default(),
        }
    }
}

impl From<String> for Cell {
    fn from(value: String) -> Self {
        Self {
            value,
            detail: String::new(),
        }
    }
}

impl From<&Interval> for Cell {
    fn from(interval: &Interval) -> Self {
        shown(interval).into()
    }
}

impl Cell {
    /// A value that a competitor may not have.
    pub fn or_dash(interval: Option<&Interval>) -> Self {
        interval.map_or_else(|| "–".to_owned().into(), Into::into)
    }
}
