//! The calls that trace rays, in the words of whichever Embree is installed.
//!
//! Both files offer the same functions. They are safe: a [`super::Scene`] is always committed, rays
//! and hits are laid out and aligned as Embree wants them, and what they hold cannot do harm.

#[cfg(embree3)]
mod embree3;
#[cfg(embree4)]
mod embree4;

#[cfg(embree3)]
pub(super) use embree3::*;
#[cfg(embree4)]
pub(super) use embree4::*;
