//! Means, ratios and slopes with their confidence intervals over independent repetitions.

use serde::{Deserialize, Serialize};

/// An estimate with its 95 % confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// The estimate.
    pub estimate: f64,
    /// Lower and upper end; `None` where a single repetition leaves it unknown.
    pub bounds: Option<(f64, f64)>,
}
