//! A density over the unit square by its values on a grid, bilinear between them.

use glam::Vec2;

/// A distribution over the unit square whose density is bilinear between the nodes of a grid.
///
/// A patch is drawn by its row, then by its column (so that neighbouring random numbers give neighbouring points), and the
/// point within the patch by inverting the bilinear density.
#[derive(Clone, Debug)]
pub struct PiecewiseBilinear {
    columns: usize,
    /// The density at the nodes, row by row.
    density: Vec<f32>,
    /// The probability of all rows of patches before each, and 1.
    rows_before: Vec<f32>,
    /// For each row of patches: the probability within the row of all patches before each, and 1.
    patches_before: Vec<f32>,
}

/// A point drawn from a [`PiecewiseBilinear`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SquarePoint {
    /// Where it is, in \[0, 1\] x \[0, 1\].
    pub position: Vec2,
    /// The density there.
    pub density: f32,
}

impl PiecewiseBilinear {
    /// The distribution proportional to `values` at the nodes of a grid of `columns` columns, row by row; the outer nodes
    /// lie on the square's edges. `None` where this is no distribution: there are not at least two columns and two rows, a
    /// value is negative or not finite, or all are zero.
    pub fn new(mut values: Vec<f32>, columns: usize) -> Option<Self> {
        let rows = values.len().checked_div(columns)?;
        let is_grid = columns >= 2 && rows >= 2 && values.len() == rows * columns;
        if !is_grid || !values.iter().all(|value| (0.0..=f32::MAX).contains(value)) {
            return None;
        }
        let mut rows_before = vec![0.0];
        let mut patches_before = Vec::with_capacity((rows - 1) * columns);
        let mut total = 0.0;
        for pair in values.chunks_exact(columns).collect::<Vec<_>>().windows(2) {
            let mut sums = vec![0.0];
            let mut sum = 0.0;
            for column in 0..columns - 1 {
                let corners = [
                    pair[0][column],
                    pair[0][column + 1],
                    pair[1][column],
                    pair[1][column + 1],
                ];
                sum += corners
                    .iter()
                    .map(|&value| 0.25 * f64::from(value))
                    .sum::<f64>();
                sums.push(sum);
            }
            // A row of zeros is never drawn.
            let scale = if sum > 0.0 { 1.0 / sum } else { 0.0 };
            patches_before.extend(sums.iter().map(|before| (before * scale) as f32));
            total += sum;
            rows_before.push(total);
        }
        if total == 0.0 {
            return None;
        }
        let patches = ((columns - 1) * (rows - 1)) as f64;
        for value in &mut values {
            *value = (f64::from(*value) * (patches / total)) as f32;
        }
        Some(Self {
            columns,
            density: values,
            rows_before: rows_before
                .iter()
                .map(|before| (before / total) as f32)
                .collect(),
            patches_before,
        })
    }

    /// Draws a point from uniform numbers in [0, 1). Its density can be 0 where these are 0.
    #[inline]
    pub fn sample(&self, u: [f32; 2]) -> SquarePoint {
        let row = Interval::holding(u[1], &self.rows_before);
        let patches = &self.patches_before[row.index * self.columns..][..self.columns];
        let column = Interval::holding(u[0], patches);
        let [v00, v10, v01, v11] = self.corners(column.index, row.index);
        let down = sample_linear(v00 + v10, v01 + v11, row.remainder);
        let (left, right) = (v00 + down * (v01 - v00), v10 + down * (v11 - v10));
        let across = sample_linear(left, right, column.remainder);
        let rows = self.rows_before.len() - 1;
        SquarePoint {
            position: Vec2::new(
                (column.index as f32 + across) / (self.columns - 1) as f32,
                (row.index as f32 + down) / rows as f32,
            ),
            density: left + across * (right - left),
        }
    }

    /// The density with which [`Self::sample`] draws `position`.
    #[inline]
    pub fn density(&self, position: Vec2) -> f32 {
        let patches = [self.columns - 1, self.rows_before.len() - 1];
        let at = |coordinate: f32, patches: usize| {
            let scaled = coordinate.clamp(0.0, 1.0) * patches as f32;
            let index = (scaled as usize).min(patches - 1);
            (index, scaled - index as f32)
        };
        let (column, across) = at(position.x, patches[0]);
        let (row, down) = at(position.y, patches[1]);
        let [v00, v10, v01, v11] = self.corners(column, row);
        let (left, right) = (v00 + down * (v01 - v00), v10 + down * (v11 - v10));
        left + across * (right - left)
    }

    #[inline]
    fn corners(&self, column: usize, row: usize) -> [f32; 4] {
        let upper = row * self.columns + column;
        let lower = upper + self.columns;
        [upper, upper + 1, lower, lower + 1].map(|node| self.density[node])
    }
}

/// An interval between two entries of a list of cumulated probabilities.
struct Interval {
    index: usize,
    /// What is left of the uniform number, itself uniform in [0, 1).
    remainder: f32,
}

impl Interval {
    /// The interval that holds `u`, which is below 1; it is not empty.
    #[inline]
    fn holding(u: f32, before: &[f32]) -> Self {
        let index = before.partition_point(|&before| before <= u);
        let index = index.clamp(1, before.len() - 1) - 1;
        let (start, end) = (before[index], before[index + 1]);
        let remainder = (u - start) / (end - start);
        Self {
            index,
            remainder: remainder.clamp(0.0, 1.0 - f32::EPSILON),
        }
    }
}

