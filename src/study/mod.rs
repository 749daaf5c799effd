//! What accuracy costs in time: competitors at equal budgets, their errors, and how sure that is.
//!
//! ```text
//! Plan --> contenders --turn by turn (race)--> records, images --assemble--> Results --> report
//!             reference, lit pixels ----------------^
//! ```
//!
//! - [`Plan`], [`EntrySettings`], [`Axis`]: what is to be done, and who takes part
//! - [`Contender`]: a render that goes on and stops when it is told to; ours and Mitsuba's
//! - `timeline`, `race`: turns of one repetition; `kept`: what makes a study resumable
//! - [`reference`](mod@reference), [`measures`], [`statistics`], [`pairs`](mod@pairs): errors and how sure they are
//! - [`Cost`]: what an effect of a scene costs, apart from all that
//! - [`results`]: everything that was found; [`report`]: how it is shown

pub mod accuracy;
mod assemble;
mod contender;
mod effect_cost;
mod entry;
mod error;
pub mod false_colour;
mod flip;
mod kept;
mod lit;
mod machine;
pub mod measures;
mod mitsuba_contender;
pub mod pairs;
pub mod peer;
mod pictures;
mod plan;
mod race;
pub mod reference;
pub mod report;
pub mod results;
mod run;
pub mod statistics;
#[cfg(test)]
mod synthetic;
#[cfg(test)]
mod tests;
mod timeline;
mod verdict;

pub use accuracy::Axis;
pub use contender::{Contender, OurRender, Repetition, Standing};
pub use effect_cost::{Cost, TURNS};
pub use entry::{EntrySettings, SpecError, StrategySpec};
pub use error::StudyError;
pub use mitsuba_contender::MitsubaContender;
pub use peer::MitsubaVariant;
pub use plan::{How, Plan, Planned, ReferencePlan, SceneSource, Variation};
pub use run::{StudyEnd, StudyObserver, run};
