//! `point`: an isotropic point light. Only next-event estimation can find it.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `intensity` | spectrum | radiant intensity in W/(sr nm), or in linear sRGB | 1 |
//! | `position` | point | where it stands | 0, 0, 0 |
//! | `to_world` | transform | moves the position; may not be given beside it | identity |

use glam::{DVec3, Vec3};

use super::LightSample;
use crate::scene::error::SceneError;
use crate::scene::spectra::{Quantity, spectrum_or};
use crate::scene::xml::Object;
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
    pub(super) fn load(object: &Object) -> Result<Self, SceneError> {
        let intensity = spectrum_or(object, "intensity", Quantity::Emission, 1.0)?;
        let position = match (object.vector("position")?, object.transform("to_world")?) {
            (Some(_), Some(_)) => {
                let message = "`position` and `to_world` cannot both be given";
                return Err(object.parameter_error("to_world", message));
            }
            (Some(position), None) => position,
            (None, Some(to_world)) => to_world.transform_point3(DVec3::ZERO),
            (None, None) => DVec3::ZERO,
        };
        object.finish()?;
        let position = position.as_vec3();
        if !position.is_finite() {
            return Err(object.error("the light is too far away for 32-bit coordinates"));
        }
        Ok(Self {
            position,
            intensity,
        })
    }

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
            surface: None,
            weight: C::evaluate(&self.intensity, wavelengths) / (distance * distance),
            pdf: None,
        })
    }
}
