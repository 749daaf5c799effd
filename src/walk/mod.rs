//! The random-walk strategies: who gets how many children.
//!
//! A path tracer walks from the eye, and at every vertex it must decide for each path whether to go on, and whether
//! with one continuation or with several. A [`Strategy`] decides for a whole [`Population`] at once, as a pure function of
//! a few numbers per particle: nothing here knows of rays or scenes.
//!
//! ```text
//! Population --rule--> expected counts nu --rounding, jointly in a scope--> integers n --> Offspring
//! importance, albedo,                                                     E[n] = nu        (parent, 1 / nu)
//! shininess, group
//! ```
//!
//! Because a child carries 1 / nu, every rule and every rounding gives the same image on average.
//!
//! - [`population`], [`offspring`]: what goes in and what comes out
//! - [`strategy`]: the three things that make a strategy
//! - [`fixed_depth`], [`roulette`], [`throughput_roulette`], [`go_with_the_winners`], [`particle_filter`],
//!   [`adjoint_roulette`], [`ears`]: one rule each
//! - [`learned`]: what a render has learned of its particles, for the last three
//! - [`expected_count`]: nu as an exact number
//! - [`resampling`]: the ways of rounding
//! - [`options`], [`error`]: strategies by name, with checked settings
//!
//! ```
//! use cohort::sampling::{RandomStream, StreamKey};
//! use cohort::walk::{Offspring, Population, StrategyKind, StrategyOptions};
//!
//! # fn main() -> Result<(), cohort::walk::SettingError> {
//! let strategy = "particle-filter".parse::<StrategyKind>()?.build(&StrategyOptions::default())?;
//! let population = Population {
//!     importance: &[1.0, 1.0, 0.1, 0.1],
//!     albedo: &[0.5; 4],
//!     shininess: &[0.0; 4],
//!     group: &[0; 4],
//!     paths: 4,
//!     depth: 1,
//!     points: None,
//!     learned: None,
//! };
//! let mut random = RandomStream::new(StreamKey { seed: 1, tile: 0, pass: 0 });
//! let mut offspring = Offspring::new();
//! let report = strategy.resample(&population, &mut random, &mut offspring);
//!
//! assert_eq!(report.dropped(), 0);
//! // Nothing is learned yet: 1, 1, .5 and .5 children are expected, which sum to 3, and particles of a pixel are rounded together.
//! assert_eq!(offspring.children().len(), 3);
//! # Ok(())
//! # }
//! ```

pub mod adjoint_roulette;
pub mod ears;
pub mod error;
pub mod expected_count;
pub mod fixed_depth;
pub mod go_with_the_winners;
pub mod learned;
pub mod objective;
pub mod offspring;
pub mod options;
pub mod particle_filter;
pub mod population;
pub mod resampling;
pub mod roulette;
pub mod strategy;
pub mod throughput_roulette;

#[cfg(test)]
mod tests;

pub use adjoint_roulette::AdjointRoulette;
pub use ears::Ears;
pub use error::SettingError;
pub use expected_count::ExpectedCount;
pub use fixed_depth::FixedDepth;
pub use go_with_the_winners::GoWithTheWinners;
pub use learned::Learned;
pub use objective::Objective;
pub use offspring::{Child, Offspring};
pub use options::{StrategyKind, StrategyOptions};
pub use particle_filter::{CountRule, ParticleFilter};
pub use population::{Population, WalkReport};
pub use resampling::{ResidualRest, Rounding};
pub use roulette::Roulette;
pub use strategy::{Scalar, Scope, Strategy};
pub use throughput_roulette::ThroughputRoulette;
