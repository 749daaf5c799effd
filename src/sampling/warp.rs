//! Maps from the unit square to directions and points, each with its density.

use std::f32::consts::{FRAC_1_PI, FRAC_PI_4, PI};

use glam::{Vec2, Vec3};

use super::SolidAnglePdf;
use crate::functions::{atan_of_at_most_one, sin_cos_of_eighth, sin_cos_of_turn};

/// A uniform point of the unit disk, by the concentric map (Shirley and Chiu 1997).
#[inline(always)]
pub fn disk(u: [f32; 2]) -> Vec2 {
    let x = 2.0 * u[0] - 1.0;
    let y = 2.0 * u[1] - 1.0;
    // No branches: which half of the square a point lies in cannot be foreseen.
    let is_wide = x.abs() > y.abs();
    let (radius, other) = if is_wide { (x, y) } else { (y, x) };
    let ratio = if radius == 0.0 { 0.0 } else { other / radius };
    let (sin, cos) = sin_cos_of_eighth(FRAC_PI_4 * ratio);
    let (along, across) = (radius * cos, radius * sin);
    if is_wide {
        Vec2::new(along, across)
    } else {
        // The angle is pi/2 less the one above.
        Vec2::new(across, along)
    }
}

/// A local direction of the upper hemisphere (z > 0), distributed like its cosine.
#[inline(always)]
pub fn cosine_hemisphere(u: [f32; 2]) -> Vec3 {
    let p = disk(u);
    // A point on the rim would be a direction in the surface, which has density 0.
    let z = (1.0 - p.length_squared()).max(1e-12).sqrt();
    Vec3::new(p.x, p.y, z)
}

/// The point of the unit square that [`cosine_hemisphere`] maps to `direction`, of which z is not negative.
#[inline(always)]
pub fn cosine_hemisphere_inverse(direction: Vec3) -> [f32; 2] {
    let (x, y) = (direction.x, direction.y);
    let radius = (x * x + y * y).sqrt();
    let is_wide = x.abs() > y.abs();
    let (along, across) = if is_wide { (x, y) } else { (y, x) };
    let ratio = if along == 0.0 { 0.0 } else { across / along };
    let radius = radius.copysign(along);
    let other = radius * atan_of_at_most_one(ratio) / FRAC_PI_4;
    let (x, y) = if is_wide {
        (radius, other)
    } else {
        (other, radius)
    };
    [0.5 * (x + 1.0), 0.5 * (y + 1.0)]
}

/// The density of [`cosine_hemisphere`] for a direction with cosine `cosine` (0 below the horizon).
#[inline(always)]
pub fn cosine_hemisphere_pdf(cosine: f32) -> SolidAnglePdf {
    SolidAnglePdf(cosine.max(0.0) * FRAC_1_PI)
}

/// A uniform direction of the whole sphere.
#[inline]
pub fn sphere(u: [f32; 2]) -> Vec3 {
    cone_about_z(u, 2.0)
}

/// The density of [`sphere`].
pub const SPHERE_PDF: SolidAnglePdf = SolidAnglePdf(0.25 * FRAC_1_PI);

/// A uniform direction of the cone about local z whose half angle `a` is given by `one_minus_cosine` = 1 - cos(a),
/// in [0, 2] (a form that stays exact for narrow cones).
#[inline]
pub fn cone_about_z(u: [f32; 2], one_minus_cosine: f32) -> Vec3 {
    let height = u[0] * one_minus_cosine;
    let z = 1.0 - height;
    // 1 - z^2 = height (2 - height), without cancellation near the pole.
    let r = (height * (2.0 - height)).max(0.0).sqrt();
    let (sin, cos) = sin_cos_of_turn(u[1]);
    Vec3::new(r * cos, r * sin, z)
}

/// The density of [`cone_about_z`].
#[inline]
pub fn cone_pdf(one_minus_cosine: f32) -> SolidAnglePdf {
    SolidAnglePdf(1.0 / (2.0 * PI * one_minus_cosine))
}

/// Uniform barycentric coordinates (of the second and third vertex) in a triangle.
///
/// The map of Heitz 2019, "A Low-Distortion Map Between Triangle and Square".
#[inline]
pub fn triangle(u: [f32; 2]) -> [f32; 2] {
    if u[1] > u[0] {
        let x = 0.5 * u[0];
        [x, u[1] - x]
    } else {
        let y = 0.5 * u[1];
        [u[0] - y, y]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_inverse_of_the_cosine_map_finds_the_point() {
        const N: usize = 101;
        for i in 0..N * N {
            let u = [i / N, i % N].map(|k| (k as f32 + 0.5) / N as f32);
            let back = cosine_hemisphere_inverse(cosine_hemisphere(u));
            for axis in 0..2 {
                assert!((back[axis] - u[axis]).abs() < 1e-6, "{u:?} {back:?}");
            }
        }
    }
    use crate::sampling::{RandomStream, StreamKey};

    fn mean_over_samples<const N: usize>(f: impl Fn([f32; 2]) -> [f32; N]) -> [f64; N] {
        let mut random = RandomStream::new(StreamKey {
            seed: 7,
            tile: 0,
            pass: 0,
        });
        let n = 200_000;
        let mut sum = [0.0; N];
        for _ in 0..n {
            let value = f(random.uniform_2d());
            for (s, v) in sum.iter_mut().zip(value) {
                *s += f64::from(v) / f64::from(n);
            }
        }
        sum
    }

    fn assert_close(got: &[f64], want: &[f64]) {
        for (g, w) in got.iter().zip(want) {
            assert!((g - w).abs() < 5e-3, "{got:?} instead of {want:?}");
        }
    }

    /// The corners, edges and centre of the square go to where the map says (Shirley and Chiu 1997, figure 3).
    #[test]
    fn the_square_covers_the_disk() {
        use std::f32::consts::FRAC_1_SQRT_2 as S;
        for (u, p) in [
            ([0.5, 0.5], [0.0, 0.0]),
            ([1.0, 0.5], [1.0, 0.0]),
            ([0.5, 1.0], [0.0, 1.0]),
            ([0.0, 0.5], [-1.0, 0.0]),
            ([1.0, 1.0], [S, S]),
            ([0.0, 1.0], [-S, S]),
            ([0.0, 0.0], [-S, -S]),
        ] {
            assert!((disk(u) - Vec2::from(p)).length() < 1e-6, "{u:?}");
        }
    }

    #[test]
    fn moments_are_those_of_the_distributions() {
        assert_close(
            &mean_over_samples(|u| {
                let p = disk(u);
                [p.x, p.y, p.length_squared()]
            }),
            &[0.0, 0.0, 0.5],
        );
        assert_close(
            &mean_over_samples(|u| {
                let d = cosine_hemisphere(u);
                [d.x, d.y, d.z, d.z * d.z]
            }),
            &[0.0, 0.0, 2.0 / 3.0, 0.5],
        );
        assert_close(
            &mean_over_samples(|u| {
                let d = sphere(u);
                [d.x, d.y, d.z, d.z * d.z, d.length()]
            }),
            &[0.0, 0.0, 0.0, 1.0 / 3.0, 1.0],
        );
        assert_close(
            &mean_over_samples(|u| {
                let b = triangle(u);
                [b[0], b[1], b[0] * b[0], b[0] * b[1]]
            }),
            &[1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0, 1.0 / 12.0],
        );
        assert_close(&mean_over_samples(|u| [cone_about_z(u, 0.3).z]), &[0.85]);
    }
}
