//! `results.csv`: one row for each competitor, snapshot and repetition.

use serde::Serialize;

use super::ReportError;
use crate::study::results::{Competitor, Errors, Results, Snapshot};

/// A row; `docs/results.md` explains the columns.
#[derive(Serialize)]
struct Row<'a> {
    competitor: &'a str,
    repetition: usize,
    at: f64,
    mean_seconds: f64,
    mean_camera_paths: f64,
    mean_rays: Option<f64>,
    relative_mse: f64,
    mse: f64,
    bias: f64,
    lit_relative_mse: f64,
    lit_mse: f64,
    reflected_relative_mse: f64,
    reflected_mse: f64,
    flip: Option<f64>,
}

impl<'a> Row<'a> {
    fn new(competitor: &'a Competitor, snapshot: &Snapshot, index: usize, errors: &Errors) -> Self {
        Self {
            competitor: &competitor.name,
            repetition: index + 1,
            at: snapshot.at,
            mean_seconds: snapshot.seconds,
            mean_camera_paths: snapshot.camera_paths,
            mean_rays: snapshot.rays,
            relative_mse: errors.relative_mse,
            mse: errors.mse,
            bias: errors.bias,
            lit_relative_mse: errors.lit.relative_mse,
            lit_mse: errors.lit.mse,
            reflected_relative_mse: errors.reflected.relative_mse,
            reflected_mse: errors.reflected.mse,
            flip: errors.flip,
        }
    }
}

/// The whole file.
pub fn csv(results: &Results) -> Result<Vec<u8>, ReportError> {
    let refuse = |message: String| ReportError::Encode {
        what: "results.csv",
        message,
    };
    let mut writer = csv::Writer::from_writer(Vec::new());
    for competitor in &results.competitors {
        for snapshot in &competitor.snapshots {
            for (index, errors) in snapshot.repetitions.iter().enumerate() {
                let row = Row::new(competitor, snapshot, index, errors);
                writer
                    .serialize(row)
                    .map_err(|error| refuse(error.to_string()))?;
            }
        }
    }
    writer
        .into_inner()
        .map_err(|error| refuse(error.to_string()))
}
