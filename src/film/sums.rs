//! In which precision a pixel adds up its samples.

use serde::{Deserialize, Serialize};

/// The numbers in which pixels add up their samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FilmSums {
    /// Single precision. A sum that is 2^24 times larger than what is added stops growing: the image gets darker.
    Single,
    /// Double precision.
    #[default]
    Double,
    /// Single precision with a second number for what the first loses.
    Compensated,
}

impl FilmSums {
    /// The name in metadata.
    pub fn name(self) -> &'static str {
        match self {
            Self::Single => "single",
            Self::Double => "double",
            Self::Compensated => "compensated",
        }
    }
}

/// A running sum.
pub trait Accumulator: Copy + Default {
    /// Adds a value, rounded first to the precision of the sum.
    fn add(&mut self, value: f64);

    /// The sum.
    fn total(self) -> f64;
}

impl Accumulator for f32 {
    #[inline]
    fn add(&mut self, value: f64) {
        *self += value as f32;
    }

    #[inline]
    fn total(self) -> f64 {
        f64::from(self)
    }
}

impl Accumulator for f64 {
    #[inline]
    fn add(&mut self, value: f64) {
        *self += value;
    }

    #[inline]
    fn total(self) -> f64 {
        self
    }
}

/// A sum in single precision that keeps what rounding takes from it (Kahan 1965, "Further remarks on reducing
/// truncation errors").
///
/// The two numbers are brought back to a sum and its rounding error after every addition (as in Dekker 1971, "A
/// floating-point technique for extending the available precision"), so that what is lost cannot stall either.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CompensatedSum {
    sum: f32,
    lost: f32,
}

impl Accumulator for CompensatedSum {
    #[inline]
    fn add(&mut self, value: f64) {
        let (value, rest) = (value as f32, (value - f64::from(value as f32)) as f32);
        let sum = self.sum + value;
        // What rounding took, whichever of the two is larger (Knuth, The Art of Computer Programming 2, 4.2.2).
        let added = sum - self.sum;
        let lost = self.lost + rest + ((self.sum - (sum - added)) + (value - added));
        self.sum = sum + lost;
        self.lost = lost - (self.sum - sum);
    }

    #[inline]
    fn total(self) -> f64 {
        f64::from(self.sum) + f64::from(self.lost)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum<A: Accumulator>(values: impl IntoIterator<Item = f64>) -> f64 {
        let mut sum = A::default();
        values.into_iter().for_each(|value| sum.add(value));
        sum.total()
    }

    #[test]
    fn single_precision_stalls_and_the_others_do_not() {
        let ones = || std::iter::repeat_n(1.0, 1 << 26);
        assert_eq!(sum::<f32>(ones()), f64::from(1 << 24));
        assert_eq!(sum::<f64>(ones()), f64::from(1 << 26));
        assert_eq!(sum::<CompensatedSum>(ones()), f64::from(1 << 26));
    }

    #[test]
    fn compensation_keeps_what_is_small_on_either_side() {
        let values = [1.0, 1e10, 1.0, -1e10];
        assert_eq!(sum::<f32>(values), 0.0);
        assert_eq!(sum::<CompensatedSum>(values), 2.0);
    }
}
