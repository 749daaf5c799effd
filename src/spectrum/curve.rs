//! The colours of a scene, each as a function of the wavelength and as linear sRGB.

use super::cie::{
    ILLUMINANT_E, WAVELENGTH_MAX, WAVELENGTH_MIN, illuminant_d65, srgb_of_emission,
    srgb_of_reflectance, srgb_under_d65,
};
use super::error::{CurveError, Place};
use super::piecewise_linear::PiecewiseLinear;
use super::upsampling::SigmoidPolynomial;
use super::values::Spectrum;
use super::wavelengths::Wavelengths;

/// A reflectance, an emission (radiance, radiant intensity, irradiance) or an optical index of the scene.
///
/// It holds the form that spectral rendering needs and the one for rendering in three channels. Both follow
/// Mitsuba 3: the same scene has the same colours there.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectralCurve {
    /// Linear sRGB.
    rgb: [f32; 3],
    /// The function of the wavelength.
    shape: Shape,
}

/// The kinds of functions of the wavelength.
#[derive(Clone, Debug, PartialEq)]
enum Shape {
    Constant(f32),
    Tabulated(PiecewiseLinear),
    /// A colour of a surface.
    Sigmoid(SigmoidPolynomial),
    /// A quantity without an upper bound: a colour multiplied by `scale`.
    ScaledSigmoid {
        colour: SigmoidPolynomial,
        scale: f32,
    },
    /// A colour of a lamp: D65 filtered by a colour and multiplied by `scale`.
    FilteredD65 {
        filter: SigmoidPolynomial,
        scale: f32,
    },
}

/// The greatest emission: far above all that is real, and far from the overflow of `f32`.
const MAX_EMISSION: f32 = 1e30;

/// The greatest index of refraction or absorption: far above all that is real.
const MAX_INDEX: f32 = 1e6;

/// The sodium D line, at which indices of refraction are told, in nm.
const SODIUM_D: f32 = 589.3;

impl SpectralCurve {
    /// Nothing at any wavelength.
    pub const BLACK: Self = Self {
        rgb: [0.0; 3],
        shape: Shape::Constant(0.0),
    };

    /// The same reflectance at all wavelengths, and in all channels.
    ///
    /// # Errors
    /// A `reflectance` outside [0, 1].
    pub fn constant_reflectance(reflectance: f32) -> Result<Self, CurveError> {
        check_reflectance(reflectance, Place::Everywhere)?;
        Ok(Self {
            rgb: [reflectance; 3],
            shape: Shape::Constant(reflectance),
        })
    }

    /// The same emission per nm at all wavelengths. In linear sRGB this is the colour of the illuminant E,
    /// (1.205, 0.948, 0.909), times `emission`.
    ///
    /// # Errors
    /// An `emission` that is negative, greater than 1e30 or not a number.
    pub fn constant_emission(emission: f32) -> Result<Self, CurveError> {
        check_emission(emission, Place::Everywhere)?;
        let rgb = ILLUMINANT_E.map(|channel| channel as f32 * emission);
        Ok(Self {
            rgb,
            shape: Shape::Constant(emission),
        })
    }

    /// A measured reflectance by its `entries` (wavelength in nm, reflectance) in the order of increasing
    /// wavelength: linear between them and zero outside their range. Its linear sRGB colour is the one under D65,
    /// limited to [0, 1].
    ///
    /// # Errors
    /// Fewer than two entries, wavelengths that are not positive and increasing, a reflectance outside [0, 1].
    pub fn tabulated_reflectance(entries: &[(f32, f32)]) -> Result<Self, CurveError> {
        let table = PiecewiseLinear::new(entries, check_reflectance)?;
        Ok(Self {
            rgb: srgb_of_reflectance(|nm| table.at(nm)),
            shape: Shape::Tabulated(table),
        })
    }

    /// A measured emission by its `entries` (wavelength in nm, emission per nm) in the order of increasing
    /// wavelength: linear between them and zero outside their range. Its linear sRGB colour has no upper limit;
    /// negative components, of colours outside the sRGB gamut, become zero.
    ///
    /// # Errors
    /// Fewer than two entries, wavelengths that are not positive and increasing, an emission that is negative,
    /// greater than 1e30 or not a number.
    pub fn tabulated_emission(entries: &[(f32, f32)]) -> Result<Self, CurveError> {
        let table = PiecewiseLinear::new(entries, check_emission)?;
        Ok(Self {
            rgb: srgb_of_emission(|nm| table.at(nm)),
            shape: Shape::Tabulated(table),
        })
    }

