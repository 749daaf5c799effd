//! The table: a row for each subject, and the growth below them.

use super::fit::{added_per_factor_10, exponent};
use super::study::Measured;
use super::table::Table;

/// The names of the columns.
pub const COLUMNS: [&str; 14] = [
    "study",
    "triangles",
    "pixels",
    "samples",
    "s",
    "s/Mpath",
    "to the row above",
    "inside Embree, s/Mpath",
    "outside, s/Mpath",
    "build s",
    "load MiB",
    "BVH MiB",
    "BVH bytes/triangle",
    "peak MiB",
];

/// A number of a subject.
type Number = fn(&Measured) -> f64;

/// From so many subjects, the largest, exponents are fitted: fixed costs hide those of smaller ones.
const LARGEST: usize = 3;

/// Adds the rows of meshes of growing size. A logarithm adds the same seconds for every factor 10; build time and memory
/// follow a power law, whose exponent is 1 where they are linear.
pub fn push_meshes(table: &mut Table, measured: &[Measured]) {
    push_subjects(table, "mesh", measured);
    let size: Number = |m| m.subject.triangles as f64;
    let mut row = labelled("mesh: added per factor 10");
    let times: [(usize, Number); 3] = [
        (5, Measured::seconds_per_million_paths),
        (7, Measured::embree_seconds_per_million_paths),
        (8, Measured::other_seconds_per_million_paths),
    ];
    for (column, time) in times {
        let added = added_per_factor_10(&points(measured, size, time));
        row[column] = format!("{added:+.3}");
    }
    table.push(row);

    let mut row = labelled("mesh: exponent of triangles");
    let numbers: [(usize, Number); 5] = [
        (5, Measured::seconds_per_million_paths),
        (9, |m| m.build_seconds),
        (10, |m| m.load_mib),
        (11, |m| m.bvh_mib),
        (13, |m| m.peak_mib),
    ];
    fill_exponents(&mut row, measured, size, &numbers);
    table.push(row);
}

/// Adds the rows of images of growing size.
pub fn push_images(table: &mut Table, measured: &[Measured]) {
    push_subjects(table, "image", measured);
    let size: Number = |m| m.subject.pixels() as f64;
    let mut row = labelled("image: exponent of pixels");
    let numbers: [(usize, Number); 2] = [(4, |m| m.seconds), (13, |m| m.peak_mib)];
    fill_exponents(&mut row, measured, size, &numbers);
    table.push(row);
}

fn push_subjects(table: &mut Table, study: &str, measured: &[Measured]) {
    let mut above = None;
    for m in measured {
        let per_million = m.seconds_per_million_paths();
        let ratio = above.map(|above| format!("{:.3}", per_million / above));
        above = Some(per_million);
        table.push(vec![
            study.to_owned(),
            m.subject.triangles.to_string(),
            format!("{side}^2", side = m.subject.side),
            m.subject.samples.to_string(),
            format!("{:.3}", m.seconds),
            format!("{per_million:.3}"),
            ratio.unwrap_or_default(),
            format!("{:.3}", m.embree_seconds_per_million_paths()),
            format!("{:.3}", m.other_seconds_per_million_paths()),
            format!("{:.3}", m.build_seconds),
            format!("{:.1}", m.load_mib),
            format!("{:.1}", m.bvh_mib),
            format!(
                "{:.0}",
                m.bvh_mib * f64::from(1 << 20) / m.subject.triangles as f64
            ),
            format!("{:.1}", m.peak_mib),
        ]);
    }
}

/// A row with nothing but a label.
fn labelled(label: &str) -> Vec<String> {
    let mut row = vec![String::new(); COLUMNS.len()];
    row[0] = label.to_owned();
    row
}

/// Writes the exponents of `numbers`, each with its column, into `row`.
fn fill_exponents(
    row: &mut [String],
    measured: &[Measured],
    size: Number,
    numbers: &[(usize, Number)],
) {
    let largest = &measured[measured.len().saturating_sub(LARGEST)..];
    for &(column, number) in numbers {
        row[column] = format!("{:.3}", exponent(&points(largest, size, number)));
    }
}

fn points(measured: &[Measured], size: Number, number: Number) -> Vec<(f64, f64)> {
    measured.iter().map(|m| (size(m), number(m))).collect()
}
