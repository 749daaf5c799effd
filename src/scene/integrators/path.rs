//! `path`: light that arrives by any number of reflections.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `max_depth` | integer | most segments of a path, camera ray included; -1 for no limit | -1 |
//! | `rr_depth` | integer | from which number of segments on `throughput-roulette` may end a path | 5 |
//! | `hide_emitters` | boolean | whether emitters are invisible to the camera | false |

use super::PathIntegrator;
use crate::scene::error::SceneError;
use crate::scene::xml::Object;

pub(super) fn load(object: &Object) -> Result<PathIntegrator, SceneError> {
    let default = PathIntegrator::default();
    let max_depth = match object.integer_or("max_depth", -1)? {
        -1 => None,
        depth => Some(u32::try_from(depth).map_err(|_| {
            object.parameter_error(
                "max_depth",
                format!("`max_depth` is {depth}; it must be -1 (no limit) or from 0 on"),
            )
        })?),
    };
    let rr_depth = object.integer_or("rr_depth", i64::from(default.roulette_depth))?;
    let roulette_depth = u32::try_from(rr_depth)
        .ok()
        .filter(|&depth| depth > 0)
        .ok_or_else(|| {
            object.parameter_error(
                "rr_depth",
                format!("`rr_depth` is {rr_depth}; it must be from 1 on"),
            )
        })?;
    let hide_emitters = object.boolean_or("hide_emitters", default.hide_emitters)?;
    object.finish()?;
    Ok(PathIntegrator {
        max_depth,
        roulette_depth,
        hide_emitters,
        ..default
    })
}
