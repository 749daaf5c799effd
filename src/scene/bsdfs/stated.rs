//! Bsdfs of the scene file with the place where they are written, also those that stand in others.

use std::ops::Deref;

use super::surface::Surface;
use crate::scene::source::Source;
use crate::scene::xml::Object;

/// A bsdf and the object that states it.
#[derive(Clone, Debug)]
pub(super) struct Stated {
    pub surface: Surface,
    pub source: Box<Source>,
}

impl Stated {
    /// What `object` states.
    pub fn by(object: &Object, surface: Surface) -> Self {
        Self {
            surface,
            source: Box::new(Source::of(object)),
        }
    }
}

impl Deref for Stated {
    type Target = Surface;

    fn deref(&self) -> &Surface {
        &self.surface
    }
}
