//! Where the things of a scene come from.

use std::fmt;

use super::error::Location;
use super::xml::{Class, Object};

/// An object of the scene file, as a person finds it there.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Source {
    /// What kind of thing it is.
    pub class: Class,
    /// Its plugin.
    pub plugin: String,
    /// Its `id`, if it has one.
    pub id: Option<String>,
    /// Where it is written.
    pub location: Location,
}

/// The objects that groups of shapes, emitters and the camera of a scene come from; materials know theirs.
#[derive(Clone, Debug)]
pub struct Sources {
    /// By group.
    pub groups: Vec<Source>,
    /// By emitter.
    pub emitters: Vec<Source>,
    /// That of the camera.
    pub sensor: Source,
}

impl Source {
    pub(super) fn of(object: &Object) -> Self {
        Self {
            class: object.class,
            plugin: object.plugin.clone(),
            id: object.id.clone(),
            location: object.location.clone(),
        }
    }
}

/// "bsdf `plastic` called `red` (box.xml:12)"
impl fmt::Display for Source {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} `{}`", self.class, self.plugin)?;
        if let Some(id) = &self.id {
            write!(formatter, " called `{id}`")?;
        }
        let Location { file, line, .. } = &self.location;
        write!(formatter, " ({}:{line})", file.display())
    }
}
