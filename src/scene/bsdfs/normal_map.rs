//! `normalmap`: tilts the normals of a bsdf to those of a texture.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `normalmap` | texture | normals in the shading frame, each coordinate x as (x + 1) / 2; set its `raw` | required |
//! | (any name) | bsdf | the bsdf | required |
//! | `flip_invalid_normals`, `use_shadowing_function` | boolean | see [`perturbed`](super::perturbed) | true |

use glam::Vec3;

use super::Bsdf;
use super::material::SeenPoint;
use super::perturbed::Tilted;
use crate::scene::error::SceneError;
use crate::scene::textures::{SpectrumTexture, TextureLoader};
use crate::scene::xml::Object;
use crate::spectrum::Colour;

/// A map of normals over a bsdf.
#[derive(Clone, Debug)]
pub(super) struct NormalMap {
    pub nested: Tilted,
    normals: SpectrumTexture,
}

impl NormalMap {
    pub fn load(object: &Object, textures: &mut TextureLoader) -> Result<Self, SceneError> {
        if !object.has("normalmap") {
            return Err(object.missing("normalmap"));
        }
        let map = Self {
            normals: textures.reflectance(object, "normalmap", 1.0)?,
            nested: Tilted::load(object, textures)?,
        };
        object.finish()?;
        Ok(map)
    }

    pub fn at<C: Colour>(
        &self,
        point: &SeenPoint,
        wavelengths: &C::Wavelengths,
    ) -> Option<Bsdf<C::Spectrum>> {
        let normal = 2.0 * Vec3::from(self.normals.rgb(&point.parameters)) - Vec3::ONE;
        self.nested.at::<C>(point, normal, wavelengths)
    }
}
