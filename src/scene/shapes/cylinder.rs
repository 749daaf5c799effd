//! `cylinder`: the exact mantle of a circular cylinder, without caps. Its outer side is outside.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `p0` | point | one end of the axis | 0, 0, 0 |
//! | `p1` | point | the other end of the axis | 0, 0, 1 |
//! | `radius` | float | radius | 1 |
//! | `flip_normals` | boolean | let the inner side be the outer one | false |
//! | `to_world` | transform | moves, turns and uniformly scales the cylinder | identity |

use std::f32::consts::PI;

use glam::{DVec3, Vec2, Vec3};

use super::Placement;
use super::sphere::load_radius;
use super::{HitCoordinates, ShapeSample, SurfaceParameters, SurfacePoint};
use crate::functions::sin_cos_of_turn;
use crate::sampling::Frame;
use crate::scene::error::SceneError;
use crate::scene::xml::Object;

/// A cylinder mantle in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// One end of the axis, in world space.
    pub start: Vec3,
    /// From that end to the other, in world space; not zero.
    pub axis: Vec3,
    /// Radius in scene units, positive.
    pub radius: f32,
    /// Whether the inner side is the outer one.
    pub flip_normals: bool,
    /// Unit vectors across the axis, in world space: texture coordinates turn from the first to the second.
    pub across: [Vec3; 2],
}

/// Where a ray meets a cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CylinderHit {
    /// Distance in units of the ray direction's length.
    pub t: f32,
    /// Position along the axis, 0 at its start and 1 at its end.
    pub along: f32,
    /// Unit vector from the axis to the point, in world space.
    pub radial: Vec3,
}

impl Cylinder {
    pub(super) fn load(object: &Object, placement: &Placement) -> Result<Self, SceneError> {
        let start = object.vector("p0")?.unwrap_or(DVec3::ZERO);
        let end = object.vector("p1")?.unwrap_or(DVec3::Z);
        let radius = load_radius(object)? * placement.uniform_scale(object)?;
        let Some(along) = (end - start).try_normalize() else {
            return Err(object.error("the ends `p0` and `p1` of the cylinder coincide"));
        };
        let own = Frame::about(along.as_vec3());
        let cylinder = Self {
            start: placement.to_world.transform_point3(start).as_vec3(),
            axis: placement.to_world.transform_vector3(end - start).as_vec3(),
            radius: radius as f32,
            flip_normals: placement.flip_normals,
            across: [own.tangent, own.bitangent].map(|local| {
                let world = placement.to_world.transform_vector3(local.as_dvec3());
                world.as_vec3().normalize_or_zero()
            }),
        };
        Ok(cylinder)
    }

    /// The nearest hit with a distance in (`near`, `far`), solved in double precision.
    pub fn intersect(
        &self,
        origin: Vec3,
        direction: Vec3,
        near: f32,
        far: f32,
    ) -> Option<CylinderHit> {
        let axis = self.axis.as_dvec3();
        let axis_squared = axis.length_squared();
        let from_start = origin.as_dvec3() - self.start.as_dvec3();
        let direction = direction.as_dvec3();
        let across = |v: glam::DVec3| v - axis * (v.dot(axis) / axis_squared);
        let (o, d) = (across(from_start), across(direction));
        let a = d.length_squared();
        // A ray along the axis meets the mantle nowhere (or everywhere on a line, which has measure zero).
        if a == 0.0 {
            return None;
        }
        let radius = f64::from(self.radius);
        let b = -o.dot(d);
        let discriminant = radius * radius - (o + d * (b / a)).length_squared();
        if discriminant < 0.0 {
            return None;
        }
        let q = b + (a * discriminant).sqrt().copysign(b);
        let c = o.length_squared() - radius * radius;
        let (t0, t1) = (c / q, q / a);
        let ordered = if t0 < t1 { [t0, t1] } else { [t1, t0] };
        ordered.into_iter().find_map(|t| {
            let along = (from_start + direction * t).dot(axis) / axis_squared;
            let hit = t > f64::from(near) && t < f64::from(far) && (0.0..=1.0).contains(&along);
            hit.then(|| CylinderHit {
                t: t as f32,
                along: along as f32,
                radial: ((o + d * t) / radius).as_vec3(),
            })
        })
    }

    pub(super) fn surface(&self, hit: &HitCoordinates) -> SurfacePoint {
        self.point(hit.u, hit.normal.normalize())
    }

    fn point(&self, along: f32, radial: Vec3) -> SurfacePoint {
        let position = self.start + self.axis * along + radial * self.radius;
        SurfacePoint::flat(position, radial).flipped_if(self.flip_normals)
    }

    /// u is the angle in units of the whole circle, v the position along the axis.
    pub(super) fn parameters(
        &self,
        hit: &HitCoordinates,
        point: &SurfacePoint,
    ) -> SurfaceParameters<'static> {
        let radial = hit.normal.normalize_or_zero();
        let [x, y] = self.across.map(|axis| axis.dot(radial));
        let angle = y.atan2(x).rem_euclid(2.0 * PI);
        let around = self.across[1] * x - self.across[0] * y;
        SurfaceParameters {
            uv: Vec2::new(angle / (2.0 * PI), hit.u),
            dp_du: around * (2.0 * PI * self.radius),
            dp_dv: self.axis,
            geometric_normal: point.geometric_normal,
            attributes: None,
        }
    }

    pub(super) fn area(&self) -> f32 {
        2.0 * PI * self.radius * self.axis.length()
    }

    pub(super) fn sample(&self, reference: Vec3, u: [f32; 2]) -> ShapeSample {
        let (sin, cos) = sin_cos_of_turn(u[0]);
        let radial = Frame::about(self.axis.normalize()).to_world(Vec3::new(cos, sin, 0.0));
        ShapeSample::by_area(reference, self.point(u[1], radial), self.area())
    }
}
