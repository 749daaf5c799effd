//! Which Embree runs.

use std::fmt;
use std::num::NonZeroUsize;

use super::device::Device;
use super::error::EmbreeError;

/// The version of the Embree library in use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Version {
    /// 3 or 4.
    pub major: u32,
    /// Counts features.
    pub minor: u32,
    /// Counts corrections.
    pub patch: u32,
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}.{}", self.major, self.minor, self.patch)
    }
}

/// The version of the library itself, not of the headers the program was built with.
///
/// Only a device knows it, so one is made for the question; whoever has one asks
/// [`Device::version`].
///
/// # Errors
/// The error of [`Device::new`], for example on a processor that Embree does not support.
pub fn version() -> Result<Version, EmbreeError> {
    Ok(Device::new(NonZeroUsize::MIN)?.version())
}
