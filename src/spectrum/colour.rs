//! How colours travel along a path: the engine is one code, generic over this.

use super::curve::SpectralCurve;
use super::curve_lanes;
use super::emission_image::{BetweenTexels, EmissionImage};
use super::reflectances::Reflectances;
use super::rgb_lanes;
use super::values::{Spectrum, SpectrumArithmetic};
use super::wavelengths::Wavelengths;
use crate::lanes::CHUNK;
use std::fmt::Debug;

/// A way to carry colours along a path.
pub trait Colour: Copy + Debug + Default + Send + Sync + 'static {
    /// What distinguishes one path's components from another's.
    type Wavelengths: Copy + Debug + PartialEq + Send + Sync + 'static;

    /// Values of radiometric quantities on a path.
    type Spectrum: SpectrumArithmetic;

    /// What is known of the choice of a path's wavelengths.
    type WavelengthDraw: Copy + Debug + Send + Sync + 'static;

    /// How many uniform numbers [`Self::sample_wavelengths`] makes use of: 0 or 1.
    const RANDOM_NUMBERS: usize;

    /// Appends the wavelengths of `count` paths, at most `CHUNK`, each drawn from its uniform number `u` in [0, 1).
    fn sample_wavelengths(
        u: &[f32; CHUNK],
        count: usize,
        drawn: &mut Vec<Self::Wavelengths>,
        draws: &mut Vec<Self::WavelengthDraw>,
    );

    /// The values of a colour of the scene for a path with `wavelengths`.
    fn evaluate(curve: &SpectralCurve, wavelengths: &Self::Wavelengths) -> Self::Spectrum;

    /// Hands the values of many colours of the scene, each for a path with the wavelengths beside it, to `take`, in their order.
    fn evaluate_each<'a>(
        colours: impl Iterator<Item = (&'a SpectralCurve, &'a Self::Wavelengths)>,
        take: impl FnMut(Self::Spectrum),
    );

    /// Appends the values of all `curves` for a path with each of the `wavelengths`: those of one path side by side.
    fn evaluate_all(
        curves: &[SpectralCurve],
        wavelengths: &[Self::Wavelengths],
        values: &mut Vec<Self::Spectrum>,
    );

    /// The values of a point of an image of emitted colours for a path with `wavelengths`.
    fn evaluate_emission(
        image: &EmissionImage,
        at: &BetweenTexels,
        wavelengths: &Self::Wavelengths,
    ) -> Self::Spectrum;

    /// The values of one of many reflectances for a path with `wavelengths`.
    fn evaluate_entry(
        table: &Reflectances,
        entry: usize,
        wavelengths: &Self::Wavelengths,
    ) -> Self::Spectrum;

    /// Appends the linear sRGB colours of the radiances of many paths to `colours`, each at the wavelengths beside it and their draw: unbiased estimates
    /// over the choice of the wavelengths, with components that may be negative.
    fn to_rgb(
        radiances: &[Self::Spectrum],
        wavelengths: &[Self::Wavelengths],
        draws: &[Self::WavelengthDraw],
        colours: &mut Vec<[f32; 3]>,
    );
}

/// Three channels, linear sRGB, each multiplied by itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rgb;

impl Colour for Rgb {
    type Wavelengths = ();
    type WavelengthDraw = ();
    type Spectrum = Spectrum<3>;
    const RANDOM_NUMBERS: usize = 0;

    #[inline]
    fn sample_wavelengths(
        _u: &[f32; CHUNK],
        count: usize,
        drawn: &mut Vec<()>,
        draws: &mut Vec<()>,
    ) {
        drawn.resize(drawn.len() + count, ());
        draws.resize(draws.len() + count, ());
    }

    #[inline(always)]
    fn evaluate(curve: &SpectralCurve, _wavelengths: &()) -> Spectrum<3> {
        Spectrum(curve.rgb())
    }

