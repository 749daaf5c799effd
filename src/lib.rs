//! Cohort: an unbiased spectral path tracer that resamples whole cohorts of light paths together.
#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod models;
pub mod sampling;
pub mod scene;
