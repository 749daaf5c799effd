//! Renders that lose nothing: how far one is, in a file from which it goes on.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use sha2::{Digest, Sha256};
use thiserror::Error;

use super::{Ended, Observer, Outcome, Progress, Render, RenderState, StopFlag, what_is_computed};
use crate::film::{CheckedFileError, WholeFile, read_checked, write_checked};

/// How often a render is kept, in time of rendering; less often where writing takes long.
const INTERVAL: Duration = Duration::from_secs(60);

/// Rendering takes at least so many times as long as keeping it.
const LEAST_RATIO: u32 = 50;

/// The file of a render.
#[derive(Clone, Debug)]
pub struct Checkpoint {
    path: PathBuf,
    /// Which render it is.
    fingerprint: String,
    interval: Duration,
}

/// Why a render cannot be kept, or cannot go on from what was kept.
#[derive(Debug, Error)]
pub enum CheckpointError {
    /// The file cannot be written or read, or is damaged.
    #[error("the checkpoint {} cannot be used: {source}; name another", path.display())]
    Unusable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: CheckedFileError,
    },
    /// The render could not be kept.
    #[error("the render could not be kept in {}, where what was kept before it still is: {source}", path.display())]
    NotKept {
        /// The file.
        path: PathBuf,
        /// Why.
        source: CheckedFileError,
    },
    /// The file holds another render.
    #[error(
        "the checkpoint {} is of another render, of other settings, scene or program; delete it, or name another",
        .0.display()
    )]
    AnotherRender(PathBuf),
}

/// What a render made that was kept on its way.
#[derive(Debug)]
pub struct KeptOutcome {
    /// What it made.
    pub outcome: Outcome,
    /// Whether it could be kept at its end.
    pub kept: Result<(), CheckpointError>,
}

impl Checkpoint {
    /// The checkpoint of `render` at `path`, and what the render goes on from: what is there, or the beginning. `scene_text` is what decides the scene:
    /// that other files which it names are still the same is for the caller to know.
    ///
    /// Renders that differ only in their budget or in the number of threads are the same.
    ///
    /// # Errors
    /// The file cannot be written or read, or it is of another render.
    pub fn open(
        path: &Path,
        render: &Render,
        scene_text: &[u8],
    ) -> Result<(Self, RenderState), CheckpointError> {
        let (seed, film) = (render.settings().seed, &render.engine().scene().film);
        let what = format!("{:?} {seed} {film:?}", what_is_computed(render));
        let checkpoint = Self {
            path: path.to_owned(),
            fingerprint: fingerprint(&what, scene_text),
            interval: INTERVAL,
        };
        // Found out now rather than after hours.
        WholeFile::create(path).map_err(|error| checkpoint.refuse(error.into()))?;
        let kept: Option<(String, RenderState)> =
            read_checked(path).map_err(|error| checkpoint.refuse(error))?;
        let state = match kept {
            None => render.start(render.settings().seed),
            Some((fingerprint, state))
                if fingerprint == checkpoint.fingerprint && render.fits(&state) =>
            {
                state
            }
            Some(_) => return Err(CheckpointError::AnotherRender(path.to_owned())),
        };
        Ok((checkpoint, state))
    }

    /// The same, kept so often instead of every minute.
    pub fn every(self, interval: Duration) -> Self {
        Self { interval, ..self }
    }

    fn refuse(&self, source: CheckedFileError) -> CheckpointError {
        CheckpointError::Unusable {
            path: self.path.clone(),
            source,
        }
    }

    /// Keeps how far a render is.
    fn keep(&self, state: &RenderState) -> Result<(), CheckpointError> {
        write_checked(&self.path, &(&self.fingerprint, state)).map_err(|source| {
            CheckpointError::NotKept {
                path: self.path.clone(),
                source,
            }
        })
    }

    /// Goes on with `state` until the budget of `render`, which counts from its very beginning, is used up or `stop` is raised; and keeps it now and then,
    /// and at the end. With the same budget it makes the same image, whatever interrupts it, as [`Render::run`] does in one go.
    ///
    /// # Panics
    /// If `state` does not [fit](Render::fits). One that [`open`](Self::open) gave does.
    pub fn run(
        &self,
        render: &Render,
        mut state: RenderState,
        stop: &StopFlag,
        observer: &dyn Observer,
    ) -> KeptOutcome {
        let mut interval = self.interval;
        loop {
            let alarm = Alarm {
                time: state.duration() + interval,
                pause: stop.child(),
                observer,
            };
            let budget = render.settings().budget;
            let ended = render.advance(&mut state, budget, &alarm.pause, &alarm);
            let start = Instant::now();
            let kept = self.keep(&state);
            interval = self.interval.max(start.elapsed() * LEAST_RATIO);
            let is_paused = ended == Ended::Interrupted && !stop.is_raised();
            if !is_paused {
                let outcome = state.into_outcome(ended);
                return KeptOutcome { outcome, kept };
            }
        }
    }
}

/// What tells what is computed, by this version of the program, from anything else: `what` says how, `scene_text` of which scene.
pub(crate) fn fingerprint(what: &str, scene_text: &[u8]) -> String {
    let mut hash = Sha256::new();
    hash.update(env!("CARGO_PKG_VERSION"));
    hash.update(what);
    hash.update(scene_text);
    hash.finalize().iter().map(|b| format!("{b:02x}")).collect()
}

/// Pauses a render after some time.
struct Alarm<'o> {
    /// When, in time of rendering.
    time: Duration,
    pause: StopFlag,
    observer: &'o dyn Observer,
}

impl Observer for Alarm<'_> {
    fn progress(&self, progress: &Progress) {
        self.observer.progress(progress);
        if progress.elapsed >= self.time {
            self.pause.raise();
        }
    }
}
