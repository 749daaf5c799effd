//! `moment`: another integrator, and the second moments of its samples.
//!
//! It contains that integrator, which makes the image. The second moments, for which Mitsuba adds the channels `m2_…`, are
//! not written; the program says so when it renders. What is known of the noise can be had from the library
//! ([`crate::film::Film::variance`]).

use super::PathIntegrator;
use crate::scene::error::SceneError;
use crate::scene::xml::{Class, Object};

pub(super) fn load(object: &Object) -> Result<PathIntegrator, SceneError> {
    let Some(nested) = object.child(Class::Integrator)? else {
        return Err(object.error("`moment` needs an integrator in it, such as `path`"));
    };
    let integrator = super::load(&nested.object)?;
    object.finish()?;
    Ok(PathIntegrator {
        second_moments: true,
        ..integrator
    })
}
