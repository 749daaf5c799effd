//! Where rays start so that they do not meet the surface that they leave.

use glam::Vec3;

/// Below this coordinate magnitude a fixed offset is larger than one in units of the last place.
const ORIGIN: f32 = 1.0 / 32.0;
/// The fixed offset, in scene units.
const FLOAT_SCALE: f32 = 1.0 / 65536.0;
/// The relative offset: between 256 and 512 units of the last place.
const RELATIVE_SCALE: f32 = 1.0 / 32768.0;

/// Moves `position` off its surface to the side to which `direction` points; all in world space, `normal` the unit
/// geometric normal on either side.
///
/// The distance follows the precision of each coordinate, so that it fits any scene scale: Wächter and Binder 2019, "A Fast
/// and Robust Method for Avoiding Self-Intersection", in whose code it is 256 units of the last place. Here it is in proportion
/// to the coordinate, at least as far, and without a detour over integers.
#[inline(always)]
pub(super) fn leave_surface(position: Vec3, normal: Vec3, direction: Vec3) -> Vec3 {
    let outward = towards(normal, direction);
    Vec3::new(
        position.x + scale(position.x) * outward.x,
        position.y + scale(position.y) * outward.y,
        position.z + scale(position.z) * outward.z,
    )
}

/// The same where the precision of the coordinates is not all: at least by `clearance`, in scene units.
///
/// That is how it is in instances, see [`Instance::clearance`](crate::scene::Instance::clearance).
#[inline(always)]
pub(super) fn leave_surface_by(
    clearance: f32,
    position: Vec3,
    normal: Vec3,
    direction: Vec3,
) -> Vec3 {
    let outward = towards(normal, direction);
    Vec3::new(
        position.x + scale(position.x).max(clearance) * outward.x,
        position.y + scale(position.y).max(clearance) * outward.y,
        position.z + scale(position.z).max(clearance) * outward.z,
    )
}

#[inline(always)]
fn towards(normal: Vec3, direction: Vec3) -> Vec3 {
    if normal.dot(direction) < 0.0 {
        -normal
    } else {
        normal
    }
}

/// By how much a coordinate is moved where the normal points along its axis.
#[inline(always)]
fn scale(position: f32) -> f32 {
    let magnitude = position.abs();
    if magnitude < ORIGIN {
        FLOAT_SCALE
    } else {
        RELATIVE_SCALE * magnitude
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn moves_to_the_side_of_the_direction_and_not_far(
            p in prop::array::uniform3(-1e6f32..1e6), n in prop::array::uniform3(-1.0f32..1.0), side in any::<bool>(),
        ) {
            let (p, n) = (Vec3::from(p), Vec3::from(n));
            prop_assume!(n.length() > 0.1);
            let n = n.normalize();
            let direction = if side { n } else { -n };
            let moved = leave_surface(p, n, direction) - p;
            prop_assert!(moved.dot(direction) > 0.0);
            prop_assert!(moved.length() <= 1e-4 * p.abs().max_element().max(1.0));
        }

        #[test]
        fn a_clearance_is_kept_and_none_changes_nothing(
            p in prop::array::uniform3(-1e3f32..1e3), n in prop::array::uniform3(-1.0f32..1.0), clearance in 0.1f32..10.0,
        ) {
            let (p, n) = (Vec3::from(p), Vec3::from(n));
            prop_assume!(n.length() > 0.1);
            let n = n.normalize();
            prop_assert_eq!(leave_surface_by(0.0, p, n, n), leave_surface(p, n, n));
            let moved = leave_surface_by(clearance, p, n, n) - p;
            prop_assert!(moved.dot(n) >= 0.99 * clearance);
            prop_assert!(moved.length() <= 1.01 * clearance.max(0.05));
        }
    }
}
