//! The driver: from a scene and settings to a film, within a budget, in one go or in slices.

mod allocation;
mod checkpoint;
mod driver;
mod memory;
mod metadata;
mod progress;
mod schedule;
mod settings;
mod state;
mod trial;
mod watch;

pub(crate) use checkpoint::fingerprint;
pub use checkpoint::{Checkpoint, CheckpointError, KeptOutcome};
pub use driver::{MAX_THREADS, Render, RenderError};
pub use metadata::{metadata, processor_name, what_is_computed};
pub use progress::{Observer, Progress, StopFlag};
pub use schedule::Schedule;
pub use settings::{Budget, ColourMode, Settings, WavelengthCount};
pub use state::{Ended, Outcome, RenderState};