    /// A reflectance whose colour under D65 is `rgb` (linear sRGB): a smooth spectrum after Jakob and Hanika 2019.
    ///
    /// # Errors
    /// A component outside [0, 1].
    pub fn rgb_reflectance(rgb: [f32; 3]) -> Result<Self, CurveError> {
        for (channel, value) in rgb.into_iter().enumerate() {
            check_reflectance(value, Place::Channel(channel))?;
        }
        let shape = match rgb {
            [r, g, b] if r == g && g == b => Shape::Constant(r),
            _ => Shape::Sigmoid(SigmoidPolynomial::fit(rgb)),
        };
        Ok(Self { rgb, shape })
    }

    /// An emission of the colour `rgb` (linear sRGB): the illuminant D65 (of luminance 1) filtered by the smooth
    /// spectrum of the same hue whose greatest component is one half, scaled to `rgb`.
    ///
    /// # Errors
    /// A component that is negative, greater than 1e30 or not a number.
    pub fn rgb_emission(rgb: [f32; 3]) -> Result<Self, CurveError> {
        for (channel, value) in rgb.into_iter().enumerate() {
            check_emission(value, Place::Channel(channel))?;
        }
        let scale = 2.0 * rgb.into_iter().fold(0.0, f32::max);
        if scale == 0.0 {
            return Ok(Self::BLACK);
        }
        let filter = SigmoidPolynomial::fit(rgb.map(|channel| (channel / scale).min(0.5)));
        Ok(Self {
            rgb,
            shape: Shape::FilteredD65 { filter, scale },
        })
    }

    /// The same index, of refraction or of absorption, at all wavelengths and in all channels.
    ///
    /// # Errors
    /// An `index` that is negative, greater than 1e6 or not a number.
    pub fn constant_index(index: f32) -> Result<Self, CurveError> {
        check_index(index, Place::Everywhere)?;
        Ok(Self {
            rgb: [index; 3],
            shape: Shape::Constant(index),
        })
    }

    /// A measured index of a conductor by its `entries` (wavelength in nm, index) in the order of increasing wavelength:
    /// linear between them and zero outside their range. Its three channels are those of its colour under D65.
    ///
    /// # Errors
    /// Fewer than two entries, wavelengths that are not positive and increasing, an index that is negative, greater than
    /// 1e6 or not a number.
    pub fn tabulated_index(entries: &[(f32, f32)]) -> Result<Self, CurveError> {
        let table = PiecewiseLinear::new(entries, check_index)?;
        Ok(Self {
            rgb: srgb_under_d65(|nm| table.at(nm)).map(|channel| channel.max(0.0) as f32),
            shape: Shape::Tabulated(table),
        })
    }

    /// As [`Self::tabulated_index`], but its three channels are those of its colour under the illuminant E: Mitsuba's
    /// meaning of its tables of materials.
    ///
    /// # Errors
    /// As [`Self::tabulated_index`].
    pub fn material_index(entries: &[(f32, f32)]) -> Result<Self, CurveError> {
        let table = PiecewiseLinear::new(entries, check_index)?;
        Ok(Self {
            rgb: srgb_of_emission(|nm| table.at(nm)),
            shape: Shape::Tabulated(table),
        })
    }

    /// An index of a conductor in three channels; by wavelength, a smooth spectrum of that colour.
    ///
    /// # Errors
    /// A component that is negative, greater than 1e6 or not a number.
    pub fn rgb_index(rgb: [f32; 3]) -> Result<Self, CurveError> {
        for (channel, value) in rgb.into_iter().enumerate() {
            check_index(value, Place::Channel(channel))?;
        }
        let scale = 2.0 * rgb.into_iter().fold(0.0, f32::max);
        let shape = match rgb {
            [r, g, b] if r == g && g == b => Shape::Constant(r),
            _ => Shape::ScaledSigmoid {
                colour: SigmoidPolynomial::fit(rgb.map(|channel| (channel / scale).min(0.5))),
                scale,
            },
        };
        Ok(Self { rgb, shape })
    }

    /// The index of refraction of a glass by its `entries`, as [`Self::tabulated_index`]. In three channels it is the one at
    /// the sodium D line in all of them: only single wavelengths can be refracted apart.
    ///
    /// # Errors
    /// As [`Self::tabulated_index`].
    pub fn glass_index(entries: &[(f32, f32)]) -> Result<Self, CurveError> {
        let table = PiecewiseLinear::new(entries, check_index)?;
        Ok(Self {
            rgb: [table.at(SODIUM_D); 3],
            shape: Shape::Tabulated(table),
        })
    }

