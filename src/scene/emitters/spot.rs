//! `spot`: a point light with a cone of light about its +z axis. Only next-event estimation can find it.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `intensity` | spectrum | radiant intensity within the beam, in W/(sr nm), or in linear sRGB | 1 |
//! | `cutoff_angle` | float | angle from the axis in degrees, in (0, 180], beyond which there is no light | 20 |
//! | `beam_width` | float | angle from the axis in degrees, up to the cutoff, within which the intensity is full | 3/4 of the cutoff |
//! | `texture` | texture | factor for the intensity, in [0, 1]; its square holds the cone, which is then narrower than 90 degrees | 1 |
//! | `to_world` | transform | moves and turns the light; one that scales unevenly makes the cone elliptical | identity |
//!
//! Between beam and cutoff the intensity falls linearly with the angle.

use glam::{DMat3, DMat4, Mat3, Vec2, Vec3};

use super::LightSample;
use crate::scene::error::SceneError;
use crate::scene::light_choice::Cone;
use crate::scene::load::Loader;
use crate::scene::spectra::{Quantity, spectrum_or};
use crate::scene::xml::Object;
use crate::scene::{SpectrumTexture, SurfaceParameters};
use crate::spectrum::{Colour, SpectralCurve};

/// A spot light.
#[derive(Clone, Debug)]
pub struct SpotLight {
    /// Position in world space.
    pub position: Vec3,
    /// Radiant intensity within the beam.
    pub intensity: SpectralCurve,
    /// What the intensity is multiplied by: it fills the cone.
    texture: SpectrumTexture,
    /// From directions in world space to those in which the axis is +z.
    to_local: Mat3,
    cutoff: Angle,
    beam: Angle,
}

/// An angle and its cosine.
#[derive(Clone, Copy, Debug)]
struct Angle {
    radians: f32,
    cosine: f32,
}

impl Angle {
    fn from_degrees(degrees: f64) -> Self {
        let radians = degrees.to_radians();
        Self {
            radians: radians as f32,
            cosine: radians.cos() as f32,
        }
    }
}

impl SpotLight {
    /// Whether it throws an image.
    pub fn is_textured(&self) -> bool {
        self.texture.varies()
    }

    pub(super) fn load(object: &Object, loader: &mut Loader) -> Result<Self, SceneError> {
        let intensity = spectrum_or(object, "intensity", Quantity::Emission, 1.0)?;
        let texture = loader.textures.reflectance(object, "texture", 1.0)?;
        let cutoff = object.float_or("cutoff_angle", 20.0)?;
        if !(cutoff > 0.0 && cutoff <= 180.0) {
            let message = format!("`cutoff_angle` is {cutoff}; it must be above 0 and at most 180");
            return Err(object.parameter_error("cutoff_angle", message));
        }
        if texture.varies() && cutoff >= 90.0 {
            let message = "a spot with a `texture` needs a `cutoff_angle` below 90";
            return Err(object.parameter_error("cutoff_angle", message));
        }
        let beam = object.float_or("beam_width", 0.75 * cutoff)?;
        if !(beam >= 0.0 && beam <= cutoff) {
            let message = format!("`beam_width` is {beam}; it must be from 0 to `cutoff_angle`");
            return Err(object.parameter_error("beam_width", message));
        }
        let to_world = object.transform("to_world")?.unwrap_or(DMat4::IDENTITY);
        object.finish()?;
        let to_local = DMat3::from_mat4(to_world).inverse().as_mat3();
        let position = to_world.w_axis.truncate().as_vec3();
        if !(to_local.is_finite() && position.is_finite()) {
            let message =
                "`to_world` of the light has no inverse, or goes beyond 32-bit coordinates";
            return Err(object.parameter_error("to_world", message));
        }
        Ok(Self {
            position,
            intensity,
            texture,
            to_local,
            cutoff: Angle::from_degrees(cutoff),
            beam: Angle::from_degrees(beam),
        })
    }

    /// Takes out the image.
    pub(in crate::scene) fn make_even(&mut self) {
        self.texture.make_uniform();
    }

    /// The directions in world space into which it shines; `None` where they are no circular cone.
    pub fn directions(&self) -> Option<Cone> {
        let local = self.to_local * (1.0 / self.to_local.determinant().abs().cbrt());
        let deviation = local.transpose() * local - Mat3::IDENTITY;
        let is_round = deviation
            .to_cols_array()
            .iter()
            .all(|deviation| deviation.abs() < 1e-4);
        is_round.then(|| Cone {
            axis: (local.transpose() * Vec3::Z).normalize(),
            angle: self.cutoff.radians,
        })
    }

    /// The share of the full intensity that leaves in a local direction (unit), in [0, 1].
    #[inline]
    fn falloff(&self, local: Vec3) -> f32 {
        let cosine = local.z;
        if cosine >= self.beam.cosine {
            1.0
        } else if cosine > self.cutoff.cosine {
            let transition = self.cutoff.radians - self.beam.radians;
            ((self.cutoff.radians - cosine.acos()) / transition).clamp(0.0, 1.0)
        } else {
            0.0
        }
    }

    #[inline]
    pub(super) fn sample<C: Colour>(
        &self,
        reference: Vec3,
        wavelengths: &C::Wavelengths,
    ) -> Option<LightSample<C::Spectrum>> {
        let offset = self.position - reference;
        let distance = offset.length();
        let direction = offset / distance;
        let local = (self.to_local * -direction).normalize_or_zero();
        let falloff = self.falloff(local);
        if !(distance > 0.0 && falloff > 0.0) {
            return None;
        }
        let half_size = local.z * self.cutoff.radians.tan();
        let on_texture = SurfaceParameters {
            uv: 0.5 + 0.5 * Vec2::new(local.x, local.y) / half_size,
            ..SurfaceParameters::default()
        };
        let intensity = C::evaluate(&self.intensity, wavelengths)
            * self.texture.spectrum::<C>(&on_texture, wavelengths);
        Some(LightSample {
            direction,
            distance,
            surface: None,
            weight: intensity * (falloff / (distance * distance)),
            pdf: None,
        })
    }
}
