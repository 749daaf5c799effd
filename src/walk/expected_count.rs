//! The expected number of children of one particle, nu, as a fixed-point number.
//!
//! An estimator with strategies is unbiased when the drawn integer n has E\[n\] = nu *exactly*. Floating point
//! makes that hard: sums of nu round, a uniform number can fall on a border that rounding has moved, a tiny nu
//! lies below the resolution of the uniform numbers. So nu is kept as an integer multiple of 2^-32, the
//! resolution of one 32-bit random number. Sums are then exact in any order, intervals that should be empty
//! are empty, the last particle ends exactly where the population ends, and of the 2^32 equally likely random
//! numbers exactly as many round nu up as its fraction says. Rounding a strategy's wish to that grid costs
//! nothing, because the child carries the reciprocal of the nu that was used.

use serde::{Serialize, Serializer};

/// Binary digits after the point.
const FRACTION_BITS: u32 = 32;

/// The number 1.
const ONE: u64 = 1 << FRACTION_BITS;

/// An expected number of children: 0, or from [`ExpectedCount::SMALLEST`] to [`ExpectedCount::LARGEST`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct ExpectedCount(u64);

impl ExpectedCount {
    /// No children, for certain.
    pub const ZERO: Self = Self(0);

    /// The least positive expected count, 2^-32: a particle that matters is never given less, so that it can
    /// be reached and the weight of its children is finite.
    pub const SMALLEST: Self = Self(1);

    /// The largest expected count, 1024: it protects the memory from a particle that wants millions of children.
    pub const LARGEST: Self = Self(1024 * ONE);

    /// The expected count next to `nu`, between [`SMALLEST`](Self::SMALLEST) and [`LARGEST`](Self::LARGEST).
    ///
    /// Never zero: which particles have no children at all is not for a strategy to say (see [`Strategy`]).
    ///
    /// [`Strategy`]: super::Strategy
    #[inline(always)]
    pub fn positive(nu: f32) -> Self {
        // Conversions to integers by `as` look after numbers out of range and do not vectorise. Here none is out of range (the
        // comparisons take NaN to the least), and adding 2^52 leaves the nearest integer in the last bits.
        const INTEGERS: f64 = (1_u64 << 52) as f64;
        let units = f64::from(nu) * ONE as f64;
        let units = if units > 1.0 { units } else { 1.0 };
        let largest = Self::LARGEST.0 as f64;
        let units = if units < largest { units } else { largest };
        Self((units + INTEGERS).to_bits() - INTEGERS.to_bits())
    }

    /// What a child's throughput is multiplied by: 1 / nu, finite for every positive nu.
    #[inline]
    pub fn child_weight(self) -> f32 {
        // Signed integers become floating point by one instruction, and no count has that many digits. Single precision holds
        // all of a wish, and divides in half the time.
        ONE as f32 / self.0 as i64 as f32
    }

    /// nu, rounded.
    #[inline(always)]
    pub fn as_f32(self) -> f32 {
        self.0 as i64 as f32 * (1.0 / ONE as f32)
    }

    /// The children that are certain: floor(nu).
    #[inline]
    pub(super) fn whole(self) -> u64 {
        self.0 >> FRACTION_BITS
    }

    /// What remains when the certain children are taken away: nu - floor(nu).
    #[inline]
    pub(super) fn fraction(self) -> Self {
        Self(self.0 & (ONE - 1))
    }

    /// nu in units of 2^-32: the length of the particle's interval when a population's are laid end to end.
    #[inline]
    pub(super) fn units(self) -> u64 {
        self.0
    }

    /// An integer with this mean: floor(nu), plus 1 with probability nu - floor(nu). `bits` draws one of the 2^32 equally
    /// likely random numbers.
    #[inline]
    pub(super) fn round(self, bits: impl FnOnce() -> u32) -> u64 {
        // An integer needs no random number: strategies that leave a particle alone pay nothing.
        if self.fraction() == Self::ZERO {
            self.whole()
        } else {
            self.round_with(bits())
        }
    }

    /// [`round`](Self::round) for one of the 2^32 equally likely random numbers.
    #[inline]
    fn round_with(self, bits: u32) -> u64 {
        (self.0 + u64::from(bits)) >> FRACTION_BITS
    }
}

/// The sum over a population; exact as long as it stays below 2^32 children.
impl std::iter::Sum for ExpectedCount {
    fn sum<I: Iterator<Item = Self>>(counts: I) -> Self {
        Self(counts.map(|count| count.0).sum())
    }
}

impl From<ExpectedCount> for f64 {
    fn from(count: ExpectedCount) -> f64 {
        count.0 as f64 / ONE as f64
    }
}

impl Serialize for ExpectedCount {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_f64((*self).into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_float_ends_inside_the_bounds() {
        for nu in [0.0, -1.0, 1e-45, 1e-30, f32::NAN, f32::NEG_INFINITY] {
            assert_eq!(ExpectedCount::positive(nu), ExpectedCount::SMALLEST, "{nu}");
        }
        for nu in [1024.0, 1e30, f32::MAX, f32::INFINITY] {
            assert_eq!(ExpectedCount::positive(nu), ExpectedCount::LARGEST, "{nu}");
        }
        assert!(ExpectedCount::SMALLEST.child_weight().is_finite());
    }

    #[test]
    fn floats_of_everyday_size_are_kept_exactly() {
        for nu in [0.1_f32, 0.5, 0.95, 1.0, 9.9, 1023.9] {
            assert_eq!(f64::from(ExpectedCount::positive(nu)), f64::from(nu));
        }
    }

    /// Of the 2^32 random numbers, exactly `fraction` in units of 2^-32 round up: the highest ones.
    #[test]
    fn rounding_up_has_exactly_the_probability_of_the_fraction() {
        for nu in [0.1_f32, 0.3333, 1.75, 10.000001, 1e-9, 2.0_f32.powi(-32)] {
            let count = ExpectedCount::positive(nu);
            let first_up = (ONE - count.fraction().0) as u32;
            assert_eq!(count.round_with(first_up - 1), count.whole());
            assert_eq!(count.round_with(first_up), count.whole() + 1);
            assert_eq!(count.round_with(0), count.whole());
            assert_eq!(count.round_with(u32::MAX), count.whole() + 1);
        }
    }
}