/// The quantile `u` of the density on [0, 1] that is proportional to `start` at 0 and to `end` at 1, and linear between.
#[inline]
fn sample_linear(start: f32, end: f32, u: f32) -> f32 {
    // The root of the quadratic equation in the form that does not cancel.
    let root = (start * start + u * (end * end - start * start))
        .max(0.0)
        .sqrt();
    if start + root > 0.0 {
        (u * (start + end) / (start + root)).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{RandomStream, StreamKey};
    use proptest::prelude::*;
    use statrs::distribution::{ChiSquared, ContinuousCDF};

    const KEY: StreamKey = StreamKey {
        seed: 5,
        tile: 0,
        pass: 0,
    };

    /// The p-value of the chi-square test of points against the integrated density, over 20 x 20 cells.
    fn p_value(distribution: &PiecewiseBilinear) -> f64 {
        const CELLS: usize = 20;
        const DRAWS: usize = 200_000;
        const FINE: usize = 12;
        let mut random = RandomStream::new(KEY);
        let mut counts = [0.0; CELLS * CELLS];
        for _ in 0..DRAWS {
            let point = distribution.sample(random.uniform_2d());
            let density = distribution.density(point.position);
            assert!(
                (point.density - density).abs() <= 1e-3 * (1.0 + density),
                "{point:?}: {density}"
            );
            let cell = (point.position * CELLS as f32).min(Vec2::splat(CELLS as f32 - 0.5));
            counts[cell.y as usize * CELLS + cell.x as usize] += 1.0;
        }
        let (mut statistic, mut freedom, mut rest) = (0.0, -1.0, [0.0, 0.0]);
        for (cell, &count) in counts.iter().enumerate() {
            let mut expected = 0.0;
            for step in 0..FINE * FINE {
                let fine = |cell: usize, step: usize| {
                    (cell as f32 + (step as f32 + 0.5) / FINE as f32) / CELLS as f32
                };
                let position = Vec2::new(
                    fine(cell % CELLS, step % FINE),
                    fine(cell / CELLS, step / FINE),
                );
                expected += f64::from(distribution.density(position));
            }
            expected *= DRAWS as f64 / ((CELLS * CELLS * FINE * FINE) as f64);
            // Cells with few points are taken together.
            if expected < 8.0 {
                rest = [rest[0] + count, rest[1] + expected];
            } else {
                statistic += (count - expected) * (count - expected) / expected;
                freedom += 1.0;
            }
        }
        if rest[1] >= 8.0 {
            statistic += (rest[0] - rest[1]) * (rest[0] - rest[1]) / rest[1];
            freedom += 1.0;
        } else {
            assert!(rest[0] <= 40.0, "{rest:?}");
        }
        ChiSquared::new(freedom).unwrap().sf(statistic)
    }

    #[test]
    fn points_follow_the_density() {
        let mut random = RandomStream::new(StreamKey { tile: 1, ..KEY });
        let rough: Vec<f32> = (0..6 * 11).map(|_| random.uniform().powi(4)).collect();
        let mut lamp = vec![0.0; 6 * 11];
        (lamp[20], lamp[21], lamp[64]) = (1000.0, 10.0, 3.0);
        let mut edges = vec![0.0; 6 * 11];
        (edges[0], edges[65]) = (1.0, 2.0);
        for (columns, values) in [
            (2, vec![1.0, 1.0, 1.0, 1.0]),
            (2, vec![0.0, 1.0, 0.0, 3.0]),
            (11, rough.clone()),
            (6, rough),
            (11, lamp),
            (11, edges),
        ] {
            let distribution = PiecewiseBilinear::new(values.clone(), columns).unwrap();
            let p = p_value(&distribution);
            assert!(p > 1e-4, "{columns} columns, {values:?}: p = {p}");
        }
    }

    /// `mi.Hierarchical2D0(values).eval([x, y])`
    #[test]
    fn densities_are_mitsubas() {
        let values = vec![1.0, 2.0, 0.5, 0.0, 3.0, 1.0, 4.0, 0.0, 2.0];
        let distribution = PiecewiseBilinear::new(values, 3).unwrap();
        for (x, y, expected) in [
            (0.1, 0.2, 0.602353),
            (0.5, 0.5, 1.882353),
            (0.7, 0.3, 1.179608),
            (0.9, 0.95, 0.991373),
        ] {
            let density = distribution.density(Vec2::new(x, y));
            assert!((density - expected).abs() < 1e-5, "({x}, {y}): {density}");
        }
    }
    #[test]
    fn what_is_no_distribution_is_refused() {
        for (values, columns) in [
            (vec![], 0),
            (vec![1.0; 4], 0),
            (vec![1.0; 4], 1),
            (vec![1.0; 4], 4),
            (vec![1.0; 5], 2),
            (vec![0.0; 4], 2),
            (vec![1.0, -1.0, 1.0, 1.0], 2),
            (vec![1.0, f32::NAN, 1.0, 1.0], 2),
            (vec![1.0, f32::INFINITY, 1.0, 1.0], 2),
        ] {
            assert!(
                PiecewiseBilinear::new(values.clone(), columns).is_none(),
                "{values:?}"
            );
        }
    }

    proptest! {
        #[test]
        fn points_lie_where_the_density_is_positive(
            values in prop::collection::vec(prop_oneof![Just(0.0_f32), 0.0_f32..1.0, 1e-30_f32..1e30], 12),
            u in prop_oneof![Just(0.0_f32), 0.0_f32..1.0, Just(1.0 - f32::EPSILON / 2.0)],
            v in prop_oneof![Just(0.0_f32), 0.0_f32..1.0, Just(1.0 - f32::EPSILON / 2.0)],
        ) {
            if let Some(distribution) = PiecewiseBilinear::new(values, 4) {
                let point = distribution.sample([u, v]);
                prop_assert!(point.density >= 0.0 && point.density.is_finite(), "{point:?}");
                prop_assert!(point.position.min_element() >= 0.0 && point.position.max_element() <= 1.0);
            }
        }
    }
}
