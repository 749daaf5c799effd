//! Every sampling routine draws what its density says.

use std::f32::consts::PI;

use glam::Vec3;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::{direction, materials, numbers, seen_in_rgb};
use crate::scene::bsdfs::{Bsdf, DirectionNumbers, Side};
use crate::spectrum::Spectrum;

const ROWS: usize = 24;
const COLUMNS: usize = 24;
/// Points in a bin at which the density is asked for, along each axis.
const FINE: usize = 24;
const DRAWS: usize = 100_000;

#[test]
fn sampled_directions_follow_the_density() {
    for (case, material) in materials() {
        for side in [Side::Front, Side::Back] {
            for outgoing in [
                direction(0.95, 0.3),
                direction(0.55, 2.0),
                direction(0.2, 4.0),
            ] {
                if let Some(bsdf) = seen_in_rgb(material, side, outgoing) {
                    let p = p_value(&bsdf, outgoing);
                    // About a hundred tests: one of them falls below this in a thousand runs.
                    assert!(p > 1e-5, "{} {side:?} {outgoing}: p = {p}", case.name);
                }
            }
        }
    }
}

/// The p-value of the hypothesis that samples are distributed like their density; what is not in a smooth lobe has a bin of its own.
pub(super) fn p_value(bsdf: &Bsdf<Spectrum<3>>, outgoing: Vec3) -> f64 {
    let mut expected: Vec<f64> = (0..ROWS * COLUMNS)
        .map(|bin| share(bsdf, outgoing, bin))
        .collect();
    expected.push(1.0 - expected.iter().sum::<f64>());
    let mut counts = vec![0u32; ROWS * COLUMNS + 1];
    let mut numbers = numbers();
    for _ in 0..DRAWS {
        let sample = bsdf.sample(outgoing, &DirectionNumbers::new(numbers()));
        let smooth = sample.pdf.0 > 0.0 && sample.pdf.0.is_finite();
        let bin = if smooth {
            bin_of(sample.incident)
        } else {
            ROWS * COLUMNS
        };
        counts[bin] += 1;
    }
    // Bins in which little is expected are taken together, as the test demands.
    let (mut statistic, mut degrees, mut rest) = (0.0, -1.0, (0.0, 0.0));
    let mut add = |expected: f64, count: f64| {
        statistic += (count - expected).powi(2) / expected;
        degrees += 1.0;
    };
    for (share, count) in expected.into_iter().zip(counts) {
        let expected = share * DRAWS as f64;
        if expected > 20.0 {
            add(expected, f64::from(count));
        } else {
            rest = (rest.0 + expected.max(0.0), rest.1 + f64::from(count));
        }
    }
    if rest.0 > 20.0 {
        add(rest.0, rest.1);
    } else if rest.1 > rest.0 + 10.0 * (rest.0 + 1.0).sqrt() {
        return 0.0;
    }
    if degrees < 1.0 {
        return 1.0;
    }
    ChiSquared::new(degrees).unwrap().sf(statistic)
}

fn bin_of(incident: Vec3) -> usize {
    let row = ((incident.z + 1.0) * 0.5 * ROWS as f32) as usize;
    let azimuth = incident.y.atan2(incident.x) / (2.0 * PI) + 0.5;
    let column = (azimuth * COLUMNS as f32) as usize;
    row.min(ROWS - 1) * COLUMNS + column.min(COLUMNS - 1)
}

/// The integral of the density over a bin.
fn share(bsdf: &Bsdf<Spectrum<3>>, outgoing: Vec3, bin: usize) -> f64 {
    let (row, column) = (bin / COLUMNS, bin % COLUMNS);
    let mut sum = 0.0;
    for i in 0..FINE {
        for j in 0..FINE {
            let at = |bin: usize, fine: usize| bin as f32 + (fine as f32 + 0.5) / FINE as f32;
            let cos = 2.0 * at(row, i) / ROWS as f32 - 1.0;
            let azimuth = (at(column, j) / COLUMNS as f32 - 0.5) * 2.0 * PI;
            sum += f64::from(bsdf.evaluate(outgoing, direction(cos, azimuth)).pdf.0);
        }
    }
    let area = 4.0 * std::f64::consts::PI / (ROWS * COLUMNS) as f64;
    sum * area / (FINE * FINE) as f64
}
