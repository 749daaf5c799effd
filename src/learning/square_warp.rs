//! A warp of the unit square: importance sampling by a histogram, without losing what is even about the points.
//!
//! Directions are maps of points (u, v) of the unit square, so a density h over the square that has the mean 1 multiplies the density
//! of each direction. Points are warped by the row, then the column: neighbours stay neighbours, and points that were spread evenly are
//! spread evenly over h. Because h is mixed with a uniform part it is bounded from below, and so are weights from above.

use serde::{Deserialize, Serialize};

/// Rows and columns.
pub const SIDE: usize = 8;

/// The share of a histogram that is well known; the rest is uniform.
const TRUST: f32 = 0.7;

/// With so many observations in a bin, half of that share is trusted to its histogram. The weights 1/h of a long path multiply: where h is noise
/// alone, so does the noise.
const HALF_KNOWN: f32 = 4.0;

/// The variance in a bin is taken to be this part of the second moment at least: few observations may have been alike by chance.
const LEAST_VARIANCE: f32 = 0.1;

/// What the heights of a distribution add up to.
const WHOLE: u32 = 1 << 16;

/// A part of the unit square: row and column.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Bin(u8);

impl Bin {
    /// The one in which the point (u, v) lies.
    #[inline(always)]
    pub fn of([u, v]: [f32; 2]) -> Self {
        Self((SIDE * index(u) + index(v)) as u8)
    }

    /// Row and column.
    #[inline(always)]
    pub fn place(self) -> [usize; 2] {
        let place = usize::from(self.0);
        [place / SIDE % SIDE, place % SIDE]
    }
}

#[inline(always)]
fn index(u: f32) -> usize {
    // Conversion saturates: what is no number, or below 0, is in the first.
    ((u * SIDE as f32) as i32).clamp(0, SIDE as i32 - 1) as usize
}

/// A density over the unit square, constant in each [`Bin`].
///
/// Its numbers are as small as they can be, for every vertex looks at those of another place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[repr(align(16))]
pub struct SquareWarp {
    rows: Steps,
    columns: [Steps; SIDE],
}

impl SquareWarp {
    /// The same density everywhere.
    pub const UNIFORM: Self = Self {
        rows: Steps::EVEN,
        columns: [Steps::EVEN; SIDE],
    };

    /// The density that is in proportion to `values`, not negative, but for its uniform part: the smaller, the more `observations` of
    /// all bins together the values come from.
    pub fn new(values: &[[f32; SIDE]; SIDE], observations: f32) -> Self {
        let bins = (SIDE * SIDE) as f32;
        let trust = TRUST * observations / (observations + HALF_KNOWN * bins);
        let mean = values.iter().flatten().sum::<f32>() / bins;
        let scale = trust / mean;
        // Sums of bright light can be infinite, and where all is dark their reciprocal is.
        if !(mean < f32::INFINITY && scale < f32::INFINITY) {
            return Self::UNIFORM;
        }
        let density = values.map(|row| row.map(|value| 1.0 - trust + scale * value));
        Self {
            rows: Steps::new(&density.map(|row| row.iter().sum::<f32>())),
            columns: density.map(|row| Steps::new(&row)),
        }
    }

    /// Where the point (u, v) of [0, 1)^2 goes, and the density there.
    #[inline(always)]
    pub fn warp(&self, [u, v]: [f32; 2]) -> ([f32; 2], f32) {
        let (row, u) = self.rows.invert(u);
        let (column, v) = self.columns[row].invert(v);
        ([u, v], self.product(row, column))
    }

    /// The density in a bin: its mean over all is 1.
    #[inline(always)]
    pub fn density(&self, bin: Bin) -> f32 {
        let [row, column] = bin.place();
        self.product(row, column)
    }

    /// The variance of what is collected with warped points, in parts of that with even points, where `mean` and `square` are the first two moments
    /// of what arrives in each bin.
    ///
    /// It is that within bins: points that are spread evenly know most of what differs between them.
    pub(super) fn variance_left(
        &self,
        mean: &[[f32; SIDE]; SIDE],
        square: &[[f32; SIDE]; SIDE],
    ) -> f32 {
        let (mut even, mut warped) = (0.0, 0.0);
        for (row, (mean, square)) in mean.iter().zip(square).enumerate() {
            for (column, (&mean, &square)) in mean.iter().zip(square).enumerate() {
                let variance = (square - mean * mean).max(LEAST_VARIANCE * square);
                even += variance;
                warped += variance / self.product(row, column);
            }
        }
        warped / even
    }

    #[inline(always)]
    fn product(&self, row: usize, column: usize) -> f32 {
        const EVEN: f32 = (WHOLE / SIDE as u32) as f32;
        let heights = self.rows.height(row) * self.columns[row].height(column);
        heights * (1.0 / (EVEN * EVEN))
    }
}

/// A distribution over [0, 1), constant over each of [`SIDE`] equal parts: the sum of all parts before each, of [`WHOLE`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Steps([u16; SIDE]);

impl Steps {
    const EVEN: Self = {
        let mut before = [0; SIDE];
        let mut part = 0;
        while part < SIDE {
            before[part] = (part * WHOLE as usize / SIDE) as u16;
            part += 1;
        }
        Self(before)
    };

    /// In proportion to `values`, none of which is less than a thousandth of their sum.
    fn new(values: &[f32; SIDE]) -> Self {
        let scale = WHOLE as f32 / values.iter().sum::<f32>();
        let mut sum = 0.0;
        Self(values.map(|value| {
            let before = sum * scale;
            sum += value;
            before.round() as u16
        }))
    }

