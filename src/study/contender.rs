//! A render that takes part in a study: it goes on when it is told to, and stops where it is told to.

use std::num::NonZeroUsize;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::plan::mixed;
use super::{EntrySettings, StudyError};
use crate::film::Image;
use crate::render::{Budget, Render, RenderState, StopFlag};
use crate::scene::Scene;

/// What a contender has used and done in the repetition under way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Standing {
    /// Wall-clock seconds while it ran.
    pub seconds: f64,
    /// Camera paths.
    pub camera_paths: u64,
    /// Rays, shadow rays included, where it counts them.
    pub rays: Option<u64>,
    /// Samples that were not finite or negative.
    pub dropped: u64,
}

/// Which repetition is rendered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Repetition {
    /// Its number, from 0.
    pub index: u32,
    /// How many there will be.
    pub count: u32,
    /// Seed of this competitor's random numbers in all repetitions, which no other has.
    pub seed: u64,
}

/// One competitor at work.
pub trait Contender {
    /// Begins a repetition, with nothing rendered yet.
    fn begin(&mut self, repetition: &Repetition);

    /// Goes on until `until`, which counts from the beginning of the repetition, or until `stop` is raised.
    ///
    /// # Errors
    /// Where a renderer that is not ours fails.
    fn advance(&mut self, until: Budget, stop: &StopFlag) -> Result<(), StudyError>;

    /// What it has used and done.
    fn standing(&self) -> Standing;

    /// The image so far.
    fn image(&self) -> Image;

    /// What has been rendered, to be kept in a file.
    ///
    /// # Errors
    /// Where it cannot be encoded.
    fn save(&self) -> Result<Vec<u8>, StudyError>;

    /// Goes on from what [`Self::save`] gave.
    ///
    /// # Errors
    /// Where the bytes are damaged.
    fn restore(&mut self, bytes: &[u8]) -> Result<(), StudyError>;

    /// Everything that makes it what it is: name and value.
    fn settings(&self) -> Vec<(String, String)>;

    /// Its program and version.
    fn version(&self) -> (String, String);
}

/// A render by this program.
pub struct OurRender {
    render: Render,
    state: RenderState,
}

impl OurRender {
    /// Prepares to render `scene`.
    ///
    /// # Errors
    /// Settings that do not fit the strategy or the scene.
    pub fn new(
        scene: Arc<Scene>,
        entry: &EntrySettings,
        threads: NonZeroUsize,
    ) -> Result<Self, StudyError> {
        let settings = entry.settings(&scene, threads)?;
        let render = Render::new(scene, settings)?;
        let state = render.start(0);
        Ok(Self { render, state })
    }

    /// What has been rendered.
    pub fn state(&self) -> &RenderState {
        &self.state
    }
}

impl Contender for OurRender {
    fn begin(&mut self, repetition: &Repetition) {
        self.state = self
            .render
            .start(mixed(repetition.seed, u64::from(repetition.index)));
    }

    fn advance(&mut self, until: Budget, stop: &StopFlag) -> Result<(), StudyError> {
        self.render.advance(&mut self.state, until, stop, &());
        Ok(())
    }

    fn standing(&self) -> Standing {
        let statistics = self.state.statistics();
        Standing {
            seconds: self.state.duration().as_secs_f64(),
            camera_paths: statistics.camera_paths,
            rays: Some(statistics.all_rays()),
            dropped: statistics.dropped.total() + statistics.walk.dropped(),
        }
    }

    fn image(&self) -> Image {
        self.state.film().image()
    }

    fn save(&self) -> Result<Vec<u8>, StudyError> {
        postcard::to_stdvec(&self.state).map_err(StudyError::Encode)
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), StudyError> {
        let state = postcard::from_bytes(bytes).map_err(StudyError::Damaged)?;
        if !self.render.fits(&state) {
            return Err(StudyError::Misfit);
        }
        self.state = state;
        Ok(())
    }

    fn settings(&self) -> Vec<(String, String)> {
        crate::render::what_is_computed(&self.render)
    }

    fn version(&self) -> (String, String) {
        let embree = self.render.engine().embree_version();
        ("Embree".to_owned(), embree.to_string())
    }
}
