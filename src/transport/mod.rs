//! The engine: batches of path states, and the stages that move them one bounce on.
//!
//! ```text
//!  camera -> intersect -> emission -> walk -> direct -> scatter -> ... -> splat
//!                ^                                         |
//!                +-----------------------------------------+
//! ```
//!
//! A batch holds all camera paths of one tile in one pass. Path states are structures of arrays: `Segments` are rays
//! on their way, `Vertices` the surface points that they reached. Every stage is one file and one loop. Children of
//! one parent stand side by side from the strategy's decision on; so they share hit point, material and direct light,
//! and their rays are neighbours in the stream. The strategy decides before light is sampled: how light sampling and the children share the light of
//! an emitter depends on how many children are expected (multi-sample MIS, Veach 1997, section 9.2.4).

mod accelerator;
mod arrange;
mod batch;
mod camera;
mod colour_table;
mod direct;
mod emission;
mod emission_table;
mod engine;
mod framed;
mod general;
mod guidance;
mod hidden_emitters;
mod intersect;
mod light_chunk;
mod lineage;
mod matte;
mod offset;
mod path_counts;
mod pipeline;
mod recollection;
mod recorded_rays;
mod remember;
mod scatter;
mod settings;
mod shape_table;
mod splat;
mod stages;
mod statistics;
mod surface;
mod tracer;
mod triangle_names;
mod variant;
mod walk_stage;

pub use accelerator::{Accelerator, AcceleratorOptions};
pub use engine::{Engine, TileJob};
pub use path_counts::PathCounts;
pub use recorded_rays::RecordedRays;
pub use settings::{DirectLight, TransportSettings};
pub use stages::{Stage, StageTimes};
pub use statistics::TraceStatistics;
pub use tracer::{TraceBatches, Tracer};
