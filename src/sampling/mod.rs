//! Random streams, low-discrepancy sequences, densities, and the warps that turn uniform numbers into directions and points.

mod alias;
mod frame;
mod lattice;
mod mersenne_twister;
mod pdf;
mod piecewise_bilinear;
mod random;
mod ranks;
mod sampler;
mod sobol;
pub mod warp;

pub use alias::AliasTable;
pub use frame::{FRAME_CLASSES, Frame};
pub use pdf::{AreaPdf, SolidAnglePdf, power_heuristic};
pub use piecewise_bilinear::{PiecewiseBilinear, SquarePoint};
pub use random::{RandomStream, StreamKey};
pub use ranks::Ranks;
pub use sampler::{Decisions, PixelSequences, Sampler, SamplerKind, UnknownSampler, Use};
pub use sobol::SequencePoint;
