//! `twosided`: lets a surface scatter light on both sides.
//!
//! It contains one bsdf for both sides, or two: the first for the front, the second for the back. They must not let light through.

use super::stated::Stated;
use super::surface::Surface;
use crate::scene::error::SceneError;
use crate::scene::textures::TextureLoader;
use crate::scene::xml::{Child, Class, Object};

/// A surface with a front on both sides.
#[derive(Clone, Debug)]
pub(super) struct TwoSided {
    pub front: Stated,
    pub back: Stated,
}

impl TwoSided {
    pub(super) fn load(object: &Object, textures: &mut TextureLoader) -> Result<Self, SceneError> {
        let (front, back) = match object.children(Class::Bsdf)[..] {
            [both] => (both, both),
            [front, back] => (front, back),
            _ => return Err(object.error("a `twosided` contains one or two bsdfs")),
        };
        object.finish()?;
        Ok(Self {
            front: load_side(front, textures)?,
            back: load_side(back, textures)?,
        })
    }
}

fn load_side(child: &Child, textures: &mut TextureLoader) -> Result<Stated, SceneError> {
    let object = &child.object;
    if object.plugin == "twosided" {
        return Err(object.error("a `twosided` cannot contain another one"));
    }
    let surface = Surface::load(object, textures)?;
    if surface.is_transmissive() {
        return Err(object.error(format!(
            "a `twosided` cannot contain the {object}, which lets light through: it has a back of its own"
        )));
    }
    Ok(surface)
}
