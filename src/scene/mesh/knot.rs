//! The procedural mesh of the built-in scene: a trefoil knot tied from a beaded tube with leaning
//! folds, so that light meets folds, hollows and thin parts without any file being there.
//!
//! The centre line is the (2, 3) torus knot
//! `C(t) = ((R + a cos 3t) cos 2t, (R + a cos 3t) sin 2t, a sin 3t)`, `t` in `[0, 2 pi)`.
//! Its cross-section lies in the frame of the torus normal and of the binormal to it, which closes
//! up after one turn by itself. Around the cross-section run spiral ridges: a radius
//! `1 + d cos(alpha)` seen at the polar angle `phi + c cos(alpha)`. That is a shear of an ordinary
//! wave, so the outline never crosses itself, however far the ridges lean over the grooves
//! beside them. Along the tube the radius swells and shrinks to thin necks.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec3;
use rayon::prelude::*;

use super::MeshData;

/// The number of triangles of the built-in scene's knot, next to the Armadillo's 345,944.
pub const DEFAULT_TRIANGLES: usize = 346_000;

/// The fewest triangles [`knot`] makes: below, the tube no longer looks like one.
pub const MIN_TRIANGLES: usize = 1_000;

/// The most triangles [`knot`] makes: above, neighbouring vertices meet in single precision.
pub const MAX_TRIANGLES: usize = 100_000_000;

/// Radius of the circle the torus is wound around.
const TORUS_MAJOR: f64 = 1.0;
/// Radius of the torus itself. Two strands are never much closer than twice this.
const TORUS_MINOR: f64 = 0.47;
/// Mean radius of the tube.
const TUBE_RADIUS: f64 = 0.235;
/// How much the tube swells and shrinks, relative to its mean radius.
const BEAD_DEPTH: f64 = 0.5;
/// Swellings along the whole tube.
const BEADS: f64 = 15.0;
/// Height of the ridges, relative to the radius at that place.
const RIDGE_DEPTH: f64 = 0.22;
/// Ridges around the tube.
const RIDGES: f64 = 8.0;
/// How often the ridges wind along the tube; an integer, so that they meet themselves.
const RIDGE_TURNS: f64 = 38.0;
/// How far a crest leans over, in radians around the tube; a ridge overhangs above `1 / RIDGES`.
const RIDGE_LEAN: f64 = 0.24;
/// Steps along the tube for each step around it, for triangles of about equal sides.
const STEPS_ALONG_PER_AROUND: f64 = 3.0;

/// Makes the knot with about `triangles` triangles (held between [`MIN_TRIANGLES`] and
/// [`MAX_TRIANGLES`]; the count made is within 5 % of that, within 1 % from 10,000 on).
///
/// The mesh is closed, consistently oriented with its normals outwards and has no degenerate
/// triangle. It stands upright about the origin: `y` is up, one of its three lobes on top, the
/// hole looks along `z`, and it fits into `|x|, |y| <= 1.9`, `|z| <= 0.9`. It has
/// neither normals nor texture coordinates. The same count gives the same bits, whatever the
/// number of threads.
pub fn knot(triangles: usize) -> MeshData {
    let vertices = triangles.clamp(MIN_TRIANGLES, MAX_TRIANGLES) as f64 / 2.0;
    let around = (vertices / STEPS_ALONG_PER_AROUND).sqrt().round() as usize;
    let along = (vertices / around as f64).round() as usize;

    let positions = (0..along)
        .into_par_iter()
        .flat_map_iter(|i| {
            let ring = Ring::at(TAU * i as f64 / along as f64);
            (0..around).map(move |j| ring.point(TAU * j as f64 / around as f64))
        })
        .collect();

    let vertex = move |i: usize, j: usize| ((i % along) * around + j % around) as u32;
    let triangles = (0..along)
        .into_par_iter()
        .flat_map_iter(|i| {
            (0..around).flat_map(move |j| {
                let (near, near_next) = (vertex(i, j), vertex(i, j + 1));
                let (far, far_next) = (vertex(i + 1, j), vertex(i + 1, j + 1));
                [[near, near_next, far], [near_next, far_next, far]]
            })
        })
        .collect();

    MeshData {
        attributes: Vec::new(),
        positions,
        normals: None,
        uvs: None,
        triangles,
    }
}

/// The cross-section of the tube at one parameter of the centre line.
#[derive(Clone, Copy)]
struct Ring {
    /// The point of the centre line.
    centre: DVec3,
    /// The unit normal of the torus there.
    normal: DVec3,
    /// The unit vector that completes tangent and normal to a right-handed frame.
    binormal: DVec3,
    /// Radius of the tube before the ridges.
    radius: f64,
    /// Phase of the ridges, in radians.
    phase: f64,
}