    #[inline(always)]
    fn evaluate_each<'a>(
        colours: impl Iterator<Item = (&'a SpectralCurve, &'a ())>,
        mut take: impl FnMut(Spectrum<3>),
    ) {
        for (curve, _) in colours {
            take(Spectrum(curve.rgb()));
        }
    }

    #[inline(always)]
    fn evaluate_all(curves: &[SpectralCurve], wavelengths: &[()], values: &mut Vec<Spectrum<3>>) {
        for _ in wavelengths {
            values.extend(curves.iter().map(|curve| Spectrum(curve.rgb())));
        }
    }

    #[inline]
    fn evaluate_emission(
        image: &EmissionImage,
        at: &BetweenTexels,
        _wavelengths: &(),
    ) -> Spectrum<3> {
        Spectrum(image.rgb(at))
    }

    #[inline]
    fn evaluate_entry(table: &Reflectances, entry: usize, _wavelengths: &()) -> Spectrum<3> {
        Spectrum(table.rgb(entry))
    }

    #[inline]
    fn to_rgb(
        radiances: &[Spectrum<3>],
        _wavelengths: &[()],
        _draws: &[()],
        colours: &mut Vec<[f32; 3]>,
    ) {
        colours.extend(radiances.iter().map(|radiance| radiance.0));
    }
}

/// `N` wavelengths drawn for each path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Spectral<const N: usize>;

impl<const N: usize> Colour for Spectral<N> {
    type Wavelengths = Wavelengths<N>;
    /// The uniform number from which they were drawn.
    type WavelengthDraw = f32;
    type Spectrum = Spectrum<N>;
    const RANDOM_NUMBERS: usize = 1;

    #[inline(always)]
    fn sample_wavelengths(
        u: &[f32; CHUNK],
        count: usize,
        drawn: &mut Vec<Wavelengths<N>>,
        draws: &mut Vec<f32>,
    ) {
        Wavelengths::sample_each(u, count, drawn);
        draws.extend_from_slice(&u[..count]);
    }

    #[inline(always)]
    fn evaluate(curve: &SpectralCurve, wavelengths: &Wavelengths<N>) -> Spectrum<N> {
        curve.evaluate(wavelengths)
    }

