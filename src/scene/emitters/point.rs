//! `point`: an isotropic point light. Only next-event estimation can find it.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `intensity` | spectrum | radiant intensity in W/(sr nm), or in linear sRGB | 1 |
//! | `position` | point | where it stands | 0, 0, 0 |
//! | `to_world` | transform | moves the position; may not be given beside it | identity |

use glam::Vec3;

use super::LightSample;
use crate::spectrum::{Colour, SpectralCurve};

/// A point light.
#[derive(Clone, Debug)]
pub struct PointLight {
    /// Position in world space.
    pub position: Vec3,
    /// Radiant intensity.
    pub intensity: SpectralCurve,
}

impl PointLight {
    #[inline]
    pub(super) fn sample<C: Colour>(
        &self,
        reference: Vec3,
        wavelengths: &C::Wavelengths,
    ) -> Option<LightSample<C::Spectrum>> {
        let offset = self.position - reference;
        let distance = offset.length();
        (distance > 0.0).then(|| LightSample {
            direction: offset / distance,
            distance,
            weight: C::evaluate(&self.intensity, wavelengths) / (distance * distance),
            pdf: None,
        })
    }
}
