//! Light by wavelength: the wavelengths that a path carries, the colours of the scene as curves over the
//! wavelength or as linear sRGB, and the way back from a path's radiance to linear sRGB.
//!
//! Conventions, the same as Mitsuba 3's so that both programs render the same scene alike:
//! * wavelengths are in nanometres of vacuum and lie in [`WAVELENGTH_MIN`]`..=`[`WAVELENGTH_MAX`];
//! * RGB is linear sRGB (ITU-R BT.709 primaries, white point D65), with 1 for the luminance of "one" of
//!   [`SpectralCurve::rgb_emission`];
//! * the engine is generic over [`Colour`]: [`Rgb`] carries three channels, [`Spectral`] a number of wavelengths.

mod cie;
mod cie_tables;
mod colour;
mod curve;
mod curve_lanes;
mod emission_image;
mod error;
mod piecewise_linear;
mod reflectances;
mod rgb_lanes;
mod upsampling;
mod values;
mod wavelengths;

pub use cie::{WAVELENGTH_MAX, WAVELENGTH_MIN, xyz_from_srgb};
pub use colour::{Colour, Rgb, Spectral};
pub use curve::{MAX_EMISSION, MAX_INDEX, SpectralCurve};
pub use emission_image::{BetweenTexels, EmissionImage};
pub use error::{CurveError, Place};
pub use reflectances::Reflectances;
pub use values::{Spectrum, SpectrumArithmetic};
pub use wavelengths::Wavelengths;
