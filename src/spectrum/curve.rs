//! The colours of a scene, each as a function of the wavelength and as linear sRGB.

use super::cie::{
    ILLUMINANT_E, WAVELENGTH_MAX, WAVELENGTH_MIN, illuminant_d65, srgb_of_emission,
    srgb_of_reflectance, srgb_under_d65,
};
use super::error::{CurveError, Place};
use super::piecewise_linear::{PiecewiseLinear, RegularTable};
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

impl Shape {
    /// That of a table: a constant where it is flat in visible light.
    fn of_table(table: PiecewiseLinear) -> Self {
        match table.flat_between(WAVELENGTH_MIN, WAVELENGTH_MAX) {
            Some(value) => Self::Constant(value),
            None => Self::Tabulated(table),
        }
    }
}

/// The greatest emission: far above all that is real, and far from the overflow of `f32`.
pub const MAX_EMISSION: f32 = 1e30;

/// The greatest index of refraction or absorption: far above all that is real.
pub const MAX_INDEX: f32 = 1e6;

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
            shape: Shape::of_table(table),
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
            shape: Shape::of_table(table),
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

    /// An emission with the spectrum of a reflectance: white is equal energy. As [`Self::rgb_reflectance`] up to 1; a
    /// greater colour is that of its greatest component, times it.
    ///
    /// # Errors
    /// A component that is negative, greater than 1e30 or not a number.
    pub fn rgb_unbounded(rgb: [f32; 3]) -> Result<Self, CurveError> {
        Self::rgb_unbounded_times(rgb, 1.0)
    }

    /// [`Self::rgb_unbounded`] of `rgb`, multiplied by `factor`.
    ///
    /// # Errors
    /// A component that is negative, greater than 1e30 or not a number, before or after.
    pub fn rgb_unbounded_times(rgb: [f32; 3], factor: f32) -> Result<Self, CurveError> {
        let product = rgb.map(|channel| channel * factor);
        for colour in [rgb, product] {
            for (channel, value) in colour.into_iter().enumerate() {
                check_emission(value, Place::Channel(channel))?;
            }
        }
        let scale = rgb.into_iter().fold(1.0, f32::max);
        let shape = match product {
            [r, g, b] if r == g && g == b => Shape::Constant(r),
            _ => Shape::ScaledSigmoid {
                colour: SigmoidPolynomial::fit(rgb.map(|channel| channel / scale)),
                scale: scale * factor,
            },
        };
        Ok(Self {
            rgb: product,
            shape,
        })
    }

    /// A measured emission whose linear sRGB colour is that of a reflectance, the one under D65, without the upper limit.
    ///
    /// # Errors
    /// As [`Self::tabulated_emission`].
    pub fn tabulated_unbounded(entries: &[(f32, f32)]) -> Result<Self, CurveError> {
        let table = PiecewiseLinear::new(entries, check_emission)?;
        Ok(Self {
            rgb: srgb_under_d65(|nm| table.at(nm)).map(|channel| channel.max(0.0) as f32),
            shape: Shape::of_table(table),
        })
    }

    /// The illuminant D65 (of luminance 1) filtered by this reflectance, or by this emission with the spectrum of one; none for
    /// measured ones.
    pub fn filtering_d65(&self) -> Option<Self> {
        let (filter, scale) = match &self.shape {
            Shape::Constant(value) => return Self::rgb_emission([*value; 3]).ok(),
            Shape::Sigmoid(colour) => (*colour, 1.0),
            Shape::ScaledSigmoid { colour, scale } => (*colour, *scale),
            Shape::Tabulated(_) | Shape::FilteredD65 { .. } => return None,
        };
        Some(Self {
            rgb: self.rgb,
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
            shape: Shape::of_table(table),
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
            shape: Shape::of_table(table),
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
            shape: Shape::of_table(table),
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

    /// The measured values that it is made of, if they stand at equal distances.
    #[inline(always)]
    pub(super) fn regular_table(&self) -> Option<&RegularTable> {
        match &self.shape {
            Shape::Tabulated(PiecewiseLinear::Regular(table)) => Some(table),
            _ => None,
        }
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
mod tests;
