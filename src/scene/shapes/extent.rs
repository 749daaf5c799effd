//! How far shapes reach.

use glam::Vec3;

use super::{Cylinder, Disk, Geometry, Sphere};

/// The largest coordinate of a shape. Embree leaves out, without a word, what lies beyond 1.844e18.
pub(super) const FARTHEST: f32 = 1e18;

/// Whether rays can find a point.
pub(super) fn is_near(point: Vec3) -> bool {
    point.abs().max_element() <= FARTHEST
}

impl Geometry {
    /// The least and the greatest coordinates.
    pub fn bounds(&self) -> [Vec3; 2] {
        match self {
            Self::Triangles(mesh) => {
                let used = mesh.faces().quads().iter().flatten();
                let positions = used.map(|&index| Vec3::from(mesh.vertices().position(index)));
                positions.fold(
                    [Vec3::INFINITY, Vec3::NEG_INFINITY],
                    |[min, max], position| [min.min(position), max.max(position)],
                )
            }
            Self::Sphere(sphere) => [sphere.center - sphere.radius, sphere.center + sphere.radius],
            Self::Disk(disk) => {
                let half = disk.half_extent();
                [disk.center - half, disk.center + half]
            }
            Self::Cylinder(cylinder) => {
                let (start, end) = (cylinder.start, cylinder.start + cylinder.axis);
                [
                    start.min(end) - cylinder.radius,
                    start.max(end) + cylinder.radius,
                ]
            }
        }
    }

    /// Whether rays can find the shape: its coordinates are neither too large for the intersection layer, nor so small
    /// that an exact shape loses its area to rounding (a mesh may have triangles without one).
    pub(super) fn is_within_reach(&self) -> bool {
        match self {
            Self::Triangles(mesh) => {
                let mut positions = mesh.vertices().positions();
                positions.all(|position| is_near(position.into()))
            }
            Self::Sphere(Sphere { center, radius, .. }) => {
                is_near(*center) && *radius <= FARTHEST && self.area().is_normal()
            }
            Self::Disk(Disk {
                center,
                axis_u,
                axis_v,
                ..
            }) => [*center, *axis_u, *axis_v].into_iter().all(is_near) && self.area().is_normal(),
            Self::Cylinder(Cylinder {
                start,
                axis,
                radius,
                ..
            }) => {
                is_near(*start) && is_near(*axis) && *radius <= FARTHEST && self.area().is_normal()
            }
        }
    }
}
