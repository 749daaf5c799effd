//! Mitsuba 3 as one who takes part.

use super::contender::{Contender, Repetition, Standing};
use super::peer::{MitsubaPeer, MitsubaVariant, PeerSpec, PeerState, PeerTarget, SeedSequence};
use super::{Plan, StudyError};
use crate::film::Image;
use crate::render::{Budget, StopFlag};
use crate::scene::{ImageSize, Scene};

/// A render by Mitsuba 3, in a process of its own.
pub struct MitsubaContender {
    peer: MitsubaPeer,
    variant: MitsubaVariant,
    name: String,
    state: PeerState,
}

impl MitsubaContender {
    /// Starts Mitsuba on the scene file of `plan`, at the size of `scene`.
    ///
    /// # Errors
    /// Mitsuba is not there, or does not read the scene. The built-in scene has no file.
    pub fn new(
        plan: &Plan,
        scene: &Scene,
        name: &str,
        variant: &MitsubaVariant,
    ) -> Result<Self, StudyError> {
        let size = scene.film.crop.size;
        let file = plan.scene.file.clone();
        let peer = MitsubaPeer::start(PeerSpec {
            variant: variant.clone(),
            scene: file.ok_or_else(|| StudyError::NoSceneFile(name.to_owned()))?,
            definitions: plan.scene.definitions.clone(),
            size,
            threads: plan.threads,
            max_depth: None,
        })?;
        Ok(Self {
            peer,
            variant: variant.clone(),
            name: name.to_owned(),
            state: state(size, &Repetition::default()),
        })
    }
}

fn state(size: ImageSize, repetition: &Repetition) -> PeerState {
    let Repetition { index, count, seed } = *repetition;
    PeerState::new(size, SeedSequence::new(size, seed, index, count))
}

impl Contender for MitsubaContender {
    fn begin(&mut self, repetition: &Repetition) {
        self.state = state(self.peer.size(), repetition);
    }

    fn advance(&mut self, until: Budget, stop: &StopFlag) -> Result<(), StudyError> {
        let target = match until {
            Budget::Time(time) => PeerTarget::Seconds(time.as_secs_f64()),
            Budget::SamplesPerPixel(samples) => PeerTarget::SamplesPerPixel(samples.get().into()),
            Budget::Rays(_) => return Err(StudyError::UncountedRays(self.name.clone())),
        };
        Ok(self.state.advance(&mut self.peer, target, stop)?)
    }

    fn standing(&self) -> Standing {
        Standing {
            seconds: self.state.seconds(),
            camera_paths: self.state.samples_per_pixel() * self.peer.size().pixels() as u64,
            rays: None,
            dropped: 0,
        }
    }

    fn image(&self) -> Image {
        self.state.image()
    }

    fn save(&self) -> Result<Vec<u8>, StudyError> {
        postcard::to_stdvec(&self.state).map_err(StudyError::Encode)
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), StudyError> {
        self.state = postcard::from_bytes(bytes).map_err(StudyError::Damaged)?;
        Ok(())
    }

    fn settings(&self) -> Vec<(String, String)> {
        vec![
            ("variant".to_owned(), self.variant.name().to_owned()),
            ("integrator".to_owned(), "the scene's".to_owned()),
        ]
    }

    fn version(&self) -> (String, String) {
        ("Mitsuba".to_owned(), self.peer.version().to_owned())
    }
}
