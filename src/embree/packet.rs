//! Packets of 4, 8 or 16 rays and their hits, laid out as Embree lays them out.
//!
//! Embree wants packets aligned to 16, 32 and 64 bytes; all of them are aligned to 64 here, which
//! moves no field.

use std::mem::offset_of;

use super::geometry::INVALID_GEOMETRY;

/// `K` rays in world space: origin + t · direction for t from `tnear` to `tfar`.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayPacket<const K: usize> {
    /// Where they start: all x, all y, all z.
    pub origin: [[f32; K]; 3],
    /// The smallest t, at least 0. Above `tfar`, a ray is inactive in a stream.
    pub tnear: [f32; K],
    /// Where they go; t counts in lengths of it.
    pub direction: [[f32; K]; 3],
    /// The time, 0 to 1, for moving geometry.
    pub time: [f32; K],
    /// The largest t. Set to the t of the hit, or to -∞ by the `occluded` calls.
    pub tfar: [f32; K],
    /// Only geometries that share a bit with it are met.
    pub mask: [u32; K],
    /// Not read by Embree.
    pub id: [u32; K],
    /// Reserved by Embree: 0.
    pub flags: [u32; K],
}

impl<const K: usize> RayPacket<K> {
    /// `K` rays that are inactive until they are [`set`](Self::set).
    pub const INACTIVE: Self = Self {
        origin: [[0.0; K]; 3],
        tnear: [1.0; K],
        direction: [[0.0; K]; 3],
        time: [0.0; K],
        tfar: [0.0; K],
        mask: [u32::MAX; K],
        id: [0; K],
        flags: [0; K],
    };

    /// Puts a ray into a lane.
    ///
    /// # Panics
    /// When `lane` is not below `K`.
    pub fn set(
        &mut self,
        lane: usize,
        origin: [f32; 3],
        direction: [f32; 3],
        tnear: f32,
        tfar: f32,
    ) {
        for axis in 0..3 {
            self.origin[axis][lane] = origin[axis];
            self.direction[axis][lane] = direction[axis];
        }
        self.tnear[lane] = tnear;
        self.tfar[lane] = tfar;
    }

    /// Whether an `occluded` call found something in the way of a ray.
    ///
    /// # Panics
    /// When `lane` is not below `K`.
    pub fn is_occluded(&self, lane: usize) -> bool {
        self.tfar[lane] == f32::NEG_INFINITY
    }
}

/// What `K` rays hit. Each t is the ray's `tfar`.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HitPacket<const K: usize> {
    /// The geometric normals, of any length: all x, all y, all z. In world space, or in the space of the scene that stands in
    /// an instance.
    pub normal: [[f32; K]; 3],
    /// First coordinate on the primitive (see [`super::QuadMesh`]).
    pub u: [f32; K],
    /// Second coordinate on the primitive.
    pub v: [f32; K],
    /// Which primitive of the geometry.
    pub primitive_id: [u32; K],
    /// Which geometry, or [`INVALID_GEOMETRY`] when nothing was hit.
    pub geometry_id: [u32; K],
    /// Which instance, or [`INVALID_GEOMETRY`] outside instances.
    pub instance_id: [u32; K],
    /// Which one of an array of instances; only Embree 4 writes it.
    #[cfg(embree4)]
    pub(super) instance_primitive_id: [u32; K],
}

impl<const K: usize> HitPacket<K> {
    /// No hits: the state before rays are traced.
    pub const MISS: Self = Self {
        normal: [[0.0; K]; 3],
        u: [0.0; K],
        v: [0.0; K],
        primitive_id: [INVALID_GEOMETRY; K],
        geometry_id: [INVALID_GEOMETRY; K],
        instance_id: [INVALID_GEOMETRY; K],
        #[cfg(embree4)]
        instance_primitive_id: [INVALID_GEOMETRY; K],
    };
}

/// `K` rays together with the place for their hits.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHitPacket<const K: usize> {
    /// The rays.
    pub ray: RayPacket<K>,
    /// What they hit.
    pub hit: HitPacket<K>,
}

impl<const K: usize> RayHitPacket<K> {
    /// Rays that have not been traced.
    pub fn new(ray: RayPacket<K>) -> Self {
        Self {
            ray,
            hit: HitPacket::MISS,
        }
    }
}

/// Which rays of a packet are traced.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ValidMask<const K: usize>([i32; K]);

impl<const K: usize> ValidMask<K> {
    /// Every ray.
    pub const ALL: Self = Self([-1; K]);

    /// The rays whose lane passes the test.
    pub fn from_fn(mut test: impl FnMut(usize) -> bool) -> Self {
        Self(std::array::from_fn(|lane| -i32::from(test(lane))))
    }

    /// Whether a ray is traced.
    ///
    /// # Panics
    /// When `lane` is not below `K`.
    pub fn is_valid(&self, lane: usize) -> bool {
        self.0[lane] != 0
    }

    pub(super) fn as_ptr(&self) -> *const i32 {
        self.0.as_ptr()
    }
}

// The layout is Embree's. With Embree 4, vendor-ffi/embree4_layout.c holds the headers to the same.
const fn assert_layout<const K: usize>() {
    assert!(size_of::<RayPacket<K>>() == 48 * K && offset_of!(RayPacket<K>, tfar) == 32 * K);
    assert!(offset_of!(RayHitPacket<K>, hit) == 48 * K);
    assert!(offset_of!(HitPacket<K>, instance_id) == 28 * K);
    #[cfg(embree4)]
    assert!(offset_of!(HitPacket<K>, instance_primitive_id) == 32 * K);
}
const _: () = {
    assert_layout::<4>();
    assert_layout::<8>();
    assert_layout::<16>();
    #[cfg(embree3)]
    {
        assert!(size_of::<RayHitPacket<4>>() == size_of::<super::raw::RTCRayHit4>());
        assert!(size_of::<RayHitPacket<8>>() == size_of::<super::raw::RTCRayHit8>());
        assert!(size_of::<RayHitPacket<16>>() == size_of::<super::raw::RTCRayHit16>());
    }
};
