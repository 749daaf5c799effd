//! What a pixel knows: its mean and how far to trust it.

use serde::{Deserialize, Serialize};

use super::Accumulator;

/// Sums over the samples of one pixel, in linear sRGB.
///
/// The samples arrive in *units* that are independent of each other: one camera path, or, where a strategy resamples
/// several camera paths together, all samples that one population had in the pixel. A unit of n samples has n times
/// less variance than a sample, whatever the correlation inside of it; that gives the variance of the mean.
///
/// `A` are the numbers of the sums. All other arithmetic is in double precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PixelStatistics<A = f64> {
    /// Number of camera paths.
    pub samples: u64,
    /// Number of independent units.
    pub units: u64,
    sum: [A; 3],
    /// Sum over units of (sum of the unit)^2 / (samples of the unit).
    scaled_squares: [A; 3],
}

impl<A: Accumulator> PixelStatistics<A> {
    /// Adds a unit of `samples` camera paths whose values add up to `sum`.
    #[inline]
    pub fn add_unit(&mut self, samples: u32, sum: [f64; 3]) {
        self.samples += u64::from(samples);
        self.units += 1;
        for (channel, value) in sum.into_iter().enumerate() {
            self.sum[channel].add(value);
            self.scaled_squares[channel].add(value * value / f64::from(samples));
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
    pub fn variance_of_mean(&self) -> Option<[f64; 3]> {
        if self.units < 2 {
            return None;
        }
        let samples = self.samples as f64;
        let mut variance = [0.0; 3];
        for (channel, value) in variance.iter_mut().enumerate() {
            let mean = self.sum[channel].total() / samples;
            let squares = self.scaled_squares[channel].total();
            let per_sample = (squares - samples * mean * mean) / (self.units - 1) as f64;
            *value = per_sample.max(0.0) / samples;
        }
        Some(variance)
    }

    /// The same with sums in double precision, into which those of any precision fit.
    pub fn in_double(&self) -> PixelStatistics {
        PixelStatistics {
            samples: self.samples,
            units: self.units,
            sum: self.sum.map(A::total),
            scaled_squares: self.scaled_squares.map(A::total),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::{RandomStream, StreamKey};

    #[test]
    fn mean_and_variance_are_right_for_units_of_unequal_size() {
        // Samples uniform in [0, 1): variance 1/12, whatever the units.
        let (mut mean, mut squares, mut variance) = (0.0, 0.0, 0.0);
        let runs = 4000;
        for run in 0..runs {
            let mut random = RandomStream::new(StreamKey {
                seed: 5,
                tile: run,
                pass: 0,
            });
            let mut pixel = PixelStatistics::<f64>::default();
            for samples in [1, 1, 2, 4, 8, 16, 16, 3] {
                let sum: f64 = (0..samples).map(|_| random.uniform_f64()).sum();
                pixel.add_unit(samples, [sum; 3]);
            }
            assert_eq!(pixel.samples, 51);
            mean += pixel.mean()[1] / f64::from(runs);
            squares += (pixel.mean()[1] - 0.5).powi(2) / f64::from(runs);
            variance += pixel.variance_of_mean().unwrap()[1] / f64::from(runs);
        }
        let want = 1.0 / 12.0 / 51.0;
        assert!((mean - 0.5).abs() < 3e-3, "{mean}");
        assert!((squares / want - 1.0).abs() < 0.1, "{}", squares / want);
        assert!((variance / want - 1.0).abs() < 0.05, "{}", variance / want);
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
