//! Cohort: an unbiased spectral path tracer that resamples whole cohorts of light paths together.
#![deny(unsafe_code)]
#![warn(missing_docs)]

pub mod embree;
pub mod film;
pub mod models;
pub mod render;
pub mod sampling;
pub mod scene;
pub mod spectrum;
pub mod transport;
pub mod walk;
