//! The parameters that `principled` and `principledthin` share.

use super::share;
use crate::scene::error::SceneError;
use crate::scene::textures::{FloatTexture, SpectrumTexture, TextureLoader};
use crate::scene::xml::Object;

/// What both principled surfaces state; every field is a parameter of the scene file.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct CommonParameters {
    pub base_color: SpectrumTexture,
    pub roughness: FloatTexture,
    pub anisotropic: FloatTexture,
    pub spec_trans: FloatTexture,
    pub spec_tint: FloatTexture,
    pub sheen: FloatTexture,
    pub sheen_tint: FloatTexture,
    pub flatness: FloatTexture,
}

impl CommonParameters {
    pub(super) fn load(object: &Object, textures: &mut TextureLoader) -> Result<Self, SceneError> {
        let base_color = textures.reflectance(object, "base_color", 0.5)?;
        let mut number = |name, default| share(object, textures, name, default, 1.0);
        Ok(Self {
            base_color,
            roughness: number("roughness", 0.5)?,
            anisotropic: number("anisotropic", 0.0)?,
            spec_trans: number("spec_trans", 0.0)?,
            spec_tint: number("spec_tint", 0.0)?,
            sheen: number("sheen", 0.0)?,
            sheen_tint: number("sheen_tint", 0.0)?,
            flatness: number("flatness", 0.0)?,
        })
    }

    /// Whether light is let through somewhere.
    pub(super) fn is_transmissive(&self) -> bool {
        self.spec_trans.can_be_positive()
    }

    /// Whether it differs from point to point.
    pub(super) fn varies(&self) -> bool {
        let mut numbers = self.numbers().into_iter();
        self.base_color.varies() || numbers.any(FloatTexture::varies)
    }

    /// Makes it the same everywhere, with the means of its textures.
    pub(super) fn make_uniform(&mut self) {
        self.base_color.make_uniform();
        for number in [
            &mut self.roughness,
            &mut self.anisotropic,
            &mut self.spec_trans,
            &mut self.spec_tint,
            &mut self.sheen,
            &mut self.sheen_tint,
            &mut self.flatness,
        ] {
            number.make_uniform();
        }
    }

    fn numbers(&self) -> [&FloatTexture; 7] {
        [
            &self.roughness,
            &self.anisotropic,
            &self.spec_trans,
            &self.spec_tint,
            &self.sheen,
            &self.sheen_tint,
            &self.flatness,
        ]
    }
}
