//! Orthonormal frames.

use glam::Vec3;

/// A right-handed orthonormal frame; local z is `normal`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Local x axis, in world space.
    pub tangent: Vec3,
    /// Local y axis, in world space.
    pub bitangent: Vec3,
    /// Local z axis, in world space.
    pub normal: Vec3,
}

impl Frame {
    /// The frame about the unit vector `normal` (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
    #[inline(always)]
    pub fn about(normal: Vec3) -> Self {
        let sign = 1.0_f32.copysign(normal.z);
        let a = -1.0 / (sign + normal.z);
        let b = normal.x * normal.y * a;
        Self {
            tangent: Vec3::new(
                1.0 + sign * normal.x * normal.x * a,
                sign * b,
                -sign * normal.x,
            ),
            bitangent: Vec3::new(b, sign + normal.y * normal.y * a, -normal.y),
            normal,
        }
    }

    /// A world direction in this frame.
    #[inline]
    pub fn to_local(&self, world: Vec3) -> Vec3 {
        Vec3::new(
            world.dot(self.tangent),
            world.dot(self.bitangent),
            world.dot(self.normal),
        )
    }

    /// A direction of this frame in world space.
    #[inline(always)]
    pub fn to_world(&self, local: Vec3) -> Vec3 {
        self.tangent * local.x + self.bitangent * local.y + self.normal * local.z
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn is_orthonormal_and_right_handed(x in -1.0f32..1.0, y in -1.0f32..1.0, z in -1.0f32..1.0) {
            let v = Vec3::new(x, y, z);
            prop_assume!(v.length() > 1e-3);
            let frame = Frame::about(v.normalize());
            prop_assert!(frame.tangent.dot(frame.bitangent).abs() < 1e-5);
            prop_assert!((frame.tangent.cross(frame.bitangent) - frame.normal).length() < 1e-5);
            let w = Vec3::new(0.3, -0.5, 0.7);
            prop_assert!((frame.to_world(frame.to_local(w)) - w).length() < 1e-5);
        }
    }
}
