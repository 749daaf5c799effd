//! `moment`: another integrator, and the second moments of its samples.
//!
//! It contains that integrator, which makes the image. Beside it stand the image once more in CIE XYZ, in the channels `NAME.X`, `NAME.Y` and
//! `NAME.Z`, and the mean over the samples of X^2, Y^2 and Z^2, in `m2_NAME.X`, `m2_NAME.Y` and `m2_NAME.Z`. NAME is the `name` of the integrator
//! in it, or `_arg_0` where it has none.
//!
//! A sample is a camera path with all into which it branches. With a reconstruction filter other than `box`, squares are weighted as samples are.

use super::PathIntegrator;
use crate::scene::error::SceneError;
use crate::scene::xml::{Class, Object};

/// What Mitsuba calls an object without a name.
const NAMELESS: &str = "_arg_0";

pub(super) fn load(object: &Object) -> Result<PathIntegrator, SceneError> {
    let Some(nested) = object.child(Class::Integrator)? else {
        return Err(object.error("`moment` needs an integrator in it, such as `path`"));
    };
    let integrator = super::load(&nested.object)?;
    if integrator.moments.is_some() {
        return Err(nested
            .object
            .error("`moment` in `moment` is not supported: name the integrator itself"));
    }
    object.finish()?;
    let name = match nested.name.as_str() {
        "" => NAMELESS,
        name => name,
    };
    Ok(PathIntegrator {
        moments: Some(name.to_owned()),
        ..integrator
    })
}
