//! Coordinates on surfaces, for materials that ask for them.

use glam::{Vec2, Vec3};

use crate::sampling::Frame;

/// Where a point lies on its surface. Unlike a [`SurfacePoint`](super::SurfacePoint), which every vertex has, it is found only where
/// the material asks for it.
#[derive(Clone, Copy, Debug, Default)]
pub struct SurfaceParameters {
    /// Texture coordinates.
    pub uv: Vec2,
    /// Derivative of the position by u, in world space.
    pub dp_du: Vec3,
    /// Derivative of the position by v, in world space.
    pub dp_dv: Vec3,
    /// Unit normal of the true surface on the front, in world space.
    pub geometric_normal: Vec3,
}

impl SurfaceParameters {
    /// The frame about the unit shading normal `normal` whose tangent goes in the direction of u.
    pub fn shading_frame(&self, normal: Vec3) -> Frame {
        let across = self.dp_du - normal * normal.dot(self.dp_du);
        match across.try_normalize() {
            Some(tangent) => Frame {
                tangent,
                bitangent: normal.cross(tangent),
                normal,
            },
            None => Frame::about(normal),
        }
    }
}
