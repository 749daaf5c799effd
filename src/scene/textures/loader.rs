//! Parameters of scene files that may be textures.

use glam::{Affine2, DMat4, Mat2, Vec2};

use super::{Checkerboard, FloatTexture, Pattern, SpectrumTexture};
use crate::scene::error::SceneError;
use crate::scene::spectra::{Quantity, Stated, number, stated};
use crate::scene::xml::{Class, Document, Object};

/// Loads textures, each file once.
pub(in crate::scene) struct TextureLoader<'d> {
    pub document: &'d Document,
}

impl<'d> TextureLoader<'d> {
    pub fn new(document: &'d Document) -> Self {
        Self { document }
    }

    /// The reflectance or transmittance that `object` has under `name`, or the grey `default`.
    pub fn reflectance(
        &mut self,
        object: &Object,
        name: &'static str,
        default: f32,
    ) -> Result<SpectrumTexture, SceneError> {
        let curve = match object.spectrum(name)? {
            Some(property) => match stated(property, Quantity::Reflectance) {
                Stated::Texture(texture) => {
                    return self.pattern(&texture).map(SpectrumTexture::Varying);
                }
                Stated::Curve(curve) => curve,
            },
            None => number(default, Quantity::Reflectance),
        };
        curve
            .map(SpectrumTexture::Uniform)
            .map_err(|error| object.parameter_error(name, format!("`{name}`: {error}")))
    }

    /// The number that `object` has under `name`, or `default`.
    pub fn number(
        &mut self,
        object: &Object,
        name: &'static str,
        default: f32,
    ) -> Result<FloatTexture, SceneError> {
        match object.child_named(name) {
            Some(child) if child.object.class == Class::Texture => {
                self.pattern(&child.object).map(FloatTexture::Varying)
            }
            _ => {
                let value = object.float_or(name, f64::from(default))?;
                Ok(FloatTexture::Uniform(value as f32))
            }
        }
    }

    fn pattern(&mut self, object: &Object) -> Result<Pattern, SceneError> {
        match object.plugin.as_str() {
            "checkerboard" => Checkerboard::load(object, self)
                .map(Box::new)
                .map(Pattern::Checkerboard),
            _ => Err(object.unsupported(&["checkerboard"])),
        }
    }
}

/// The transform of texture coordinates `to_uv`: of the 4 x 4 matrix, what it does in the plane.
pub(super) fn to_uv(object: &Object) -> Result<Affine2, SceneError> {
    let matrix = object.transform("to_uv")?.unwrap_or(DMat4::IDENTITY);
    let column = |axis: usize| {
        let column = matrix.col(axis);
        Vec2::new(column.x as f32, column.y as f32)
    };
    Ok(Affine2::from_mat2_translation(
        Mat2::from_cols(column(0), column(1)),
        column(3),
    ))
}
