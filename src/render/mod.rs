//! The driver: from a scene and settings to a film, within a budget.

mod driver;
mod memory;
mod metadata;
mod progress;
mod schedule;
mod settings;

pub use driver::{Ended, MAX_THREADS, Outcome, Render, RenderError};
pub use metadata::metadata;
pub use progress::{Observer, Progress, StopFlag};
pub use schedule::Schedule;
pub use settings::{Budget, ColourMode, Settings};
