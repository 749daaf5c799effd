//! `mask`: makes a bsdf transparent in places, or everywhere a little.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `opacity` | float, spectrum or texture | share of the light that meets the bsdf; the rest passes; limited to [0, 1] | 0.5 |
//! | (any name) | bsdf | the bsdf | required |

use super::material::SeenPoint;
use super::stated::Stated;
use super::surface::Surface;
use super::{Bsdf, Model, Null};
use crate::scene::error::SceneError;
use crate::scene::textures::{FloatTexture, TextureLoader};
use crate::scene::xml::{Class, Object};
use crate::spectrum::Colour;

/// A bsdf and how opaque it is.
#[derive(Clone, Debug)]
pub(super) struct Mask {
    pub opacity: FloatTexture,
    pub surface: Stated,
}

impl Mask {
    /// The masked surface; without a mask where that would be all or nothing.
    pub fn load(object: &Object, textures: &mut TextureLoader) -> Result<Stated, SceneError> {
        let [nested] = object.children(Class::Bsdf)[..] else {
            return Err(object.error("a `mask` contains one bsdf"));
        };
        let opacity = textures.number(object, "opacity", 0.5)?;
        object.finish()?;
        let surface = Surface::load(&nested.object, textures)?;
        Ok(match opacity {
            FloatTexture::Uniform(opacity) if opacity <= 0.0 => Stated::by(object, Surface::Null),
            FloatTexture::Uniform(opacity) if opacity >= 1.0 => surface,
            opacity => Stated::by(object, Surface::Mask(Box::new(Self { opacity, surface }))),
        })
    }

    pub fn at<C: Colour>(
        &self,
        point: &SeenPoint,
        wavelengths: &C::Wavelengths,
    ) -> Option<Bsdf<C::Spectrum>> {
        let opacity = self.opacity.number(&point.parameters);
        // What lies above 1 never exceeds the choice, what lies below 0 always does.
        if point.choice >= opacity {
            return Some(Bsdf::Plain(Model::Null(Null)));
        }
        let nested = SeenPoint {
            choice: point.choice / opacity.min(1.0),
            ..*point
        };
        self.surface.at::<C>(&nested, wavelengths)
    }
}
