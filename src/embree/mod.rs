//! Ray tracing by Embree, made safe: the only room of the house with `unsafe` code.
//!
//! A [`Device`] holds what Embree shares between scenes. A [`SceneBuilder`] collects
//! [`QuadMesh`]es, [`UserGeometry`] and [`Instance`]s of other scenes and builds a [`Scene`], which is
//! then traced from any number of threads by one of four kinds of call:
//!
//! | call | rays | when |
//! |---|---|---|
//! | [`Scene::intersect1`] | [`RayHit1`] | one ray at a time |
//! | [`Scene::intersect_packet`] | [`RayHitPacket`] of 4, 8 or 16 | rays with much in common |
//! | [`Scene::intersect_stream`] | [`Rays`] and [`Hits`], a structure of arrays | batches |
//! | [`Scene::intersect_stream_1m`], [`Scene::intersect_stream_nm`] | slices of the first two | |
//!
//! and the `occluded` form of each, which only asks whether anything is in the way.
//!
//! Debian's Embree 3.13 and Embree 4.3 are both served and `build.rs` chooses; `raw` and `calls`
//! are the only files that know which one it is. All of this room works in world space,
//! but for what stands in instances.
#![allow(unsafe_code)]

mod buffer;
mod calls;
mod denormals;
mod device;
mod error;
mod geometry;
mod instance;
mod lanes;
mod packet;
pub mod plain_c;
mod quad_mesh;
mod query;
mod raw;
mod ray;
mod scene;
mod stream;
mod user_geometry;
mod version;

#[cfg(test)]
mod tests;

pub(crate) use buffer::prefetch;
pub use buffer::{FlatVertex, SmoothVertex, VertexBuffer};
pub use denormals::{DenormalsFlushed, flush_denormals_to_zero};
pub use device::Device;
pub use error::{EmbreeError, ErrorKind};
pub use geometry::{Bounds, GeometryId, INVALID_GEOMETRY};
pub use instance::{Affine, Instance};
pub use packet::{HitPacket, RayHitPacket, RayPacket, ValidMask};
pub use quad_mesh::{Half, QuadMesh};
pub use query::Coherence;
pub use ray::{Hit1, Ray1, RayHit1};
pub use scene::{BuildOptions, BuildQuality, Scene, SceneBuilder};
pub use stream::{Hits, OnPrimitives, Rays, RaysMut};
pub use user_geometry::{UserGeometry, UserHit, UserRay};
pub use version::{Version, version};
