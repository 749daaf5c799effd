//! How far a studentized mean of few repetitions strays: the smoothed, symmetric bootstrap-t.
//!
//! The percentile bootstrap covers 80 % instead of 95 % with four repetitions. The bootstrap-t (Efron and Tibshirani,
//! An Introduction to the Bootstrap, 1993, chapter 12) divides every resampled deviation by its own standard error;
//! its symmetric form (Hall, The Bootstrap and Edgeworth Expansion, 1992, section 3.6) looks at the size of the
//! deviation. Resamples of few values are often all but equal, which makes the ratio explode, so values are resampled
//! from a smoothed distribution: each is moved by a normal deviate of n^(-1/5) times the sample's standard
//! deviation (Polansky and Schucany, Kernel Smoothing to Improve Bootstrap Confidence Intervals, JRSS B 59, 1997).

use crate::sampling::{RandomStream, StreamKey};

/// Resamples of an interval. One more is a multiple of 20, so that the 95 % point is one of them (Davison and Hinkley,
/// Bootstrap Methods and their Application, 1997, section 2.4).
const RESAMPLES: usize = 3999;

/// The rank of the 95 % point among the ascending resamples, from 0.
const RANK: usize = (RESAMPLES + 1) / 20 * 19 - 1;

/// The mean of a sample and its estimated standard error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moments {
    pub(super) mean: f64,
    pub(super) standard_error: f64,
}

impl Moments {
    /// Of two values or more.
    pub(super) fn of(values: &[f64]) -> Self {
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        Self {
            mean,
            standard_error: (squares / (n - 1.0) / n).sqrt(),
        }
    }

    /// The mean's logarithm with its standard error by the delta method; not a number where the mean is negative.
    pub(super) fn log(self) -> Self {
        Self {
            mean: self.mean.ln(),
            standard_error: self.standard_error / self.mean,
        }
    }

    /// The difference from an independent mean, with Welch's standard error.
    pub(super) fn minus(self, other: Self) -> Self {
        Self {
            mean: self.mean - other.mean,
            standard_error: self.standard_error.hypot(other.standard_error),
        }
    }
}

/// Draws resamples of the smoothed distribution of a sample.
pub(super) struct Resampler<'a> {
    values: &'a [f64],
    mean: f64,
    /// Standard deviation of the smoothing noise.
    bandwidth: f64,
}

impl<'a> Resampler<'a> {
    /// Of two values or more.
    pub(super) fn new(values: &'a [f64]) -> Self {
        let n = values.len() as f64;
        let moments = Moments::of(values);
        Self {
            values,
            mean: moments.mean,
            bandwidth: n.powf(-0.2) * moments.standard_error * n.sqrt(),
        }
    }

    /// The moments of one resample of the sample's size.
    pub(super) fn draw(&self, random: &mut Deviates) -> Moments {
        let (mut sum, mut squares) = (0.0, 0.0);
        for _ in self.values {
            let value = self.values[random.index(self.values.len())];
            // Around the mean, so that squares do not cancel.
            let deviation = value - self.mean + self.bandwidth * random.normal();
            sum += deviation;
            squares += deviation * deviation;
        }
        let n = self.values.len() as f64;
        let variance = (squares - sum * sum / n).max(0.0) / (n - 1.0);
        Moments {
            mean: self.mean + sum / n,
            standard_error: (variance / n).sqrt(),
        }
    }
}

/// The size that a studentized deviation exceeds in 5 % of resamples: half the width of the interval in standard
/// errors. `draw` makes one resample's estimate; `centre` is that of the sample.
///
/// Resamples whose estimate is not a number count as infinitely far; the result is infinite where those are more than 5 %.
pub(super) fn critical_value(centre: f64, mut draw: impl FnMut(&mut Deviates) -> Moments) -> f64 {
    let mut random = Deviates::new();
    let mut sizes: Vec<f64> = (0..RESAMPLES)
        .map(|_| {
            let resample = draw(&mut random);
            let size = ((resample.mean - centre) / resample.standard_error).abs();
            if size.is_nan() { f64::INFINITY } else { size }
        })
        .collect();
    *sizes.select_nth_unstable_by(RANK, f64::total_cmp).1
}

/// Random indices and standard normal deviates, the same for every interval.
pub(super) struct Deviates {
    random: RandomStream,
    spare: Option<f64>,
}

impl Deviates {
    fn new() -> Self {
        let key = StreamKey {
            seed: 0x626f_6f74,
            tile: 0,
            pass: 0,
        };
        Self {
            random: RandomStream::new(key),
            spare: None,
        }
    }

    /// A uniform index below `n`.
    fn index(&mut self, n: usize) -> usize {
        ((u64::from(self.random.bits()) * n as u64) >> 32) as usize
    }

    /// A standard normal deviate (Box and Muller 1958).
    pub(super) fn normal(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let radius = (-2.0 * (1.0 - self.random.uniform_f64()).ln()).sqrt();
        let (sin, cos) = (std::f64::consts::TAU * self.random.uniform_f64()).sin_cos();
        self.spare = Some(radius * sin);
        radius * cos
    }
}
