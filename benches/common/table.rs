//! Tables of results, printed and written into `cohort-bench/` of the target directory as CSV and Markdown.

use std::error::Error;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Rows of text under named columns.
pub struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table without rows.
    pub fn new<C: Into<String>>(columns: impl IntoIterator<Item = C>) -> Self {
        Self {
            columns: columns.into_iter().map(Into::into).collect(),
            rows: Vec::new(),
        }
    }

    /// Adds a row of one cell per column.
    pub fn push(&mut self, row: Vec<String>) {
        assert_eq!(row.len(), self.columns.len(), "{row:?}");
        self.rows.push(row);
    }

    /// Prints the table, and writes it as `NAME.csv` and `NAME.md`.
    pub fn publish(&self, name: &str) -> Result<(), Box<dyn Error>> {
        let folder = target_directory().join("cohort-bench");
        fs::create_dir_all(&folder)?;
        let mut csv = csv::Writer::from_path(folder.join(name).with_extension("csv"))?;
        csv.write_record(&self.columns)?;
        for row in &self.rows {
            csv.write_record(row)?;
        }
        csv.flush()?;
        let path = folder.join(name).with_extension("md");
        let text = self.markdown();
        fs::write(&path, &text)?;
        println!("\n{text}\n{}", path.display());
        Ok(())
    }

    /// As Markdown that also reads as plain text.
    fn markdown(&self) -> String {
        let widths: Vec<usize> = (0..self.columns.len())
            .map(|column| {
                let cells = self.rows.iter().map(|row| row[column].chars().count());
                cells.chain([self.columns[column].len(), 3]).max().unwrap()
            })
            .collect();
        let mut text = String::new();
        let mut line = |cells: &[String]| {
            for (cell, width) in cells.iter().zip(&widths) {
                let _ = write!(text, "| {cell:width$} ");
            }
            text.push_str("|\n");
        };
        line(&self.columns);
        line(
            &widths
                .iter()
                .map(|&width| "-".repeat(width))
                .collect::<Vec<_>>(),
        );
        for row in &self.rows {
            line(row);
        }
        text
    }
}

/// Cargo's target directory, wherever it was set.
pub fn target_directory() -> &'static Path {
    // Cargo makes this one inside of it.
    let inside = Path::new(env!("CARGO_TARGET_TMPDIR"));
    inside.parent().unwrap_or(inside)
}
