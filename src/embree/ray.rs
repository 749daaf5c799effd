//! One ray and its hit, laid out as Embree lays them out.

use std::mem::offset_of;

use super::geometry::INVALID_GEOMETRY;

/// A ray in world space: origin + t · direction for t from `tnear` to `tfar`.
#[repr(C, align(16))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray1 {
    /// Where it starts.
    pub origin: [f32; 3],
    /// The smallest t, at least 0. Above `tfar`, the ray is inactive.
    pub tnear: f32,
    /// Where it goes; t counts in lengths of it.
    pub direction: [f32; 3],
    /// The time, 0 to 1, for moving geometry.
    pub time: f32,
    /// The largest t. Set to the t of the hit, or to -∞ by the `occluded` calls.
    pub tfar: f32,
    /// Only geometries that share a bit with it are met.
    pub mask: u32,
    /// Not read by Embree.
    pub id: u32,
    /// Reserved by Embree: 0.
    pub flags: u32,
}

impl Ray1 {
    /// A ray at time 0 that meets every geometry.
    pub fn new(origin: [f32; 3], direction: [f32; 3], tnear: f32, tfar: f32) -> Self {
        Self {
            origin,
            tnear,
            direction,
            time: 0.0,
            tfar,
            mask: u32::MAX,
            id: 0,
            flags: 0,
        }
    }

    /// Whether an `occluded` call found something in the way.
    pub fn is_occluded(&self) -> bool {
        self.tfar == f32::NEG_INFINITY
    }
}

/// What a ray hit. Its t is the ray's `tfar`.
#[repr(C, align(16))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit1 {
    /// The geometric normal, of any length: in world space, or in the space of the scene that stands in an instance.
    pub normal: [f32; 3],
    /// First coordinate on the primitive (see [`super::QuadMesh`]).
    pub u: f32,
    /// Second coordinate on the primitive.
    pub v: f32,
    /// Which primitive of the geometry.
    pub primitive_id: u32,
    /// Which geometry, or [`INVALID_GEOMETRY`] when nothing was hit.
    pub geometry_id: u32,
    /// Which instance, or [`INVALID_GEOMETRY`] outside instances.
    pub instance_id: u32,
    /// Which one of an array of instances; only Embree 4 writes it.
    #[cfg(embree4)]
    pub(super) instance_primitive_id: u32,
}

impl Hit1 {
    /// No hit: the state before a ray is traced.
    pub const MISS: Self = Self {
        normal: [0.0; 3],
        u: 0.0,
        v: 0.0,
        primitive_id: INVALID_GEOMETRY,
        geometry_id: INVALID_GEOMETRY,
        instance_id: INVALID_GEOMETRY,
        #[cfg(embree4)]
        instance_primitive_id: INVALID_GEOMETRY,
    };

    /// Whether something was hit.
    pub fn is_hit(&self) -> bool {
        self.geometry_id != INVALID_GEOMETRY
    }
}

/// A ray together with the place for its hit.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit1 {
    /// The ray.
    pub ray: Ray1,
    /// What it hit.
    pub hit: Hit1,
}

impl RayHit1 {
    /// A ray that has not been traced.
    pub fn new(ray: Ray1) -> Self {
        Self {
            ray,
            hit: Hit1::MISS,
        }
    }
}

// The layout is Embree's. With Embree 4, vendor-ffi/embree4_layout.c holds the headers to the same.
const _: () = {
    assert!(size_of::<Ray1>() == 48 && offset_of!(Ray1, tfar) == 32);
    assert!(offset_of!(RayHit1, hit) == 48 && offset_of!(Hit1, instance_id) == 28);
    #[cfg(embree3)]
    assert!(size_of::<RayHit1>() == size_of::<super::raw::RTCRayHit>());
    #[cfg(embree4)]
    assert!(size_of::<RayHit1>() == 96 && offset_of!(Hit1, instance_primitive_id) == 32);
};
