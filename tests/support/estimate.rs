//! Means with standard errors, and how surprising the difference of two is.

use statrs::distribution::{ContinuousCDF, Normal, StudentsT};

/// A mean of independent values and how far to trust it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// The estimated variance of the mean.
    pub variance: f64,
    /// How many values it is the mean of, at least 2.
    pub count: usize,
}

impl Estimate {
    /// The estimate from independent values of equal weight.
    pub fn of(values: impl Iterator<Item = f64> + Clone) -> Self {
        let count = values.clone().count();
        assert!(count >= 2, "the spread of {count} values is not known");
        let n = count as f64;
        let mean = values.clone().sum::<f64>() / n;
        let squares: f64 = values.map(|value| (value - mean).powi(2)).sum();
        Self {
            mean,
            variance: squares / (n - 1.0) / n,
            count,
        }
    }

    /// The standard error of the mean.
    pub fn standard_error(&self) -> f64 {
        self.variance.sqrt()
    }

    /// The standard error of the difference of two independent estimates.
    pub fn error_of_difference(&self, other: &Self) -> f64 {
        (self.variance + other.variance).sqrt()
    }

    /// How far two independent estimates of one number are apart: standard normal if they estimate the same.
    ///
    /// This is Welch's t with Satterthwaite's degrees of freedom, since the variances are estimates themselves, taken
    /// to the quantile of a normal distribution. Differences of the size of single-precision rounding do not count.
    pub fn z_of_difference(&self, other: &Self) -> f64 {
        const ROUNDING: f64 = 1e-5;
        let difference = self.mean - other.mean;
        let rounding = ROUNDING * self.mean.abs().max(other.mean.abs());
        let variance = self.variance + other.variance + rounding * rounding;
        if variance == 0.0 {
            return 0.0;
        }
        let t = difference / variance.sqrt();
        let satterthwaite = self.variance.powi(2) / (self.count - 1) as f64
            + other.variance.powi(2) / (other.count - 1) as f64;
        let freedom = (variance * variance / satterthwaite.max(f64::MIN_POSITIVE)).min(1e6);
        let one_sided = StudentsT::new(0.0, 1.0, freedom)
            .expect("the degrees of freedom are positive")
            .sf(t.abs());
        let z = -Normal::standard().inverse_cdf(one_sided.max(1e-300));
        z.copysign(t)
    }
}

/// The |z| beyond which one of `tests` independent standard normal numbers lies with probability `significance`
/// (Šidák's correction).
pub fn sidak_threshold(significance: f64, tests: usize) -> f64 {
    let single = -f64::exp_m1(f64::ln_1p(-significance) / tests as f64);
    -Normal::standard().inverse_cdf(0.5 * single)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_threshold_grows_with_the_number_of_tests() {
        assert!((sidak_threshold(0.01, 1) - 2.5758).abs() < 1e-3);
        // 1 - 0.99^(1/1000) = 1.005e-5, and half of that lies beyond 4.416.
        assert!((sidak_threshold(0.01, 1000) - 4.416).abs() < 2e-3);
    }

    #[test]
    fn few_values_make_large_differences_less_surprising() {
        let of_three = Estimate {
            mean: 1.0,
            variance: 0.01,
            count: 3,
        };
        let exact = Estimate {
            mean: 0.0,
            variance: 0.0,
            count: 2,
        };
        // t = 10 with two degrees of freedom: one-sided probability 0.00493, as beyond 2.58 of a normal distribution.
        assert!((of_three.z_of_difference(&exact) - 2.58).abs() < 0.01);
        let of_many = Estimate {
            count: 100_000,
            ..of_three
        };
        assert!((of_many.z_of_difference(&exact) - 10.0).abs() < 0.05);
        assert!(exact.z_of_difference(&of_many) < -9.9);
    }
}