    /// The colour as linear sRGB.
    #[inline]
    pub fn rgb(&self) -> [f32; 3] {
        self.rgb
    }

    /// Whether it is zero at all wavelengths.
    pub fn is_black(&self) -> bool {
        match &self.shape {
            Shape::Constant(value) => *value == 0.0,
            Shape::Tabulated(table) => table.is_zero(),
            Shape::Sigmoid(_) | Shape::ScaledSigmoid { .. } | Shape::FilteredD65 { .. } => {
                self.rgb == [0.0; 3]
            }
        }
    }

    /// Whether it is the same at all wavelengths.
    pub fn is_constant(&self) -> bool {
        matches!(self.shape, Shape::Constant(_))
    }

    /// Whether it is above zero at every wavelength that paths carry.
    pub fn is_positive_in_light(&self) -> bool {
        let nanometres = WAVELENGTH_MIN as u16..=WAVELENGTH_MAX as u16;
        let mut values = nanometres.map(|nm| self.evaluate(&Wavelengths::at([f32::from(nm)]))[0]);
        values.all(|value| value > 0.0)
    }

    /// The values at `wavelengths`.
    #[inline(always)]
    pub fn evaluate<const N: usize>(&self, wavelengths: &Wavelengths<N>) -> Spectrum<N> {
        // One branch for all wavelengths, and a loop that the compiler can vectorise in each arm.
        let nm = wavelengths.nm();
        let mut values = [0.0; N];
        match &self.shape {
            Shape::Constant(value) => values = [*value; N],
            Shape::Tabulated(PiecewiseLinear::Regular(table)) => values = table.evaluate(nm),
            Shape::Tabulated(PiecewiseLinear::Irregular(table)) => {
                for i in 0..N {
                    values[i] = table.at(nm[i]);
                }
            }
            Shape::Sigmoid(reflectance) => {
                for i in 0..N {
                    values[i] = reflectance.at(nm[i]);
                }
            }
            Shape::ScaledSigmoid { colour, scale } => {
                for i in 0..N {
                    values[i] = scale * colour.at(nm[i]);
                }
            }
            Shape::FilteredD65 { filter, scale } => {
                for i in 0..N {
                    values[i] = scale * filter.at(nm[i]) * illuminant_d65(nm[i]);
                }
            }
        }
        Spectrum(values)
    }
}

/// Refuses what is not a reflectance; `place` tells the user where it stands.
fn check_reflectance(value: f32, place: Place) -> Result<(), CurveError> {
    if (0.0..=1.0).contains(&value) {
        Ok(())
    } else {
        Err(CurveError::InvalidReflectance { value, place })
    }
}

/// Refuses what is not an index of refraction or absorption; `place` tells the user where it stands.
fn check_index(value: f32, place: Place) -> Result<(), CurveError> {
    if (0.0..=MAX_INDEX).contains(&value) {
        Ok(())
    } else {
        Err(CurveError::InvalidIndex { value, place })
    }
}

