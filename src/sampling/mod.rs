//! Random streams, densities, and the warps that turn uniform numbers into directions and points.

mod alias;
mod frame;
mod pdf;
mod random;
pub mod warp;

pub use alias::AliasTable;
pub use frame::Frame;
pub use pdf::{AreaPdf, SolidAnglePdf, power_heuristic};
pub use random::{RandomStream, StreamKey};
