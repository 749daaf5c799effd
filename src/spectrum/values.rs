//! The values of a radiometric quantity at the wavelengths (or in the channels) of one path.

use std::fmt::Debug;
use std::ops::{
    Add, AddAssign, Div, DivAssign, Index, IndexMut, Mul, MulAssign, Neg, Sub, SubAssign,
};

/// Radiometric values at the `N` wavelengths, or in the 3 RGB channels, that a path carries.
///
/// Only values at the same wavelengths may be combined. All arithmetic is component by component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spectrum<const N: usize>(pub [f32; N]);

/// What the engine does with the values on a path, whichever their number. [`Spectrum`] implements it.
pub trait SpectrumArithmetic:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Mul<f32, Output = Self>
    + Div<f32, Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
    + MulAssign<f32>
    + DivAssign<f32>
{
    /// Number of components.
    const COMPONENTS: usize;

    /// Zero in every component.
    const ZERO: Self;

    /// One in every component.
    const ONE: Self;

    /// `value` in every component.
    fn splat(value: f32) -> Self;

    /// The components.
    fn components(&self) -> &[f32];

    /// The first component: of the hero wavelength, where components are wavelengths.
    fn hero(self) -> f32;

    /// The first component alone, multiplied by their number, and zero in the others: what a path carries on that goes
    /// where only its hero wavelength goes (Wilkie et al. 2014, "Hero wavelength spectral sampling", section 3.2).
    fn only_hero(self) -> Self;

    /// `f` of every component.
    fn map(self, f: impl Fn(f32) -> f32) -> Self;

    /// `f` of every component and that of `other`.
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self;

    /// The largest component. Not-a-number components are passed over.
    fn max_component(self) -> f32;

    /// The mean of the components.
    fn mean(self) -> f32;

    /// Whether every component is zero.
    fn is_black(self) -> bool;

    /// Whether no component is infinite or not a number.
    fn is_finite(self) -> bool;
}

impl<const N: usize> SpectrumArithmetic for Spectrum<N> {
    const COMPONENTS: usize = N;
    const ZERO: Self = Self([0.0; N]);
    const ONE: Self = Self([1.0; N]);

    #[inline]
    fn splat(value: f32) -> Self {
        Self([value; N])
    }

    #[inline]
    fn components(&self) -> &[f32] {
        &self.0
    }

    #[inline]
    fn hero(self) -> f32 {
        self.0[0]
    }

    #[inline]
    fn only_hero(self) -> Self {
        let mut alone = [0.0; N];
        alone[0] = self.0[0] * N as f32;
        Self(alone)
    }

    #[inline(always)]
    fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self(self.0.map(f))
    }

    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }

    #[inline]
    fn max_component(self) -> f32 {
        let larger = |most, v| if v > most { v } else { most };
        self.0.into_iter().fold(f32::NEG_INFINITY, larger)
    }

    #[inline]
    fn mean(self) -> f32 {
        self.0.into_iter().sum::<f32>() * (1.0 / N as f32)
    }

    #[inline]
    fn is_black(self) -> bool {
        // Without jumps, as below: which component decides cannot be foreseen.
        self.0.into_iter().fold(true, |all, v| all & (v == 0.0))
    }

    #[inline]
    fn is_finite(self) -> bool {
        self.0.into_iter().fold(true, |all, v| all & v.is_finite())
    }
}

impl<const N: usize> Default for Spectrum<N> {
    #[inline]
    fn default() -> Self {
        Self::ZERO
    }
}

impl<const N: usize> Index<usize> for Spectrum<N> {
    type Output = f32;

    #[inline]
    fn index(&self, component: usize) -> &f32 {
        &self.0[component]
    }
}

impl<const N: usize> IndexMut<usize> for Spectrum<N> {
    #[inline]
    fn index_mut(&mut self, component: usize) -> &mut f32 {
        &mut self.0[component]
    }
}

impl<const N: usize> Neg for Spectrum<N> {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self(self.0.map(|v| -v))
    }
}

/// Implements a binary operator between spectra and with a scalar on the right, and its assigning forms.
macro_rules! componentwise {
    ($operator:ident, $method:ident, $assigning:ident, $assign_method:ident) => {
        impl<const N: usize> $assigning for Spectrum<N> {
            #[inline]
            fn $assign_method(&mut self, other: Self) {
                for (a, b) in self.0.iter_mut().zip(other.0) {
                    a.$assign_method(b);
                }
            }
        }

        impl<const N: usize> $assigning<f32> for Spectrum<N> {
            #[inline]
            fn $assign_method(&mut self, scalar: f32) {
                for a in &mut self.0 {
                    a.$assign_method(scalar);
                }
            }
        }

        impl<const N: usize> $operator for Spectrum<N> {
            type Output = Self;

            #[inline]
            fn $method(mut self, other: Self) -> Self {
                self.$assign_method(other);
                self
            }
        }

        impl<const N: usize> $operator<f32> for Spectrum<N> {
            type Output = Self;

            #[inline]
            fn $method(mut self, scalar: f32) -> Self {
                self.$assign_method(scalar);
                self
            }
        }
    };
}

componentwise!(Add, add, AddAssign, add_assign);
componentwise!(Sub, sub, SubAssign, sub_assign);
componentwise!(Mul, mul, MulAssign, mul_assign);
componentwise!(Div, div, DivAssign, div_assign);

impl<const N: usize> Mul<Spectrum<N>> for f32 {
    type Output = Spectrum<N>;

    #[inline]
    fn mul(self, spectrum: Spectrum<N>) -> Spectrum<N> {
        spectrum * self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arithmetic_is_component_by_component() {
        let (a, b) = (Spectrum([1.0, 2.0, 4.0]), Spectrum([8.0, 4.0, 2.0]));
        assert_eq!(a + b, Spectrum([9.0, 6.0, 6.0]));
        assert_eq!(a - b, Spectrum([-7.0, -2.0, 2.0]));
        assert_eq!(a * b, Spectrum([8.0, 8.0, 8.0]));
        assert_eq!(a / b, Spectrum([0.125, 0.5, 2.0]));
        assert_eq!(2.0 * a, Spectrum([2.0, 4.0, 8.0]));
        assert_eq!(a / 2.0, Spectrum([0.5, 1.0, 2.0]));
        assert_eq!(-a, Spectrum([-1.0, -2.0, -4.0]));
        let mut c = a;
        c += b;
        c *= 0.5;
        c -= Spectrum::ONE;
        assert_eq!(c, Spectrum([3.5, 2.0, 2.0]));
    }

    #[test]
    fn summaries() {
        let a = Spectrum([1.0, 2.0, 6.0]);
        assert_eq!(a.max_component(), 6.0);
        assert_eq!(a.mean(), 3.0);
        assert_eq!(Spectrum([-3.0, -1.0]).max_component(), -1.0);
        assert_eq!(a.hero(), 1.0);
        assert_eq!(a.only_hero(), Spectrum([3.0, 0.0, 0.0]));
        assert_eq!(a.only_hero().mean(), a.hero());
        assert_eq!(a.map(|v| v * v), Spectrum([1.0, 4.0, 36.0]));
        assert_eq!(
            a.zip(Spectrum([1.0, 5.0, 2.0]), f32::max),
            Spectrum([1.0, 5.0, 6.0])
        );
        assert!(Spectrum::<4>::ZERO.is_black() && !Spectrum([0.0, 1e-30]).is_black());
        assert!(a.is_finite() && !Spectrum([0.0, f32::NAN]).is_finite());
        assert!(!Spectrum([f32::INFINITY, 0.0]).is_finite());
    }
}
