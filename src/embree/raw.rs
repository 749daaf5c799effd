//! The C declarations of whichever Embree is installed, under the same names.
//!
//! Rays and hits are not taken from here but from [`super::ray`] and [`super::packet`]: with
//! Embree 4 these declarations are older than the library, and their hits are too small.
#![allow(
    clippy::all,
    dead_code,
    missing_docs,
    non_camel_case_types,
    non_snake_case,
    non_upper_case_globals
)]

#[cfg(embree4)]
pub use embree4_sys::*;

#[cfg(embree3)]
include!(concat!(env!("OUT_DIR"), "/embree3.rs"));
