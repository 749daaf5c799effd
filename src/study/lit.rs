//! Which pixels see a light directly.

use std::num::{NonZeroU32, NonZeroUsize};
use std::sync::Arc;

use super::{EntrySettings, StudyError};
use crate::render::{Budget, ColourMode, Render, StopFlag};
use crate::scene::Scene;
use crate::walk::StrategyKind;

/// Camera paths per pixel that look for lights.
const SAMPLES: NonZeroU32 = NonZeroU32::new(16).unwrap();

/// For each pixel, row by row from the top, whether one of a few rays through it meets an emitter: those pixels hold the
/// noise of the light's edge, which has nothing to do with how long paths are followed.
///
/// # Errors
/// The scene cannot be rendered.
pub fn pixels_that_see_a_light(
    scene: &Arc<Scene>,
    threads: NonZeroUsize,
) -> Result<Vec<bool>, StudyError> {
    let entry = EntrySettings {
        strategy: StrategyKind::FixedDepth,
        colour: ColourMode::Rgb,
        max_depth: Some(NonZeroU32::MIN),
        ..EntrySettings::default()
    };
    let render = Render::new(Arc::clone(scene), entry.settings(scene, threads)?)?;
    let mut state = render.start(0);
    render.advance(
        &mut state,
        Budget::SamplesPerPixel(SAMPLES),
        &StopFlag::new(),
        &(),
    );
    let image = state.film().image();
    let is_lit = |pixel: &[f32; 3]| pixel.iter().any(|&value| value > 0.0);
    Ok(image.pixels().iter().map(is_lit).collect())
}
