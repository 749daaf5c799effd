//! Fresnel's equations for unpolarised light, and the directions that go with them.
//!
//! `eta` is the index of refraction behind an interface over the one before it, where "before" is the side that a direction comes
//! from; cosines are against the interface's normal on that side.

use glam::Vec3;

/// What happens at a smooth interface of two dielectrics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Interface {
    /// Share of the light that is reflected; 1 in total internal reflection.
    pub reflectance: f32,
    /// Cosine of the refracted direction against the normal behind the interface, in [0, 1].
    pub cos_refracted: f32,
}

/// The interface at the absolute cosine `cos`, in [0, 1].
#[inline]
pub(super) fn dielectric(cos: f32, eta: f32) -> Interface {
    if eta == 1.0 {
        return Interface {
            reflectance: 0.0,
            cos_refracted: cos,
        };
    }
    // Snell's law.
    let sin_squared = (1.0 - cos * cos).max(0.0) / (eta * eta);
    if sin_squared >= 1.0 {
        return Interface {
            reflectance: 1.0,
            cos_refracted: 0.0,
        };
    }
    let cos_refracted = (1.0 - sin_squared).sqrt();
    let perpendicular = (cos - eta * cos_refracted) / (cos + eta * cos_refracted);
    let parallel = (cos_refracted - eta * cos) / (cos_refracted + eta * cos);
    Interface {
        reflectance: 0.5 * (perpendicular * perpendicular + parallel * parallel),
        cos_refracted,
    }
}

/// The share of light that a conductor with the complex relative index eta + i k reflects at the cosine `cos` in [0, 1]
/// (Moeller 1988, "Optics").
#[inline]
pub(super) fn conductor(cos: f32, eta: f32, k: f32) -> f32 {
    let cos_squared = cos * cos;
    let sin_squared = 1.0 - cos_squared;
    let difference = eta * eta - k * k - sin_squared;
    let root = (difference * difference + 4.0 * k * k * eta * eta).sqrt();
    let a = (0.5 * (root + difference)).max(0.0).sqrt();
    let (sum, mixed) = (root + cos_squared, 2.0 * cos * a);
    let perpendicular = (sum - mixed) / (sum + mixed);
    let (sum, mixed) = (
        root * cos_squared + sin_squared * sin_squared,
        mixed * sin_squared,
    );
    let parallel = perpendicular * (sum - mixed) / (sum + mixed);
    0.5 * (perpendicular + parallel)
}

/// The share of diffuse light that an interface reflects: fits by Egan and Hilgeman 1973 where `eta` < 1 and by d'Eon and
/// Irving 2011 elsewhere, as in Mitsuba.
pub(super) fn diffuse_reflectance(eta: f32) -> f32 {
    let inverse = 1.0 / eta;
    if eta < 1.0 {
        return 0.0636 * inverse + eta * (eta * -1.4399 + 0.7099) + 0.6681;
    }
    let coefficients = [-1.36881, 4.98554, -7.80989, 6.75335, -3.4793, 0.919317];
    coefficients
        .into_iter()
        .fold(0.0, |sum, coefficient| sum * inverse + coefficient)
}

/// `direction` mirrored about the unit vector `normal`; both point away from the surface.
#[inline]
pub(super) fn reflect(direction: Vec3, normal: Vec3) -> Vec3 {
    normal * (2.0 * direction.dot(normal)) - direction
}

/// `direction` mirrored about local z.
#[inline]
pub(super) fn reflect_local(direction: Vec3) -> Vec3 {
    Vec3::new(-direction.x, -direction.y, direction.z)
}

/// The direction into which `direction`, which is on the side of the unit vector `normal`, goes on behind an interface;
/// `cos_refracted` is that of [`dielectric`].
#[inline]
pub(super) fn refract(direction: Vec3, normal: Vec3, cos_refracted: f32, eta: f32) -> Vec3 {
    let inverse = 1.0 / eta;
    normal * (direction.dot(normal) * inverse - cos_refracted) - direction * inverse
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn dielectrics_are_mitsubas() {
        // mi.fresnel(cos, eta) and mi.fresnel(-cos, 1 / eta)
        for (cos, eta, reflectance, cos_refracted) in [
            (1.0, 1.5, 0.04, 1.0),
            (0.5, 1.5, 0.0891867, 0.81649658),
            (0.1, 1.33, 0.5389898, 0.663_573_8),
            (0.5, 1.0 / 1.5, 1.0, 0.0),
            (0.9, 1.0 / 1.5, 0.04633264, 0.7566373),
        ] {
            let found = dielectric(cos, eta);
            assert!((found.reflectance - reflectance).abs() < 2e-6, "{found:?}");
            assert!(
                (found.cos_refracted - cos_refracted).abs() < 2e-6,
                "{found:?}"
            );
        }
    }

    #[test]
    fn a_perfect_conductor_reflects_all_and_one_without_absorption_is_a_dielectric() {
        for cos in [0.01, 0.3, 0.7, 1.0] {
            assert!((conductor(cos, 0.0, 1.0) - 1.0).abs() < 1e-6);
            let glass = dielectric(cos, 1.5).reflectance;
            assert!((conductor(cos, 1.5, 0.0) - glass).abs() < 1e-5, "{cos}");
        }
    }

    #[test]
    fn diffuse_light_is_reflected_as_the_integral_says() {
        for eta in [1.1f32, 1.33, 1.5, 1.0 / 1.33, 1.0 / 1.5] {
            let steps = 100_000;
            let integral: f64 = (0..steps)
                .map(|i| {
                    let cos = (i as f32 + 0.5) / steps as f32;
                    2.0 * f64::from(cos * dielectric(cos, eta).reflectance) / f64::from(steps)
                })
                .sum();
            let fitted = f64::from(diffuse_reflectance(eta));
            assert!(
                (fitted - integral).abs() < 5e-3,
                "{eta}: {fitted} instead of {integral}"
            );
        }
    }

    proptest! {
        #[test]
        fn refraction_is_reversible_and_loses_nothing(
            x in -0.99f32..0.99, y in -0.99f32..0.99, eta in 0.4f32..2.5,
        ) {
            let z_squared = 1.0 - x * x - y * y;
            prop_assume!(z_squared > 1e-3);
            let direction = Vec3::new(x, y, z_squared.sqrt());
            let there = dielectric(direction.z, eta);
            prop_assume!(there.cos_refracted > 1e-2);
            let refracted = refract(direction, Vec3::Z, there.cos_refracted, eta);
            prop_assert!((refracted.length() - 1.0).abs() < 1e-4);
            let back = dielectric(-refracted.z, 1.0 / eta);
            prop_assert!((there.reflectance - back.reflectance).abs() < 1e-3);
            let again = refract(refracted, -Vec3::Z, back.cos_refracted, 1.0 / eta);
            prop_assert!((again - direction).length() < 1e-2, "{again} {direction}");
        }
    }
}
