//! # `roulette`
//!
//! Russian roulette as in the paper (section 4.1, figure 2; Arvo and Kirk 1990): a particle whose importance after
//! the reflection falls below a threshold T is ended with probability P,
//!
//! ```text
//! nu = 1        if W a >= T
//! nu = 1 - P    otherwise
//! ```
//!
//! Each particle decides alone.
//!
//! **Settings:** `threshold`, T > 0 (default 0.1); `termination`, 0 <= P < 1 (default 0.5). The defaults are the
//! paper's. P = 0 never ends a path.
//!
//! **When it wins:** bright scenes where light takes many turns: it leaves a path alone for as long as it carries
//! something, and never splits. Its weakness is the same: it follows a path of importance 0.11 like one of importance 1.

use super::{Population, SettingError, Strategy};

/// Ends particles of little importance with a fixed probability; see the [module](self).
#[derive(Clone, Copy, Debug)]
pub struct Roulette {
    threshold: f32,
    termination: f32,
}

impl Roulette {
    /// The strategy's name.
    pub const NAME: &str = "roulette";
    /// The paper's T.
    pub const DEFAULT_THRESHOLD: f32 = 0.1;
    /// The paper's P.
    pub const DEFAULT_TERMINATION: f32 = 0.5;

    /// Roulette below the importance `threshold` (T), with the probability `termination` (P).
    ///
    /// # Errors
    /// If T is not positive and finite, or P not in \[0, 1).
    pub fn new(threshold: f32, termination: f32) -> Result<Self, SettingError> {
        let out_of_range = |setting, value: f32, range| SettingError::OutOfRange {
            strategy: Self::NAME,
            setting,
            value: value.to_string(),
            range,
        };
        if !(threshold > 0.0 && threshold.is_finite()) {
            return Err(out_of_range("threshold", threshold, "positive and finite"));
        }
        if !(0.0..1.0).contains(&termination) {
            return Err(out_of_range(
                "termination",
                termination,
                "at least 0 and below 1",
            ));
        }
        Ok(Self {
            threshold,
            termination,
        })
    }
}

impl Default for Roulette {
    /// With the paper's T and P.
    fn default() -> Self {
        Self {
            threshold: Self::DEFAULT_THRESHOLD,
            termination: Self::DEFAULT_TERMINATION,
        }
    }
}

impl Strategy for Roulette {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn settings(&self) -> Vec<(&'static str, String)> {
        vec![
            ("threshold", self.threshold.to_string()),
            ("termination", self.termination.to_string()),
        ]
    }

    fn expected_counts(&self, population: &Population, nu: &mut [f32]) {
        let survival = 1.0 - self.termination;
        for ((nu, w), a) in nu
            .iter_mut()
            .zip(population.importance)
            .zip(population.albedo)
        {
            *nu = if w * a >= self.threshold {
                1.0
            } else {
                survival
            };
        }
    }
}
