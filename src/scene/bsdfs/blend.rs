//! `blendbsdf`: a mixture of two bsdfs.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `weight` | float, spectrum or texture | share of the second bsdf, limited to [0, 1] | required |
//! | (any names) | bsdf, twice | the two bsdfs, in the order of the file | required |

use super::Bsdf;
use super::material::SeenPoint;
use super::stated::Stated;
use super::surface::Surface;
use crate::scene::error::SceneError;
use crate::scene::textures::{FloatTexture, TextureLoader};
use crate::scene::xml::{Class, Object};
use crate::spectrum::Colour;

/// Two bsdfs and the share of the second.
#[derive(Clone, Debug)]
pub(super) struct Blend {
    pub weight: FloatTexture,
    pub surfaces: [Stated; 2],
}

impl Blend {
    /// The mixture, or the only one of the two that matters.
    pub fn load(object: &Object, textures: &mut TextureLoader) -> Result<Stated, SceneError> {
        let [first, second] = object.children(Class::Bsdf)[..] else {
            return Err(object.error("a `blendbsdf` contains two bsdfs"));
        };
        if !object.has("weight") {
            return Err(object.missing("weight"));
        }
        let weight = textures.number(object, "weight", 0.5)?;
        object.finish()?;
        let surfaces = [
            Surface::load(&first.object, textures)?,
            Surface::load(&second.object, textures)?,
        ];
        Ok(match weight {
            FloatTexture::Uniform(weight) if weight <= 0.0 => {
                let [first, _] = surfaces;
                first
            }
            FloatTexture::Uniform(weight) if weight >= 1.0 => {
                let [_, second] = surfaces;
                second
            }
            weight => Stated::by(object, Surface::Blend(Box::new(Self { weight, surfaces }))),
        })
    }

    pub fn at<C: Colour>(
        &self,
        point: &SeenPoint,
        wavelengths: &C::Wavelengths,
    ) -> Option<Bsdf<C::Spectrum>> {
        let weight = self.weight.number(&point.parameters).clamp(0.0, 1.0);
        let [first, second] = &self.surfaces;
        let (surface, choice) = if point.choice < weight {
            (second, point.choice / weight)
        } else {
            (first, (point.choice - weight) / (1.0 - weight))
        };
        surface.at::<C>(&SeenPoint { choice, ..*point }, wavelengths)
    }
}
