//! Watching a render, and stopping it.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// How far a render is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The share of the budget, or of what the advance goes until, that is used, in [0, 1].
    pub share: f64,
    /// Time of rendering so far.
    pub elapsed: Duration,
    /// Camera paths so far, over all pixels.
    pub camera_paths: u64,
    /// Rays so far.
    pub rays: u64,
    /// Camera paths per pixel so far, in the mean.
    pub samples_per_pixel: f64,
}

/// Somebody who wants to know how far a render is.
pub trait Observer: Sync {
    /// Called a few times a second from one of the rendering threads; it should return soon.
    fn progress(&self, progress: &Progress);
}

/// Nobody.
impl Observer for () {
    fn progress(&self, _progress: &Progress) {}
}

/// Asks a render to stop after the batches that are under way. Clones are the same flag.
#[derive(Clone, Debug, Default)]
pub struct StopFlag {
    raised: Arc<AtomicBool>,
    parent: Option<Arc<StopFlag>>,
}

impl StopFlag {
    /// A flag that is not raised.
    pub fn new() -> Self {
        Self::default()
    }

    /// A flag that is raised when this one is, or alone.
    pub fn child(&self) -> Self {
        Self {
            raised: Arc::default(),
            parent: Some(Arc::new(self.clone())),
        }
    }

    /// Asks to stop.
    pub fn raise(&self) {
        self.raised.store(true, Ordering::Relaxed);
    }

    /// Whether somebody asked to stop.
    pub fn is_raised(&self) -> bool {
        let is_raised_above = || {
            self.parent
                .as_ref()
                .is_some_and(|parent| parent.is_raised())
        };
        self.raised.load(Ordering::Relaxed) || is_raised_above()
    }
}
