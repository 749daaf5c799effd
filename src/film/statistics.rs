//! What a pixel knows: its mean and how far to trust it.

use serde::{Deserialize, Serialize};

use super::Accumulator;

/// Sums over the samples of one pixel, in linear sRGB.
///
/// The samples arrive in *units* that know nothing of each other's noise: one camera path, or, where a strategy resamples
/// several camera paths together, all samples that one population had in the pixel. The mean of all is that of the units, each
/// weighted by its number of samples, and its variance is estimated from how far the units are from it. What their noise is
/// need not be known, nor be the same: a render that learns may have better units later.
///
/// `A` are the numbers of the sums. All other arithmetic is in double precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PixelStatistics<A = f64> {
    /// Number of camera paths.
    pub samples: u64,
    /// Sum over units of their number of samples squared: equal to `samples` where each is a unit, to its square where there is only one unit.
    pub squared_sizes: u64,
    sum: [A; 3],
    /// Sum over units of the sum of the unit times its number of samples.
    sized_sum: [A; 3],
    /// Sum over units of the squared sum of the unit.
    squares: [A; 3],
}

impl<A: Accumulator> PixelStatistics<A> {
    /// Adds a unit of `samples` camera paths whose values add up to `sum`.
    #[inline]
    pub fn add_unit(&mut self, samples: u32, sum: [f64; 3]) {
        let samples = u64::from(samples);
        self.samples += samples;
        self.squared_sizes = self.squared_sizes.saturating_add(samples * samples);
        for (channel, value) in sum.into_iter().enumerate() {
            self.sum[channel].add(value);
            self.sized_sum[channel].add(value * samples as f64);
            self.squares[channel].add(value * value);
        }
    }

    /// The mean of the samples; black while there are none.
    pub fn mean(&self) -> [f64; 3] {
        self.sum.map(|sum| {
            if self.samples == 0 {
                0.0
            } else {
                sum.total() / self.samples as f64
            }
        })
    }

    /// The estimated variance of [`Self::mean`], or `None` with fewer than two units.
    ///
    /// With units of n samples and mean x, N samples and mean m in all: the sum of n^2 (x - m)^2 over N^2 - sum of n^2 (that of
    /// White 1980 for samples of different variance, with the divisor that makes it exact where they have the same).
    pub fn variance_of_mean(&self) -> Option<[f64; 3]> {
        let samples = self.samples as f64;
        let squared_sizes = self.squared_sizes as f64;
        let divisor = samples * samples - squared_sizes;
        if divisor <= 0.0 {
            return None;
        }
        let mut variance = [0.0; 3];
        for (channel, value) in variance.iter_mut().enumerate() {
            let mean = self.sum[channel].total() / samples;
            let across = self.sized_sum[channel].total();
            let squares = self.squares[channel].total();
            let deviation = squares - mean * (2.0 * across - mean * squared_sizes);
            *value = deviation.max(0.0) / divisor;
        }
        Some(variance)
    }

    /// The same with sums in double precision, into which those of any precision fit.
    pub fn in_double(&self) -> PixelStatistics {
        PixelStatistics {
            samples: self.samples,
            squared_sizes: self.squared_sizes,
            sum: self.sum.map(A::total),
            sized_sum: self.sized_sum.map(A::total),
            squares: self.squares.map(A::total),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{RandomStream, StreamKey};

    /// The mean over many pixels of units of so many samples: the squared error of their mean, and the variance that they believe in.
    /// A sample is uniform around 1/2, `noise(unit)` wide.
    fn seen_and_believed(units: &[u32], noise: impl Fn(usize) -> f64) -> [f64; 2] {
        let (mut seen, mut believed) = (0.0, 0.0);
        let pixels = 8000;
        for tile in 0..pixels {
            let mut random = RandomStream::new(StreamKey {
                seed: 5,
                tile,
                pass: 0,
            });
            let mut pixel = PixelStatistics::<f64>::default();
            for (unit, &samples) in units.iter().enumerate() {
                let sample = |_| 0.5 + noise(unit) * (random.uniform_f64() - 0.5);
                pixel.add_unit(samples, [(0..samples).map(sample).sum(); 3]);
            }
            assert_eq!(pixel.samples, u64::from(units.iter().sum::<u32>()));
            seen += (pixel.mean()[1] - 0.5).powi(2) / f64::from(pixels);
            believed += pixel.variance_of_mean().unwrap()[1] / f64::from(pixels);
        }
        [seen, believed]
    }

    #[test]
    fn the_variance_is_right_for_units_of_unequal_size() {
        let [seen, believed] = seen_and_believed(&[1, 1, 2, 4, 8, 16, 16, 3], |_| 1.0);
        let want = 1.0 / 12.0 / 51.0;
        assert!((seen / want - 1.0).abs() < 0.06, "{}", seen / want);
        assert!((believed / want - 1.0).abs() < 0.04, "{}", believed / want);
    }

    #[test]
    fn the_variance_is_right_for_units_of_unequal_noise() {
        let units = [1, 1, 2, 4, 8, 16, 16, 16, 16, 16, 16];
        let [seen, believed] = seen_and_believed(&units, |unit| if unit < 5 { 4.0 } else { 1.0 });
        // Samples in the first five units have sixteen times the variance of those in the others.
        let want = (16.0 * 16.0 + 96.0) / 12.0 / (112.0 * 112.0);
        assert!((seen / want - 1.0).abs() < 0.06, "{}", seen / want);
        // Of few units, with a divisor for equal noise: 1.13. With their deviations weighted by n instead of n^2 it would be 2.6.
        assert!(
            (1.05..1.2).contains(&(believed / want)),
            "{}",
            believed / want
        );
    }

    #[test]
    fn without_samples_there_is_no_variance() {
        let mut pixel = PixelStatistics::<f64>::default();
        assert_eq!(pixel.mean(), [0.0; 3]);
        assert_eq!(pixel.variance_of_mean(), None);
        pixel.add_unit(4, [4.0; 3]);
        assert_eq!((pixel.mean(), pixel.variance_of_mean()), ([1.0; 3], None));
    }
}
