//! `constant`: surroundings that send the same radiance from every direction.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `radiance` | spectrum | incident radiance in W/(m^2 sr nm), or in linear sRGB | 1 |

use super::LightSample;
use crate::sampling::{SolidAnglePdf, warp};
use crate::scene::error::SceneError;
use crate::scene::spectra::{Quantity, spectrum_or};
use crate::scene::xml::Object;
use crate::spectrum::{Colour, SpectralCurve};

/// Uniform surroundings.
#[derive(Clone, Debug)]
pub struct ConstantLight {
    /// The radiance that arrives from everywhere.
    pub radiance: SpectralCurve,
}

impl Default for ConstantLight {
    /// Equal energy of radiance 1.
    fn default() -> Self {
        let radiance = SpectralCurve::constant_emission(1.0);
        Self {
            radiance: radiance.unwrap_or(SpectralCurve::BLACK),
        }
    }
}

impl ConstantLight {
    pub(super) fn load(object: &Object) -> Result<Self, SceneError> {
        let radiance = spectrum_or(object, "radiance", Quantity::Emission, 1.0)?;
        object.finish()?;
        Ok(Self { radiance })
    }

    /// The radiance that arrives from any direction.
    #[inline]
    pub fn radiance<C: Colour>(&self, wavelengths: &C::Wavelengths) -> C::Spectrum {
        C::evaluate(&self.radiance, wavelengths)
    }

    /// The density with which `sample` draws any direction.
    #[inline]
    pub fn pdf(&self) -> SolidAnglePdf {
        warp::SPHERE_PDF
    }

    #[inline]
    pub(super) fn sample<C: Colour>(
        &self,
        wavelengths: &C::Wavelengths,
        u: [f32; 2],
    ) -> LightSample<C::Spectrum> {
        LightSample {
            direction: warp::sphere(u),
            distance: f32::INFINITY,
            surface: None,
            weight: self.radiance::<C>(wavelengths) / self.pdf().0,
            pdf: Some(self.pdf()),
        }
    }
}