impl Ring {
    /// The ring at parameter `t` in `[0, 2 pi)` of the centre line.
    fn at(t: f64) -> Self {
        // A quarter turn about z puts one lobe on top.
        let (sin2, cos2) = (2.0 * t + FRAC_PI_2).sin_cos();
        let (sin3, cos3) = (3.0 * t).sin_cos();
        let outwards = DVec3::new(cos2, sin2, 0.0);
        let distance = TORUS_MAJOR + TORUS_MINOR * cos3;
        let tangent = 2.0 * distance * DVec3::new(-sin2, cos2, 0.0)
            + 3.0 * TORUS_MINOR * (cos3 * DVec3::Z - sin3 * outwards);
        let normal = cos3 * outwards + sin3 * DVec3::Z;
        Self {
            centre: distance * outwards + TORUS_MINOR * sin3 * DVec3::Z,
            normal,
            binormal: tangent.cross(normal).normalize(),
            radius: TUBE_RADIUS * (1.0 + BEAD_DEPTH * (BEADS * t).cos()),
            phase: RIDGE_TURNS * t,
        }
    }

    /// The surface point at the angle `phi`, in radians, around the ring.
    fn point(&self, phi: f64) -> [f32; 3] {
        let wave = (RIDGES * phi + self.phase).cos();
        let (sin, cos) = (phi + RIDGE_LEAN * wave).sin_cos();
        let radius = self.radius * (1.0 + RIDGE_DEPTH * wave);
        let point = self.centre + radius * (cos * self.normal + sin * self.binormal);
        point.as_vec3().to_array()
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;

    /// Twice the area of a triangle times its normal, in double precision.
    fn area_vector(mesh: &MeshData, [a, b, c]: [u32; 3]) -> DVec3 {
        let p = |i: u32| DVec3::from_array(mesh.positions[i as usize].map(f64::from));
        (p(b) - p(a)).cross(p(c) - p(a))
    }

    #[test]
    fn count_is_near_the_one_asked() {
        for (asked, tolerance) in [(1_000, 0.05), (10_000, 0.01), (346_000, 0.01)] {
            let made = knot(asked).triangles.len() as f64;
            let asked = asked as f64;
            assert!(
                (made - asked).abs() <= tolerance * asked,
                "{made} for {asked}"
            );
        }
        assert_eq!(knot(0), knot(MIN_TRIANGLES));
    }

    #[test]
    fn every_edge_is_shared_by_two_triangles_in_opposite_directions() {
        for mesh in [knot(1_000), knot(20_000)] {
            let mut edges = HashMap::new();
            for [a, b, c] in &mesh.triangles {
                for edge in [(a, b), (b, c), (c, a)] {
                    *edges.entry(edge).or_insert(0) += 1;
                }
            }
            for ((a, b), count) in &edges {
                assert_eq!(*count, 1, "edge {a}-{b} is used twice in one direction");
                assert!(edges.contains_key(&(*b, *a)), "edge {a}-{b} is open");
            }
            // A torus: vertices - edges + faces = 0, every vertex used.
            assert_eq!(mesh.positions.len() + mesh.triangles.len(), edges.len() / 2);
        }
    }

    #[test]
    fn no_triangle_is_degenerate() {
        for mesh in [knot(1_000), knot(DEFAULT_TRIANGLES)] {
            let mean = mesh
                .triangles
                .iter()
                .map(|t| area_vector(&mesh, *t).length())
                .sum::<f64>()
                / mesh.triangles.len() as f64;
            for triangle in &mesh.triangles {
                assert!(area_vector(&mesh, *triangle).length() > 0.01 * mean);
            }
        }
    }

    /// Divergence theorem: the enclosed volume is that of the tube, `integral of pi rho^2 ds`, which
    /// is positive only when the triangles look outwards.
    #[test]
    fn normals_point_outwards() {
        let mesh = knot(100_000);
        let volume = mesh
            .triangles
            .iter()
            .map(|t| {
                let a = DVec3::from_array(mesh.positions[t[0] as usize].map(f64::from));
                a.dot(area_vector(&mesh, *t)) / 6.0
            })
            .sum::<f64>();
        assert!((3.0..5.0).contains(&volume), "volume {volume}");
    }

    #[test]
    fn stands_upright_about_the_origin() {
        let mesh = knot(DEFAULT_TRIANGLES);
        let bounds = |axis: usize| {
            mesh.positions
                .iter()
                .map(|p| p[axis])
                .fold((f32::MAX, f32::MIN), |(lo, hi), x| (lo.min(x), hi.max(x)))
        };
        for (axis, limit) in [(0, 1.9), (1, 1.9), (2, 0.9)] {
            let (lo, hi) = bounds(axis);
            assert!(-limit <= lo && lo < -0.6 && hi <= limit && hi > 0.6);
        }
        // A lobe on top and a crossing below: the bottom is nearer to the centre than the top.
        let (lo, hi) = bounds(1);
        assert!(-lo < 0.85 * hi, "y from {lo} to {hi}");
    }

    #[test]
    fn bits_do_not_depend_on_the_number_of_threads() {
        let with_threads = |n| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build();
            pool.expect("thread pool").install(|| knot(20_000))
        };
        assert_eq!(with_threads(1), with_threads(3));
    }
}
