//! `directional`: light from infinitely far away that comes from one direction. Only next-event estimation can find it.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `irradiance` | spectrum | power per area that faces the light, in W/(m^2 nm), or in linear sRGB | 1 |
//! | `direction` | vector | where the light goes to, any length but 0 | 0, 0, 1 |
//! | `to_world` | transform | turns the direction +z; may not be given beside `direction` | identity |

use glam::{DVec3, Vec3};

use super::LightSample;
use crate::scene::error::SceneError;
use crate::scene::spectra::{Quantity, spectrum_or};
use crate::scene::xml::Object;
use crate::spectrum::{Colour, SpectralCurve};

/// A light that comes from one direction.
#[derive(Clone, Debug)]
pub struct DirectionalLight {
    /// Where the light goes to: a unit vector in world space.
    pub direction: Vec3,
    /// Power per area that faces the light.
    pub irradiance: SpectralCurve,
}

impl DirectionalLight {
    pub(super) fn load(object: &Object) -> Result<Self, SceneError> {
        let irradiance = spectrum_or(object, "irradiance", Quantity::Emission, 1.0)?;
        let (name, direction) = match (object.vector("direction")?, object.transform("to_world")?) {
            (Some(_), Some(_)) => {
                let message = "`direction` and `to_world` cannot both be given";
                return Err(object.parameter_error("to_world", message));
            }
            (Some(direction), None) => ("direction", direction),
            (None, Some(to_world)) => ("to_world", to_world.transform_vector3(DVec3::Z)),
            (None, None) => ("direction", DVec3::Z),
        };
        object.finish()?;
        let direction = direction.try_normalize().ok_or_else(|| {
            object.parameter_error(name, format!("`{name}` leaves the light no direction"))
        })?;
        Ok(Self {
            direction: direction.as_vec3(),
            irradiance,
        })
    }

    #[inline]
    pub(super) fn sample<C: Colour>(
        &self,
        wavelengths: &C::Wavelengths,
    ) -> LightSample<C::Spectrum> {
        LightSample {
            direction: -self.direction,
            distance: f32::INFINITY,
            surface: None,
            weight: C::evaluate(&self.irradiance, wavelengths),
            pdf: None,
        }
    }
}
