//! `twosided`: lets a surface scatter light on both sides.
//!
//! It contains one bsdf for both sides, or two: the first for the front, the second for the back.

use super::{Material, load_model};
use crate::scene::error::SceneError;
use crate::scene::xml::{Class, Object};

pub(super) fn load(object: &Object) -> Result<Material, SceneError> {
    let (front, back) = match object.children(Class::Bsdf)[..] {
        [both] => (both, both),
        [front, back] => (front, back),
        _ => return Err(object.error("a `twosided` contains one or two bsdfs")),
    };
    object.finish()?;
    if let Some(nested) = [front, back]
        .into_iter()
        .find(|child| child.object.plugin == "twosided")
    {
        return Err(nested
            .object
            .error("a `twosided` cannot contain another one"));
    }
    Ok(Material {
        front: load_model(&front.object)?,
        back: Some(load_model(&back.object)?),
    })
}
