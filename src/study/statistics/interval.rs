//! An estimate and how sure it is.

use serde::{Deserialize, Deserializer, Serialize};

use super::bootstrap::{Deviates, Moments, Resampler, critical_value};

/// An estimate with its 95 % confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// The estimate; not a number where there is none, which JSON writes as `null`.
    #[serde(deserialize_with = "unknown_from_null")]
    pub estimate: f64,
    /// Lower and upper end; `None` where they are not known, as for a single repetition.
    pub bounds: Option<(f64, f64)>,
}

impl Interval {
    /// No estimate at all.
    pub const UNKNOWN: Self = Self {
        estimate: f64::NAN,
        bounds: None,
    };

    /// The mean of what independent repetitions measured.
    ///
    /// Without spread between the repetitions both ends are the estimate. It is [`Self::UNKNOWN`] without values, or with
    /// one that is not finite.
    pub fn of_mean(values: &[f64]) -> Self {
        Self::of_mean_with_error(values, 0.0)
    }

    /// The same where all values share an independent, normal error of the known standard error `shared`, such as that of
    /// the reference in a bias: every resample gets one of its own, and both standard errors add by their squares.
    /// As the shared error is known, the interval has more certainty than that of few values alone, and a small one may
    /// even make it a little narrower (so does Welch's test).
    pub fn of_mean_with_error(values: &[f64], shared: f64) -> Self {
        if values.is_empty() || !values.iter().all(|value| value.is_finite()) {
            return Self::UNKNOWN;
        }
        if let [estimate] = *values {
            return Self {
                estimate,
                bounds: None,
            };
        }
        let centre = Moments::of(values);
        let sample = Resampler::new(values);
        let shift = |normal: f64| Moments {
            mean: -shared * normal,
            standard_error: shared,
        };
        let half = half_width(centre.minus(shift(0.0)), |random| {
            sample.draw(random).minus(shift(random.normal()))
        });
        Self {
            estimate: centre.mean,
            bounds: half
                .is_finite()
                .then_some((centre.mean - half, centre.mean + half)),
        }
    }

    /// The mean of a measure that is positive by nature, such as an error or a duration.
    ///
    /// The interval is made for the logarithm of the mean, so that its ends are positive and lie as many times below as
    /// above. Where a value is zero or negative, or the values scatter so widely that more than 5 % of the resampled
    /// means are negative, it is the one of [`Self::of_mean`].
    pub fn of_positive(values: &[f64]) -> Self {
        if values.len() < 2 || !all_positive(values) {
            return Self::of_mean(values);
        }
        let centre = Moments::of(values).log();
        let sample = Resampler::new(values);
        let half = half_width(centre, |random| sample.draw(random).log());
        if half.is_finite() {
            Self {
                estimate: centre.mean.exp(),
                bounds: Some(((centre.mean - half).exp(), (centre.mean + half).exp())),
            }
        } else {
            Self::of_mean(values)
        }
    }

    /// The ratio of the means of a positive measure of two competitors, `first` / `second`, by repetition.
    ///
    /// Values of one repetition belong together: competitors took turns in it, so that what slowed one down slowed the
    /// other down as well, and it cancels. The interval is that of the mean of paired differences of the logarithms,
    /// linearised at the means. Its bounds are `None` where there is a single repetition, or a value that is zero or
    /// negative.
    ///
    /// # Panics
    /// Where they have different numbers of repetitions.
    pub fn of_ratio(first: &[f64], second: &[f64]) -> Self {
        assert_eq!(first.len(), second.len(), "values come in pairs");
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let (a, b) = (mean(first), mean(second));
        if !(a > 0.0 && b > 0.0 && (a / b).is_finite()) {
            return Self::UNKNOWN;
        }
        let estimate = a / b;
        if first.len() < 2 || !all_positive(first) || !all_positive(second) {
            return Self {
                estimate,
                bounds: None,
            };
        }
        let pairs = first.iter().zip(second);
        let differences: Vec<f64> = pairs.map(|(x, y)| x / a - y / b).collect();
        let bounds = Self::of_mean(&differences).bounds;
        Self {
            estimate,
            bounds: bounds.map(|(low, high)| (estimate * low.exp(), estimate * high.exp())),
        }
    }

    /// One over it. [`Self::UNKNOWN`] where the estimate is not positive; no bounds where the lower one is not.
    pub fn reciprocal(self) -> Self {
        if self.estimate > 0.0 {
            Self {
                estimate: 1.0 / self.estimate,
                bounds: self
                    .bounds
                    .filter(|(low, _)| *low > 0.0)
                    .map(|(low, high)| (1.0 / high, 1.0 / low)),
            }
        } else {
            Self::UNKNOWN
        }
    }

    /// Its square root; what is negative becomes 0.
    pub fn square_root(self) -> Self {
        let root = |value: f64| if value < 0.0 { 0.0 } else { value.sqrt() };
        Self {
            estimate: root(self.estimate),
            bounds: self.bounds.map(|(low, high)| (root(low), root(high))),
        }
    }

    /// Whether `value` lies within the bounds, which it may equal; never where they are not known.
    pub fn holds(&self, value: f64) -> bool {
        self.bounds
            .is_some_and(|(low, high)| low <= value && value <= high)
    }
}

/// Values whose mean is the product of the means of `errors` and `costs`, and whose spread is that of the product to
/// first order (its linearisation at the means): what intervals of 1 / (error x cost) are made from. Both are by
/// repetition.
pub fn products(errors: &[f64], costs: &[f64]) -> Vec<f64> {
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let (error, cost) = (mean(errors), mean(costs));
    let pairs = errors.iter().zip(costs);
    pairs
        .map(|(e, c)| e * cost + c * error - error * cost)
        .collect()
}

/// Half the width of the interval around `centre`; infinite where resamples have no finite spread.
fn half_width(centre: Moments, draw: impl FnMut(&mut Deviates) -> Moments) -> f64 {
    if centre.standard_error == 0.0 {
        return 0.0;
    }
    critical_value(centre.mean, draw) * centre.standard_error
}

fn all_positive(values: &[f64]) -> bool {
    values.iter().all(|value| *value > 0.0 && value.is_finite())
}

fn unknown_from_null<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

#[cfg(test)]
mod tests {
    use serde::de::value::{Error, UnitDeserializer};

    use super::*;

    #[test]
    fn an_unknown_estimate_is_read_from_null() {
        let null = UnitDeserializer::<Error>::new();
        assert!(unknown_from_null(null).unwrap().is_nan());
    }
}
