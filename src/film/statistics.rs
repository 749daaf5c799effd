//! What a pixel knows: its mean and how far to trust it.

use serde::{Deserialize, Serialize};

use super::Accumulator;

/// What the samples of one pixel add up to, in linear sRGB.
///
/// The samples arrive in *units*, none of which has been influenced by the noise of another: one camera path, or, where a strategy
/// resamples several camera paths together, all samples that one population had in the pixel. The mean of the pixel is that of the
/// units, each weighted by its number of samples; its variance shows in how far each unit is from the mean of those before it.
/// The noise of units need not be alike: a render that learns has better ones later.
///
/// `A` are the numbers of the sums. All other arithmetic is in double precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PixelStatistics<A = f64> {
    /// Number of camera paths.
    pub samples: u64,
    /// Number of units.
    pub units: u64,
    sum: [A; 3],
    /// The estimated variance of the sum.
    variance: [A; 3],
}

impl<A: Accumulator> PixelStatistics<A> {
    /// Adds a unit of `samples` camera paths, at least 1, whose values add up to `sum`.
    ///
    /// With N samples of mean m and n new ones of mean x, (x - m)^2 is on average Var\[x\] + Var\[m\]. So the variance T of the sum grows
    /// without bias to T + n^2 ((x - m)^2 - T / N^2), whatever the variances. For units of one size that is Welford's (1962) way to the usual
    /// estimate. Of two units no more is known than their distance, and of a unit larger than all before it hardly more:
    /// there T is n N (x - m)^2, as for samples of equal variance.
    #[inline]
    pub fn add_unit(&mut self, samples: u32, sum: [f64; 3]) {
        let [before, new] = [self.samples as f64, f64::from(samples)];
        let is_large = self.units < 2 || new > before;
        // Nothing is before the first unit: its weight is 0 and its distance finite.
        let [per_before, per_new] = [1.0 / before.max(1.0), 1.0 / new];
        let share = new * per_before;
        let (kept, weight) = if is_large {
            (0.0, new * before)
        } else {
            (1.0 - share * share, new * new)
        };
        for (channel, value) in sum.into_iter().enumerate() {
            let distance = value * per_new - self.sum[channel].total() * per_before;
            let variance = kept * self.variance[channel].total() + weight * distance * distance;
            self.variance[channel] = A::default();
            self.variance[channel].add(variance);
            self.sum[channel].add(value);
        }
        self.samples += u64::from(samples);
        self.units += 1;
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
        let squared = (self.samples as f64).powi(2);
        (self.units > 1).then(|| self.variance.map(|variance| variance.total() / squared))
    }

    /// The same with sums in double precision, into which those of any precision fit.
    pub fn in_double(&self) -> PixelStatistics {
        PixelStatistics {
            samples: self.samples,
            units: self.units,
            sum: self.sum.map(A::total),
            variance: self.variance.map(A::total),
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
        assert!((believed / want - 1.0).abs() < 0.06, "{}", believed / want);
    }

    #[test]
    fn of_units_of_one_size_it_is_the_usual_variance() {
        let values = [3.0, 1.0, 4.0, 1.0, 5.0, 9.0, 2.0];
        let mut pixel = PixelStatistics::<f64>::default();
        values
            .iter()
            .for_each(|&value| pixel.add_unit(5, [5.0 * value; 3]));
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let usual = squares / (count - 1.0) / count;
        assert!((pixel.variance_of_mean().unwrap()[2] / usual - 1.0).abs() < 1e-12);
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