/// Refuses what is not an emission; `place` tells the user where it stands.
fn check_emission(value: f32, place: Place) -> Result<(), CurveError> {
    if (0.0..=MAX_EMISSION).contains(&value) {
        Ok(())
    } else {
        Err(CurveError::InvalidEmission { value, place })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Where Mitsuba 3.9.1 was asked for the values below, in nm.
    const NM: [f32; 4] = [410.0, 480.0, 550.0, 650.0];

    #[track_caller]
    fn assert_close<const N: usize>(ours: [f32; N], mitsuba: [f32; N], tolerance: f32) {
        for (a, b) in ours.into_iter().zip(mitsuba) {
            assert!(
                (a - b).abs() <= tolerance,
                "{ours:?} instead of {mitsuba:?}"
            );
        }
    }

    fn values(curve: &SpectralCurve) -> [f32; 4] {
        curve.evaluate(&Wavelengths::at(NM)).0
    }

    #[test]
    fn constants_are_constant_reflectances_and_the_illuminant_e() {
        let reflectance = SpectralCurve::constant_reflectance(0.5).unwrap();
        assert_eq!(
            (reflectance.rgb(), values(&reflectance)),
            ([0.5; 3], [0.5; 4])
        );
        let emission = SpectralCurve::constant_emission(2.0).unwrap();
        assert_close(emission.rgb(), [2.40959, 1.89658, 1.81783], 1e-5);
        assert_eq!(values(&emission), [2.0; 4]);
    }

    #[test]
    fn tables_have_mitsubas_colours() {
        let flat = [(360.0, 1.0), (830.0, 1.0)];
        let reflectance = SpectralCurve::tabulated_reflectance(&flat).unwrap();
        assert_close(reflectance.rgb(), [0.998985, 0.998874, 0.998802], 2e-6);
        let emission = SpectralCurve::tabulated_emission(&flat).unwrap();
        assert_close(emission.rgb(), [1.20488, 0.948228, 0.909267], 5e-6);

        let irregular = [(400.0, 0.343), (404.0, 0.445), (500.0, 0.2), (700.0, 0.4)];
        let reflectance = SpectralCurve::tabulated_reflectance(&irregular).unwrap();
        assert_close(reflectance.rgb(), [0.350856, 0.229242, 0.323214], 2e-6);
        let expected = [
            0.445 - 0.245 * 6.0 / 96.0,
            0.445 - 0.245 * 76.0 / 96.0,
            0.25,
            0.35,
        ];
        assert_close(values(&reflectance), expected, 1e-6);

        let regular = [(400.0, 0.0), (500.0, 8.0), (600.0, 15.6), (700.0, 18.4)];
        let emission = SpectralCurve::tabulated_emission(&regular).unwrap();
        assert_close(emission.rgb(), [20.7108, 10.8546, 2.77115], 5e-5);
        assert_close(values(&emission), [0.8, 6.4, 11.8, 17.0], 1e-5);
    }

    #[test]
    fn indices_have_mitsubas_channels() {
        // mi.load_string('<bsdf version="3.0.0" type="conductor"><spectrum name="eta" value="…"/></bsdf>'), scalar_rgb
        let table = [(400.0, 1.3), (500.0, 2.0), (700.0, 0.7)];
        let index = SpectralCurve::tabulated_index(&table).unwrap();
        assert_close(index.rgb(), [1.03118, 1.7723, 1.67554], 1e-5);
        assert_close(values(&index), [1.37, 1.86, 1.675, 1.025], 1e-5);
        let material = SpectralCurve::material_index(&table).unwrap();
        assert_eq!(values(&material), values(&index));
        let glass = SpectralCurve::glass_index(&table).unwrap();
        assert_close(glass.rgb(), [1.41955; 3], 1e-5);
        assert_eq!(values(&glass), values(&index));
        assert_eq!(
            values(&SpectralCurve::constant_index(2.5).unwrap()),
            [2.5; 4]
        );
        assert_eq!(
            SpectralCurve::constant_index(-1.0).unwrap_err().to_string(),
            "index -1 is not a number from 0 to 1e6"
        );
    }

    #[test]
    fn colours_outside_the_gamut_lose_their_negative_part() {
        let narrow = [(500.0, 1.0), (510.0, 1.0)];
        let emission = SpectralCurve::tabulated_emission(&narrow).unwrap();
        assert_close(emission.rgb(), [0.0, 0.0712441, 0.0133142], 1e-6);
        let reflectance = SpectralCurve::tabulated_reflectance(&narrow).unwrap();
        assert_close(reflectance.rgb(), [0.0, 0.0781108, 0.0146232], 1e-6);
    }

    #[test]
    fn rgb_reflectances_have_mitsubas_spectra() {
        for (rgb, mitsuba) in [
            (
                [0.63, 0.065, 0.05],
                [0.0972351, 0.0532586, 0.0876478, 0.898048],
            ),
            (
                [0.14, 0.45, 0.091],
                [0.0301978, 0.220153, 0.45912, 0.0631665],
            ),
            (
                [0.725, 0.71, 0.68],
                [0.666024, 0.693158, 0.711245, 0.723565],
            ),
            ([0.05, 0.1, 0.6], [0.843475, 0.335924, 0.107164, 0.0552814]),
        ] {
            let curve = SpectralCurve::rgb_reflectance(rgb).unwrap();
            assert_eq!(curve.rgb(), rgb);
            assert_close(values(&curve), mitsuba, 2e-3);
        }
    }

    #[test]
    fn rgb_emissions_are_filtered_daylight_as_in_mitsuba() {
        for (rgb, mitsuba) in [
            ([17.0, 12.0, 4.0], [2.48017, 7.83187, 13.2149, 12.4462]),
            ([2.0, 2.0, 2.0], [1.84825, 2.34194, 2.10199, 1.61675]),
        ] {
            let curve = SpectralCurve::rgb_emission(rgb).unwrap();
            assert_eq!(curve.rgb(), rgb);
            assert_close(values(&curve), mitsuba, 1e-2);
        }
        assert_eq!(
            SpectralCurve::rgb_emission([0.0; 3]),
            Ok(SpectralCurve::BLACK)
        );
    }

    #[test]
    fn black_is_known() {
        assert!(SpectralCurve::constant_emission(0.0).unwrap().is_black());
        assert!(SpectralCurve::rgb_reflectance([0.0; 3]).unwrap().is_black());
        assert!(
            SpectralCurve::tabulated_emission(&[(400.0, 0.0), (500.0, 0.0)])
                .unwrap()
                .is_black()
        );
        assert!(
            !SpectralCurve::tabulated_emission(&[(400.0, 0.0), (500.0, 1.0)])
                .unwrap()
                .is_black()
        );
        assert!(
            !SpectralCurve::rgb_emission([0.0, 0.0, 1e-6])
                .unwrap()
                .is_black()
        );
    }

    #[test]
    fn impossible_values_are_errors_that_name_the_place() {
        for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.1, 1.5] {
            let place = Place::Everywhere;
            assert!(matches!(
                SpectralCurve::constant_reflectance(bad),
                Err(CurveError::InvalidReflectance { place: p, .. }) if p == place
            ));
            assert!(SpectralCurve::rgb_reflectance([0.5, bad, 0.5]).is_err());
            assert!(SpectralCurve::tabulated_reflectance(&[(400.0, 0.5), (500.0, bad)]).is_err());
        }
        for bad in [f32::NAN, f32::INFINITY, -0.1, 1e38] {
            assert!(SpectralCurve::constant_emission(bad).is_err());
            assert!(SpectralCurve::rgb_emission([1.0, 1.0, bad]).is_err());
            assert!(SpectralCurve::tabulated_emission(&[(400.0, bad), (500.0, 1.0)]).is_err());
        }
        assert_eq!(
            SpectralCurve::rgb_reflectance([0.5, 1.5, 0.5])
                .unwrap_err()
                .to_string(),
            "reflectance 1.5 of the green channel is not in the range from 0 to 1"
        );
        assert_eq!(
            SpectralCurve::tabulated_emission(&[(400.0, 1.0), (500.0, -1.0)])
                .unwrap_err()
                .to_string(),
            "emission -1 at 500 nm is not a number from 0 to 1e30"
        );
    }

    proptest! {
        #[test]
        fn no_input_panics_and_what_is_accepted_is_finite(
            entries in prop::collection::vec((prop::num::f32::ANY, prop::num::f32::ANY), 0..5),
            rgb in prop::array::uniform3(prop::num::f32::ANY),
            u in 0.0f32..1.0,
        ) {
            let curves = [
                SpectralCurve::tabulated_emission(&entries),
                SpectralCurve::tabulated_reflectance(&entries),
                SpectralCurve::rgb_emission(rgb),
                SpectralCurve::rgb_reflectance(rgb),
            ];
            for curve in curves.into_iter().flatten() {
                let values = curve.evaluate(&Wavelengths::<4>::sample(u)).0;
                prop_assert!(values.iter().chain(&curve.rgb()).all(|v| v.is_finite() && *v >= 0.0), "{curve:?}");
            }
        }

        #[test]
        fn accepted_inputs_of_any_size_stay_finite(
            exponents in prop::array::uniform3(-45.0f32..30.0),
            u in 0.0f32..1.0,
        ) {
            let rgb = exponents.map(|e| 10.0f32.powf(e).min(1e30));
            let emission = SpectralCurve::rgb_emission(rgb).unwrap();
            let values = emission.evaluate(&Wavelengths::<4>::sample(u)).0;
            prop_assert!(values.iter().all(|v| v.is_finite() && *v >= 0.0), "{emission:?}");
            let reflectance = SpectralCurve::rgb_reflectance(rgb.map(|v| v.min(1.0))).unwrap();
            let values = reflectance.evaluate(&Wavelengths::<4>::sample(u)).0;
            prop_assert!(values.iter().all(|v| (0.0..=1.0).contains(v)), "{reflectance:?}");
        }
    }
}