    #[inline(always)]
    fn evaluate_each<'a>(
        colours: impl Iterator<Item = (&'a SpectralCurve, &'a Wavelengths<N>)>,
        take: impl FnMut(Spectrum<N>),
    ) {
        curve_lanes::evaluate_each(colours, take);
    }

    #[inline(always)]
    fn evaluate_all(
        curves: &[SpectralCurve],
        wavelengths: &[Wavelengths<N>],
        values: &mut Vec<Spectrum<N>>,
    ) {
        curve_lanes::evaluate_all(curves, wavelengths, values);
    }

    #[inline]
    fn evaluate_emission(
        image: &EmissionImage,
        at: &BetweenTexels,
        wavelengths: &Wavelengths<N>,
    ) -> Spectrum<N> {
        image.spectrum(at, wavelengths)
    }

    #[inline]
    fn evaluate_entry(
        table: &Reflectances,
        entry: usize,
        wavelengths: &Wavelengths<N>,
    ) -> Spectrum<N> {
        table.evaluate(entry, wavelengths)
    }

    #[inline(always)]
    fn to_rgb(
        radiances: &[Spectrum<N>],
        wavelengths: &[Wavelengths<N>],
        draws: &[f32],
        colours: &mut Vec<[f32; 3]>,
    ) {
        rgb_lanes::to_rgb(radiances, wavelengths, draws, colours);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The colour of one path.
    fn to_rgb<C: Colour>(
        radiance: C::Spectrum,
        wavelengths: &C::Wavelengths,
        draw: C::WavelengthDraw,
    ) -> [f32; 3] {
        let mut colours = Vec::new();
        C::to_rgb(&[radiance], &[*wavelengths], &[draw], &mut colours);
        colours[0]
    }

    /// The colour of a radiance as the mean over the paths with evenly spread random numbers.
    fn mean_colour<const N: usize>(radiance: impl Fn(&Wavelengths<N>) -> Spectrum<N>) -> [f32; 3] {
        let paths = 20_000;
        let mut sum = [0.0f64; 3];
        for path in 0..paths {
            let draw = (path as f32 + 0.5) / paths as f32;
            let wavelengths = Wavelengths::<N>::sample(draw);
            for (sum, channel) in sum.iter_mut().zip(to_rgb::<Spectral<N>>(
                radiance(&wavelengths),
                &wavelengths,
                draw,
            )) {
                *sum += f64::from(channel);
            }
        }
        sum.map(|channel| (channel / f64::from(paths)) as f32)
    }

    #[track_caller]
    fn assert_close(a: [f32; 3], b: [f32; 3], tolerance: f32) {
        assert!(
            a.iter().zip(b).all(|(a, b)| (a - b).abs() < tolerance),
            "{a:?} instead of {b:?}"
        );
    }

    #[test]
    fn daylight_is_white_and_equal_energy_is_illuminant_e() {
        let white = SpectralCurve::rgb_emission([1.0; 3]).unwrap();
        assert_close(mean_colour::<1>(|w| white.evaluate(w)), [1.0; 3], 3e-4);
        assert_close(mean_colour::<4>(|w| white.evaluate(w)), [1.0; 3], 3e-4);
        assert_close(mean_colour::<8>(|w| white.evaluate(w)), [1.0; 3], 3e-4);
        // The exact integral is 0.1 % above the sum over 1000 points that normalises it.
        let equal_energy = [1.204_795, 0.948_292, 0.908_916].map(|channel| 1.001 * channel);
        assert_close(mean_colour::<4>(|_| Spectrum::ONE), equal_energy, 1e-3);
    }

    #[test]
    fn a_lit_colour_comes_back_through_the_wavelengths() {
        let white = SpectralCurve::rgb_emission([1.0; 3]).unwrap();
        for rgb in [
            [0.63, 0.065, 0.05],
            [0.14, 0.45, 0.091],
            [1.0, 0.0, 0.0],
            [0.0, 0.0, 0.02],
            [0.9, 1.0, 0.0],
        ] {
            let surface = SpectralCurve::rgb_reflectance(rgb).unwrap();
            assert_close(
                mean_colour::<4>(|w| white.evaluate(w) * surface.evaluate(w)),
                rgb,
                1e-3,
            );
        }
        for rgb in [[17.0, 12.0, 4.0], [0.0, 3.0, 9.0]] {
            let lamp = SpectralCurve::rgb_emission(rgb).unwrap();
            assert_close(mean_colour::<4>(|w| lamp.evaluate(w)), rgb, 5e-3);
        }
    }

    #[test]
    fn both_ways_see_the_same_measured_lamp() {
        let entries = [(400.0, 0.0), (500.0, 8.0), (600.0, 15.6), (700.0, 18.4)];
        let lamp = SpectralCurve::tabulated_emission(&entries).unwrap();
        let rgb = to_rgb::<Rgb>(Rgb::evaluate(&lamp, &()), &(), ());
        assert_close(rgb, lamp.rgb(), 1e-9);
        assert_close(
            mean_colour::<4>(|w| Spectral::evaluate(&lamp, w)),
            rgb.map(|c| 1.001 * c),
            5e-3,
        );
    }

    #[test]
    fn one_path_has_mitsubas_colour() {
        // mi.spectrum_to_srgb([1, 2, 3, 4], [450, 520, 555, 601]), where each has a density of 1.
        let wavelengths = Wavelengths::at([450.0, 520.0, 555.0, 601.0]);
        let draw = 0.25;
        let radiance = Spectrum([1.0, 2.0, 3.0, 4.0]) * Spectrum(Wavelengths::pdf(draw));
        let rgb = to_rgb::<Spectral<4>>(radiance, &wavelengths, draw);
        assert_close(rgb, [0.020_087_6, 0.016_487_2, 0.002_326_41], 1e-6);
    }
}
