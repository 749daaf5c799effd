//! Random streams and the warps that turn uniform numbers into directions and points.

mod random;

pub use random::{RandomStream, StreamKey};
