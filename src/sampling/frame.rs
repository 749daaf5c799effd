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
    /// The frame about the unit vector `normal`, continuous within each [class](Self::class) of normals.
    ///
    /// It is that of Duff et al. 2017, "Building an Orthonormal Basis, Revisited", where the axis nearest to the normal stands for z: their sign
    /// is the same within a class, and the denominator far from zero.
    #[inline(always)]
    pub fn about(normal: Vec3) -> Self {
        let (is_x, is_y) = nearest_axis(normal);
        let select = |x: f32, y: f32, z: f32| {
            if is_x {
                x
            } else if is_y {
                y
            } else {
                z
            }
        };
        let Vec3 { x, y, z } = normal;
        // The axes in turn, so that handedness stays.
        let (x, y, z) = (select(y, z, x), select(z, x, y), select(x, y, z));
        let sign = 1.0_f32.copysign(z);
        let a = -1.0 / (sign + z);
        let b = x * y * a;
        let in_turn =
            |x: f32, y: f32, z: f32| Vec3::new(select(z, y, x), select(x, z, y), select(y, x, z));
        Self {
            tangent: in_turn(1.0 + sign * x * x * a, sign * b, -sign * x),
            bitangent: in_turn(b, sign + y * y * a, -y),
            normal,
        }
    }

    /// Which of the six axis directions `normal`, of any length, is nearest to: a number below [`FRAME_CLASSES`].
    #[inline(always)]
    pub fn class(normal: Vec3) -> u32 {
        let (is_x, is_y) = nearest_axis(normal);
        let (axis, along) = if is_x {
            (0, normal.x)
        } else if is_y {
            (1, normal.y)
        } else {
            (2, normal.z)
        };
        2 * axis + u32::from(along < 0.0)
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

/// The number of classes of normals.
pub const FRAME_CLASSES: usize = 6;

/// Whether the axis nearest to `vector` is x, and whether it is y.
#[inline(always)]
fn nearest_axis(vector: Vec3) -> (bool, bool) {
    let size = vector.abs();
    let is_x = (size.x >= size.y) & (size.x >= size.z);
    (is_x, !is_x & (size.y >= size.z))
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

        #[test]
        fn is_continuous_within_a_class(x in -1.0f32..1.0, y in -1.0f32..1.0, class in 0_u32..6) {
            let along = if class % 2 == 0 { 1.0 } else { -1.0 };
            let about = |x: f32, y: f32| {
                let normal = match class / 2 {
                    0 => Vec3::new(along, x, y),
                    1 => Vec3::new(x, along, y),
                    _ => Vec3::new(x, y, along),
                };
                (Frame::class(normal), Frame::about(normal.normalize()))
            };
            let ((one, a), (other, b)) = (about(0.999 * x, 0.999 * y), about(0.998 * x, 0.998 * y));
            prop_assert_eq!((one, other), (class, class));
            prop_assert!((a.tangent - b.tangent).length() < 0.01);
            prop_assert!((a.bitangent - b.bitangent).length() < 0.01);
        }
    }
}
