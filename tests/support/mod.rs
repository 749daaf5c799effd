//! What the tests of images share.
#![allow(dead_code, reason = "every test file uses a part of it")]

pub mod comparison;
pub mod estimate;
pub mod files;
pub mod mitsuba;
pub mod render;
pub mod replicates;
pub mod room;
