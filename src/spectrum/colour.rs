//! How colours travel along a path: the engine is one code, generic over this.

use super::cie::matching_srgb;
use super::curve::SpectralCurve;
use super::values::{Spectrum, SpectrumArithmetic};
use super::wavelengths::Wavelengths;
use std::fmt::Debug;

/// A way to carry colours along a path.
pub trait Colour: Copy + Debug + Default + Send + Sync + 'static {
    /// What distinguishes one path's components from another's.
    type Wavelengths: Copy + Debug + PartialEq + Send + Sync + 'static;

    /// Values of radiometric quantities on a path.
    type Spectrum: SpectrumArithmetic;

    /// How many uniform numbers [`Self::sample_wavelengths`] makes use of: 0 or 1.
    const RANDOM_NUMBERS: usize;

    /// Draws the wavelengths of a path from the uniform number `u` in [0, 1).
    fn sample_wavelengths(u: f32) -> Self::Wavelengths;

    /// The values of a colour of the scene for a path with `wavelengths`.
    fn evaluate(curve: &SpectralCurve, wavelengths: &Self::Wavelengths) -> Self::Spectrum;

    /// The linear sRGB colour of a path's radiance: an unbiased estimate over the choice of the wavelengths, with
    /// components that may be negative.
    fn to_rgb(radiance: Self::Spectrum, wavelengths: &Self::Wavelengths) -> [f32; 3];
}

/// Three channels, linear sRGB, each multiplied by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rgb;

impl Colour for Rgb {
    type Wavelengths = ();
    type Spectrum = Spectrum<3>;
    const RANDOM_NUMBERS: usize = 0;

    #[inline]
    fn sample_wavelengths(_u: f32) {}

    #[inline]
    fn evaluate(curve: &SpectralCurve, _wavelengths: &()) -> Spectrum<3> {
        Spectrum(curve.rgb())
    }

    #[inline]
    fn to_rgb(radiance: Spectrum<3>, _wavelengths: &()) -> [f32; 3] {
        radiance.0
    }
}

/// `N` wavelengths drawn for each path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spectral<const N: usize>;

impl<const N: usize> Colour for Spectral<N> {
    type Wavelengths = Wavelengths<N>;
    type Spectrum = Spectrum<N>;
    const RANDOM_NUMBERS: usize = 1;

    #[inline]
    fn sample_wavelengths(u: f32) -> Wavelengths<N> {
        Wavelengths::sample(u)
    }

    #[inline]
    fn evaluate(curve: &SpectralCurve, wavelengths: &Wavelengths<N>) -> Spectrum<N> {
        curve.evaluate(wavelengths)
    }

    #[inline]
    fn to_rgb(radiance: Spectrum<N>, wavelengths: &Wavelengths<N>) -> [f32; 3] {
        let mut rgb = [0.0; 3];
        for i in 0..N {
            let estimate = radiance[i] / (wavelengths.pdf()[i] * N as f32);
            for (sum, weight) in rgb.iter_mut().zip(matching_srgb(wavelengths.nm()[i])) {
                *sum += weight * estimate;
            }
        }
        rgb
    }
}
