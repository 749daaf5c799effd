//! Confidence intervals over independent repetitions, and what a series of errors over time says.
//!
//! `docs/measures.md` explains the intervals, says where they come from and how well they cover.

mod bootstrap;
mod convergence;
mod interval;
#[cfg(test)]
mod tests;

pub use convergence::{CoursePoint, slope, time_to_reach};
pub use interval::{Interval, products};