    #[inline(always)]
    fn height(&self, part: usize) -> f32 {
        // Behind the last part comes the first, at 0: the whole, which has one digit too many. No part is as high as that.
        let end = self.0[(part + 1) % SIDE];
        f32::from(end.wrapping_sub(self.0[part]))
    }

    /// The part on which the inverse of the distribution is at `u`, and where in [0, 1).
    #[inline(always)]
    fn invert(&self, u: f32) -> (usize, f32) {
        let target = u * WHOLE as f32;
        // Conversion saturates.
        let whole = target as u16;
        let begun: u16 = self
            .0
            .iter()
            .map(|&before| u16::from(before <= whole))
            .sum();
        // Nothing is before the first.
        let part = usize::from(begun - 1) % SIDE;
        let inside = (target - f32::from(self.0[part])) / self.height(part);
        let place = (part as f32 + inside) * (1.0 / SIDE as f32);
        // Rounding must not carry it into the next part.
        let end = ((part + 1) as f32 * (1.0 / SIDE as f32)).next_down();
        (part, place.clamp(0.0, end))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn values() -> impl Strategy<Value = [[f32; SIDE]; SIDE]> {
        let value = prop_oneof![Just(0.0_f32), 0.0..1.0_f32, 1.0..1e6_f32];
        let row = proptest::array::uniform8(value);
        proptest::array::uniform8(row)
    }

    proptest! {
        #[test]
        fn the_density_has_mean_one_and_is_bounded_from_below(values in values()) {
            let warp = SquareWarp::new(&values, 1e6);
            let bins = (0..64).map(|place| warp.density(Bin(place)));
            let mean: f32 = bins.clone().sum::<f32>() / 64.0;
            prop_assert!((mean - 1.0).abs() < 1e-4, "{mean}");
            for density in bins {
                prop_assert!(density > 0.29, "{density}");
            }
        }

        #[test]
        fn points_go_where_the_density_says(values in values(), u in 0.0..1.0_f32, v in 0.0..1.0_f32) {
            let warp = SquareWarp::new(&values, 1e6);
            let (point, density) = warp.warp([u, v]);
            prop_assert!(point.iter().all(|u| (0.0..1.0).contains(u)));
            prop_assert_eq!(density, warp.density(Bin::of(point)));
        }
    }

    /// Points of a fine lattice, warped, lie in each bin as its density says.
    #[test]
    fn warped_points_have_the_density() {
        let mut values = [[0.0; SIDE]; SIDE];
        values[2][5] = 10.0;
        values[2][6] = 1.0;
        values[7][0] = 3.0;
        let warp = SquareWarp::new(&values, 1e6);
        const N: u32 = 1 << 20;
        let mut counts = [0.0; 64];
        for i in 0..N {
            let along = (f64::from(i) + 0.5) / f64::from(N);
            let across = f64::from(i) * 0.618_033_988_749_894_9 % 1.0;
            let point = [along, across].map(|u| u as f32);
            counts[usize::from(Bin::of(warp.warp(point).0).0)] += 1.0;
        }
        for (place, count) in (0..).zip(counts) {
            let share = count / N as f32 * 64.0;
            let density = warp.density(Bin(place));
            assert!(
                (share - density).abs() < 0.02 * density,
                "{place}: {share} {density}"
            );
        }
        assert!(warp.density(Bin::of([2.5 / 8.0, 5.5 / 8.0])) > 20.0);
    }

    #[test]
    fn the_less_was_observed_the_less_is_trusted() {
        let mut values = [[0.0; SIDE]; SIDE];
        values[3][3] = 1.0;
        let peak = |observations| {
            let warp = SquareWarp::new(&values, observations);
            warp.density(Bin::of([3.5 / 8.0; 2]))
        };
        assert_eq!(peak(0.0), 1.0);
        assert!((peak(HALF_KNOWN * 64.0) - 1.0 - 0.5 * TRUST * 63.0).abs() < 1e-3);
        assert!(peak(1e9) > 44.0);
    }

    /// Points that are drawn in proportion to a deviation leave the square of its mean, of the mean of its square.
    #[test]
    fn variance_is_left_where_points_are_rare() {
        let mut deviation = [[1.0; SIDE]; SIDE];
        deviation[3][3] = 64.0;
        let square = deviation.map(|row| row.map(|deviation| deviation * deviation));
        let mean = [[0.0; SIDE]; SIDE];
        let even = SquareWarp::UNIFORM.variance_left(&mean, &square);
        assert!((even - 1.0).abs() < 1e-6, "{even}");
        let density = |value: f32| 1.0 - TRUST + TRUST * value * 64.0 / 127.0;
        let expected = (4096.0 / density(64.0) + 63.0 / density(1.0)) / (4096.0 + 63.0);
        let left = SquareWarp::new(&deviation, 1e9).variance_left(&mean, &square);
        assert!(
            (left - expected).abs() < 1e-3 * expected,
            "{left} {expected}"
        );
        let nothing = [[0.0; SIDE]; SIDE];
        assert!(SquareWarp::UNIFORM.variance_left(&mean, &nothing).is_nan());
    }

    #[test]
    fn nothing_learned_is_uniform() {
        for value in [0.0, 1e-40, f32::MAX, f32::INFINITY, f32::NAN] {
            let mut values = [[0.0; SIDE]; SIDE];
            values[3] = [value; SIDE];
            values[4] = [value; SIDE];
            let warp = SquareWarp::new(&values, 1e6);
            let (point, density) = warp.warp([0.3, 0.9]);
            assert!((density - 1.0).abs() < 1e-6, "{value}: {density}");
            assert!((point[0] - 0.3).abs() < 1e-6 && (point[1] - 0.9).abs() < 1e-6);
        }
    }
}
