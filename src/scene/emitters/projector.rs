//! `projector`: a point that casts an image, as a camera would see it. Only next-event estimation can find it.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `irradiance` | `bitmap`, or spectrum | irradiance of a plane at the distance 1 that it faces, divided by pi | 1 |
//! | `scale` | float | factor for it, from 0 to 1e30 | 1 |
//! | `fov` | float | field of view in degrees along `fov_axis`, in (0, 180) | see `focal_length` |
//! | `focal_length` | string | the same as a 35 mm equivalent such as `50mm`, along the diagonal | 50mm |
//! | `fov_axis` | string | `x`, `y`, `diagonal`, `smaller` or `larger` | x |
//! | `to_world` | transform | projector to world, without scaling: it looks along +z, +y is up, +x is left | identity |
//!
//! By wavelength an image has the spectra of reflectances, as in Mitsuba: its white is equal energy, not the white of sRGB.

use std::f32::consts::PI;

use glam::{DMat3, DMat4, Mat3, Vec2, Vec3};

use super::LightSample;
use crate::scene::error::SceneError;
use crate::scene::light_choice::Cone;
use crate::scene::load::Loader;
use crate::scene::spectra::{Quantity, spectrum_or};
use crate::scene::xml::Object;
use crate::scene::{Bitmap, CameraError, FieldOfView};
use crate::spectrum::{Colour, SpectralCurve, SpectrumArithmetic};

/// The greatest factor: far from the overflow of `f32`.
const MAX_SCALE: f64 = 1e30;

/// A projector.
#[derive(Clone, Debug)]
pub struct Projector {
    /// Position in world space.
    pub position: Vec3,
    irradiance: Irradiance,
    /// Factor for it.
    scale: f32,
    /// From directions in world space to those of the projector: a rotation, or one that mirrors.
    to_local: Mat3,
    /// Half of the image's width and height at the distance 1.
    half_size: Vec2,
}

/// Irradiance of a plane at the distance 1, divided by pi.
#[derive(Clone, Debug)]
enum Irradiance {
    /// The same everywhere.
    Even(SpectralCurve),
    /// That of an image.
    Image(Bitmap),
}

impl Irradiance {
    /// The same, without an image where that is of one colour.
    fn without_flat_image(self) -> Self {
        let colour = match &self {
            Self::Even(_) => None,
            Self::Image(image) => image.uniform(),
        };
        match colour.map(SpectralCurve::rgb_reflectance) {
            Some(Ok(colour)) => Self::Even(colour),
            _ => self,
        }
    }
}

impl Projector {
    /// Whether it throws an image.
    pub fn is_textured(&self) -> bool {
        matches!(self.irradiance, Irradiance::Image(_))
    }

    pub(super) fn load(object: &Object, loader: &mut Loader) -> Result<Self, SceneError> {
        const NAME: &str = "irradiance";
        let scale = object.float_or("scale", 1.0)?;
        if !(0.0..=MAX_SCALE).contains(&scale) {
            let message = format!("`scale` is {scale}; it must be from 0 to {MAX_SCALE:e}");
            return Err(object.parameter_error("scale", message));
        }
        let irradiance = match object.child_named(NAME) {
            Some(child) => Irradiance::Image(loader.textures.bitmap(&child.object)?),
            None => Irradiance::Even(spectrum_or(object, NAME, Quantity::Emission, 1.0)?),
        };
        let field_of_view = FieldOfView::load(object)?;
        if !(field_of_view.degrees > 0.0 && field_of_view.degrees < 180.0) {
            let error = CameraError::FieldOfView(field_of_view.degrees);
            return Err(object.error(error.to_string()));
        }
        let to_world = object.transform("to_world")?.unwrap_or(DMat4::IDENTITY);
        object.finish()?;
        let axes = DMat3::from_mat4(to_world);
        let deviation = axes.transpose() * axes - DMat3::IDENTITY;
        let position = to_world.w_axis.truncate().as_vec3();
        if !deviation
            .abs()
            .to_cols_array()
            .iter()
            .all(|&deviation| deviation < 1e-3)
        {
            let message = "`to_world` of a projector must not scale";
            return Err(object.parameter_error("to_world", message));
        }
        if !position.is_finite() {
            return Err(object.error("the light is too far away for 32-bit coordinates"));
        }
        let size = match &irradiance {
            Irradiance::Even(_) => Vec2::ONE,
            Irradiance::Image(image) => image.size().as_vec2(),
        };
        let irradiance = irradiance.without_flat_image();
        let aspect = f64::from(size.x / size.y);
        let half_width = field_of_view.half_width(aspect);
        Ok(Self {
            position,
            irradiance,
            scale: scale as f32,
            to_local: axes.transpose().as_mat3(),
            half_size: Vec2::new(half_width as f32, (half_width / aspect) as f32),
        })
    }

    /// The greatest irradiance, about: luminance; 0 where it casts nothing.
    pub fn luminance(&self) -> f32 {
        let rgb = match &self.irradiance {
            Irradiance::Even(curve) if curve.is_black() => Vec3::ZERO,
            // A colour that no eye sees lights all the same.
            Irradiance::Even(curve) => Vec3::from(curve.rgb()).max(Vec3::splat(f32::MIN_POSITIVE)),
            Irradiance::Image(image) => Vec3::splat(image.mean()),
        };
        self.scale * rgb.dot(Vec3::new(0.212_671, 0.715_160, 0.072_169))
    }

    /// Takes out the image.
    pub(in crate::scene) fn make_even(&mut self) {
        if let Irradiance::Image(image) = &self.irradiance
            && let Ok(grey) = SpectralCurve::rgb_reflectance([image.mean(); 3])
        {
            self.irradiance = Irradiance::Even(grey);
        }
    }

    /// A cone that holds all directions in world space into which it shines.
    pub fn directions(&self) -> Cone {
        Cone {
            axis: (self.to_local.transpose() * Vec3::Z).normalize(),
            angle: self.half_size.length().atan(),
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
        let local = self.to_local * -offset;
        if local.z <= 0.0 {
            return None;
        }
        // The image's x grows to the right and the projector's x to the left; y grows downwards and upwards.
        let across = Vec2::new(local.x, local.y) / (local.z * self.half_size);
        if across.abs().max_element() > 1.0 {
            return None;
        }
        let irradiance = match &self.irradiance {
            Irradiance::Even(curve) => C::evaluate(curve, wavelengths),
            Irradiance::Image(image) => image.spectrum::<C>(0.5 - 0.5 * across, wavelengths),
        };
        // The intensity that makes the irradiance of a plane at the distance 1 even: the cube of the cosine is undone.
        let cosine = local.z / distance;
        let weight = irradiance * (self.scale * PI / (local.z * local.z * cosine));
        (!weight.is_black()).then(|| LightSample {
            direction: offset / distance,
            distance,
            surface: None,
            weight,
            pdf: None,
        })
    }
}
