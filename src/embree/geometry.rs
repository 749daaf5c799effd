//! What triangle meshes and user geometries have in common.

use super::device::Device;
use super::error::EmbreeError;
use super::raw;

/// The geometry number of a ray that hit nothing.
pub const INVALID_GEOMETRY: u32 = u32::MAX;

/// Coordinates from here on are taken by Embree for invalid; it leaves their primitives out.
const TOO_LARGE: f32 = 1.8e18;

/// The number of a geometry in its scene: 0, 1, 2 … in the order of adding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct GeometryId(pub u32);

/// A box along the axes, in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The corner with the smallest coordinates.
    pub min: [f32; 3],
    /// The corner with the largest coordinates.
    pub max: [f32; 3],
}

impl Bounds {
    /// Whether Embree can use them.
    pub(super) fn are_valid(&self) -> bool {
        is_valid(self.min)
            && is_valid(self.max)
            && (0..3).all(|axis| self.min[axis] <= self.max[axis])
    }
}

/// Whether Embree can use a point.
pub(super) fn is_valid(point: [f32; 3]) -> bool {
    point.iter().all(|coordinate| coordinate.abs() < TOO_LARGE)
}

/// Embree's own object for a geometry, released when dropped. A scene keeps what is attached to it.
pub(super) struct GeometryHandle(raw::RTCGeometry);

impl GeometryHandle {
    pub(super) fn new(device: &Device, kind: raw::RTCGeometryType) -> Result<Self, EmbreeError> {
        // SAFETY: the device is alive.
        let raw = unsafe { raw::rtcNewGeometry(device.raw(), kind) };
        device.check("make a geometry")?;
        // Embree 4 gives geometries the mask 1, Embree 3 all bits: all bits, so that no ray's mask
        // means something else there.
        // SAFETY: the geometry was made above without error.
        unsafe { raw::rtcSetGeometryMask(raw, u32::MAX) };
        Ok(Self(raw))
    }

    pub(super) fn raw(&self) -> raw::RTCGeometry {
        self.0
    }
}

impl Drop for GeometryHandle {
    fn drop(&mut self) {
        // SAFETY: this is the one reference that `rtcNewGeometry` gave.
        unsafe { raw::rtcReleaseGeometry(self.0) }
    }
}
