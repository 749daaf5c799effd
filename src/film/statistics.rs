//! What a pixel knows: its mean and how far to trust it.

use serde::{Deserialize, Serialize};

use super::Accumulator;

/// What the samples of one pixel add up to, in linear sRGB.
///
/// The samples arrive in *units*, each of which is right on average whatever those before it were: one camera path, or, where a strategy
/// resamples several camera paths together, all samples that one population had in the pixel. Their variance shows in how far each
/// unit is from the mean of those before it. The noise of units need not be alike: a render that learns has better ones later.
///
/// A sample has a *weight*: 1, or less where much noise is expected, or where there are more samples than elsewhere. Nothing random may decide what the samples of
/// a pass weigh together.
///
/// `A` are the numbers of the sums. All other arithmetic is in double precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PixelStatistics<A = f64> {
    /// Number of camera paths.
    pub samples: u64,
    /// Number of units.
    pub units: u64,
    /// The weight of all samples together.
    pub weight: f64,
    /// The weighted sum.
    sum: [A; 3],
    /// The estimated variance of the weighted sum.
    variance: [A; 3],
}

impl<A: Accumulator> PixelStatistics<A> {
    /// Adds a unit of `samples` camera paths, at least 1, each of `weight` (positive), whose values add up to `sum`.
    ///
    /// With samples of the weight W and the mean m, and new ones of the weight w and the mean x, (x - m)^2 is on average Var\[x\] + Var\[m\].
    /// So the variance T of the weighted sum grows without bias to T + w^2 ((x - m)^2 - T / W^2), whatever the variances. For units of one size
    /// that is Welford's (1962) way to the usual estimate. Of two units no more is known than their distance, and of one that weighs more than all before it
    /// hardly more: there T is w W (x - m)^2, as for samples of equal variance.
    #[inline]
    pub fn add_unit(&mut self, samples: u32, weight: f64, sum: [f64; 3]) {
        let [before, new] = [self.weight, weight * f64::from(samples)];
        let is_large = self.units < 2 || new > before;
        // Nothing is before the first unit: its distance is finite, and does not count.
        let per_before = if before > 0.0 { 1.0 / before } else { 0.0 };
        let share = new * per_before;
        let (kept, counts) = if is_large {
            (0.0, new * before)
        } else {
            (1.0 - share * share, new * new)
        };
        let per_sample = 1.0 / f64::from(samples);
        for (channel, value) in sum.into_iter().enumerate() {
            let distance = value * per_sample - self.sum[channel].total() * per_before;
            let variance = kept * self.variance[channel].total() + counts * distance * distance;
            self.variance[channel] = A::default();
            self.variance[channel].add(variance);
            self.sum[channel].add(weight * value);
        }
        self.weight += new;
        self.samples += u64::from(samples);
        self.units += 1;
    }

    /// The weighted mean of the samples; black while there are none.
    pub fn mean(&self) -> [f64; 3] {
        self.sum.map(|sum| {
            if self.samples == 0 {
                0.0
            } else {
                sum.total() / self.weight
            }
        })
    }

    /// The estimated variance of [`Self::mean`], or `None` with fewer than two units.
    pub fn variance_of_mean(&self) -> Option<[f64; 3]> {
        let squared = self.weight * self.weight;
        (self.units > 1).then(|| self.variance.map(|variance| variance.total() / squared))
    }

    /// The same with sums in double precision, into which those of any precision fit.
    pub fn in_double(&self) -> PixelStatistics {
        PixelStatistics {
            samples: self.samples,
            units: self.units,
            weight: self.weight,
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
                pixel.add_unit(samples, 1.0, [(0..samples).map(sample).sum(); 3]);
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
            .for_each(|&value| pixel.add_unit(5, 1.0, [5.0 * value; 3]));
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let usual = squares / (count - 1.0) / count;
        assert!((pixel.variance_of_mean().unwrap()[2] / usual - 1.0).abs() < 1e-12);
    }

    #[test]
    fn samples_of_less_weight_count_less() {
        let mut pixel = PixelStatistics::<f64>::default();
        pixel.add_unit(2, 0.5, [2.0 * 3.0; 3]);
        pixel.add_unit(3, 1.0, [3.0 * 7.0; 3]);
        assert_eq!((pixel.samples, pixel.weight), (5, 4.0));
        assert_eq!(pixel.mean(), [(3.0 + 3.0 * 7.0) / 4.0; 3]);
        // With samples of the variance V, V (2 / 4 + 3) / 16 is that of the mean, and V (1 / 2 + 1 / 3) that of the distance 4 of two units; but weights say
        // that the former have twice that variance: then it is (1 + 3) / 16 and 1 + 1 / 3.
        let variance = 16.0 / (4.0 / 3.0) * 4.0 / 16.0;
        assert_eq!(pixel.variance_of_mean(), Some([variance; 3]));
    }

    #[test]
    fn without_samples_there_is_no_variance() {
        let mut pixel = PixelStatistics::<f64>::default();
        assert_eq!(pixel.mean(), [0.0; 3]);
        assert_eq!(pixel.variance_of_mean(), None);
        pixel.add_unit(4, 1.0, [4.0; 3]);
        assert_eq!((pixel.mean(), pixel.variance_of_mean()), ([1.0; 3], None));
    }
}
