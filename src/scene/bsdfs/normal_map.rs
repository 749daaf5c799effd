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
use super::stated::Stated;
use super::surface::Surface;
use crate::scene::error::SceneError;
use crate::scene::textures::{SpectrumTexture, TextureLoader};
use crate::scene::xml::Object;
use crate::spectrum::{Colour, SpectralCurve};

/// The colour of a normal that is not tilted.
const STRAIGHT: [f32; 3] = [0.5, 0.5, 1.0];

/// A map of normals over a bsdf.
#[derive(Clone, Debug)]
pub(super) struct NormalMap {
    pub nested: Tilted,
    normals: SpectrumTexture,
}

impl NormalMap {
    /// The tilted surface; the nested one where no normal is tilted.
    pub fn load(object: &Object, textures: &mut TextureLoader) -> Result<Stated, SceneError> {
        if !object.has("normalmap") {
            return Err(object.missing("normalmap"));
        }
        let map = Self {
            normals: textures.reflectance(object, "normalmap", 1.0)?,
            nested: Tilted::load(object, textures)?,
        };
        object.finish()?;
        let is_straight = |normal: &SpectralCurve| normal.rgb() == STRAIGHT;
        Ok(match &map.normals {
            SpectrumTexture::Uniform(normal) if is_straight(normal) => map.nested.surface,
            _ => Stated::by(object, Surface::NormalMap(Box::new(map))),
        })
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
