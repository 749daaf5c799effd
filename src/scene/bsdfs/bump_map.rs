//! `bumpmap`: tilts the normals of a bsdf as if the surface were displaced by a height map.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | (any name) | texture | the height map, a `bitmap`; set its `raw` | required |
//! | (any name) | bsdf | the bsdf | required |
//! | `scale` | float | factor of the heights | 1 |
//! | `flip_invalid_normals`, `use_shadowing_function` | boolean | see [`perturbed`](super::perturbed) | true |

use glam::Vec3;

use super::Bsdf;
use super::material::SeenPoint;
use super::perturbed::Tilted;
use super::stated::Stated;
use super::surface::Surface;
use crate::scene::error::SceneError;
use crate::scene::textures::{Bitmap, TextureLoader};
use crate::scene::xml::{Class, Object};
use crate::spectrum::Colour;

/// A height map over a bsdf.
#[derive(Clone, Debug)]
pub(super) struct BumpMap {
    pub nested: Tilted,
    heights: Bitmap,
    scale: f32,
}

impl BumpMap {
    /// The bumpy surface; the nested one where the height is the same everywhere.
    pub fn load(object: &Object, textures: &mut TextureLoader) -> Result<Stated, SceneError> {
        let [heights] = object.children(Class::Texture)[..] else {
            return Err(object.error("a `bumpmap` contains one texture, its height map"));
        };
        let map = Self {
            heights: textures.bitmap(&heights.object)?,
            scale: object.float_or("scale", 1.0)? as f32,
            nested: Tilted::load(object, textures)?,
        };
        object.finish()?;
        Ok(if map.scale == 0.0 || map.heights.uniform().is_some() {
            map.nested.surface
        } else {
            Stated::by(object, Surface::BumpMap(Box::new(map)))
        })
    }

    pub fn at<C: Colour>(
        &self,
        point: &SeenPoint,
        wavelengths: &C::Wavelengths,
    ) -> Option<Bsdf<C::Spectrum>> {
        self.nested.at::<C>(point, self.normal(point), wavelengths)
    }

    /// The normal of the displaced surface in the shading frame (Blinn 1978, "Simulation of Wrinkled Surfaces").
    fn normal(&self, point: &SeenPoint) -> Vec3 {
        let (frame, parameters) = (&point.frame, &point.parameters);
        let gradient = self.heights.gradient(parameters.uv) * self.scale;
        let displaced =
            |tangent: Vec3, rise: f32| tangent + frame.normal * (rise - frame.normal.dot(tangent));
        let normal =
            displaced(parameters.dp_du, gradient.x).cross(displaced(parameters.dp_dv, gradient.y));
        let outside = if normal.dot(parameters.geometric_normal) < 0.0 {
            -normal
        } else {
            normal
        };
        frame.to_local(outside)
    }
}
