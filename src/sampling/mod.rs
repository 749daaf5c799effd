//! Random streams, low-discrepancy sequences, densities, and the warps that turn uniform numbers into directions and points.

mod alias;
mod frame;
mod pdf;
mod piecewise_bilinear;
mod random;
mod sampler;
mod sobol;
pub mod warp;

pub use alias::AliasTable;
pub use frame::Frame;
pub use pdf::{AreaPdf, SolidAnglePdf, power_heuristic};
pub use piecewise_bilinear::{PiecewiseBilinear, SquarePoint};
pub use random::{RandomStream, StreamKey};
pub use sampler::{Sampler, SamplerKind, UnknownSampler, Use, decision};
pub use sobol::SequencePoint;
