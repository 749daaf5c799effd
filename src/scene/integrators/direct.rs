//! `direct`: emitters, and light that arrives from them by one reflection.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `shading_samples` | integer | sets both of the following; may not be given beside them | 1 |
//! | `emitter_samples` | integer | points of emitters that every surface looks at; 0 leaves light to be met by chance | `shading_samples` |
//! | `bsdf_samples` | integer | directions of the bsdf that every surface looks into; with 0 emitters are only sampled | `shading_samples` |
//! | `hide_emitters` | boolean | whether emitters are invisible to the camera | false |

use super::{PathIntegrator, SurfaceSamples};
use crate::scene::error::SceneError;
use crate::scene::xml::Object;

/// The most samples of a kind: all of a batch are in memory at once.
const MAX_SAMPLES: u32 = 256;

pub(super) fn load(object: &Object) -> Result<PathIntegrator, SceneError> {
    let count = |name: &'static str| -> Result<Option<u32>, SceneError> {
        let Some(count) = object.integer(name)? else {
            return Ok(None);
        };
        let valid = u32::try_from(count)
            .ok()
            .filter(|&count| count <= MAX_SAMPLES);
        valid.map(Some).ok_or_else(|| {
            let message = format!("`{name}` is {count}; it must be from 0 to {MAX_SAMPLES}");
            object.parameter_error(name, message)
        })
    };
    let both = count("shading_samples")?;
    let (emitters, directions) = (count("emitter_samples")?, count("bsdf_samples")?);
    if both.is_some() && (emitters.is_some() || directions.is_some()) {
        let message =
            "`shading_samples` cannot be given beside `emitter_samples` and `bsdf_samples`";
        return Err(object.parameter_error("shading_samples", message));
    }
    let each = both.unwrap_or(1);
    let samples = SurfaceSamples {
        emitters: emitters.unwrap_or(each),
        directions: directions.unwrap_or(each),
    };
    if samples.emitters == 0 && samples.directions == 0 {
        return Err(
            object.error("`direct` needs at least one sample of the emitters or of the bsdf")
        );
    }
    let hide_emitters = object.boolean_or("hide_emitters", false)?;
    object.finish()?;
    Ok(PathIntegrator {
        max_depth: Some(2),
        hide_emitters,
        samples,
        ..PathIntegrator::default()
    })
}
