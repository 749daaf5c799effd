//! `disk`: an exact disk (an ellipse under non-uniform scaling), facing +z before `to_world`, of radius 1 about the origin.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `flip_normals` | boolean | let it face the other way | false |
//! | `to_world` | transform | any affine transform | identity |

use std::f32::consts::PI;

use glam::{DVec3, Vec2, Vec3};

use super::Placement;
use super::{HitCoordinates, ShapeSample, SurfaceParameters, SurfacePoint};
use crate::sampling::warp;

/// An ellipse in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    /// Centre in world space.
    pub center: Vec3,
    /// From the centre to the rim along the first axis, in world space.
    pub axis_u: Vec3,
    /// From the centre to the rim along the second axis; not parallel to the first.
    pub axis_v: Vec3,
    /// Whether the side where the axes turn clockwise is the outer one.
    pub flip_normals: bool,
}

/// Where a ray meets a disk.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiskHit {
    /// Distance in units of the ray direction's length.
    pub t: f32,
    /// Coordinate along the first axis, in [-1, 1].
    pub u: f32,
    /// Coordinate along the second axis, in [-1, 1].
    pub v: f32,
}

impl Disk {
    pub(super) fn load(placement: &Placement) -> Self {
        let axis = |local: DVec3| placement.to_world.transform_vector3(local);
        let (axis_u, axis_v) = (axis(DVec3::X), axis(DVec3::Y));
        let turned = axis_u.cross(axis_v).dot(placement.normals() * DVec3::Z) < 0.0;
        Self {
            center: placement.to_world.transform_point3(DVec3::ZERO).as_vec3(),
            axis_u: axis_u.as_vec3(),
            axis_v: axis_v.as_vec3(),
            flip_normals: placement.flip_normals != turned,
        }
    }

    /// The unit normal of the side where the axes turn counter-clockwise.
    pub fn normal(&self) -> Vec3 {
        self.axis_u.cross(self.axis_v).normalize()
    }

    /// How far the rim goes from the centre along each axis of world space.
    pub fn half_extent(&self) -> Vec3 {
        // The extent of an ellipse along an axis is the length of its two half axes' components there.
        (self.axis_u * self.axis_u + self.axis_v * self.axis_v).map(f32::sqrt)
    }

    /// Where a ray meets the disk with a distance in (`near`, `far`).
    pub fn intersect(&self, origin: Vec3, direction: Vec3, near: f32, far: f32) -> Option<DiskHit> {
        let (axis_u, axis_v) = (self.axis_u.as_dvec3(), self.axis_v.as_dvec3());
        let plane = axis_u.cross(axis_v);
        let to_center = self.center.as_dvec3() - origin.as_dvec3();
        let direction = direction.as_dvec3();
        let t = to_center.dot(plane) / direction.dot(plane);
        let inside_range = t > f64::from(near) && t < f64::from(far);
        if !inside_range {
            return None;
        }
        let point = direction * t - to_center;
        let u = point.cross(axis_v).dot(plane) / plane.length_squared();
        let v = axis_u.cross(point).dot(plane) / plane.length_squared();
        let hit = DiskHit {
            t: t as f32,
            u: u as f32,
            v: v as f32,
        };
        (u * u + v * v <= 1.0).then_some(hit)
    }

    pub(super) fn surface(&self, hit: &HitCoordinates) -> SurfacePoint {
        self.point(hit.u, hit.v)
    }

    fn point(&self, u: f32, v: f32) -> SurfacePoint {
        let position = self.center + self.axis_u * u + self.axis_v * v;
        SurfacePoint::flat(position, self.normal()).flipped_if(self.flip_normals)
    }

    /// u is the distance from the centre in units of the radius, v the angle in units of the whole circle.
    pub(super) fn parameters(
        &self,
        hit: &HitCoordinates,
        point: &SurfacePoint,
    ) -> SurfaceParameters<'static> {
        let place = Vec2::new(hit.u, hit.v);
        let (distance, azimuth) = (place.length(), place.try_normalize().unwrap_or(Vec2::X));
        let angle = azimuth.y.atan2(azimuth.x).rem_euclid(2.0 * PI);
        let around = self.axis_v * azimuth.x - self.axis_u * azimuth.y;
        SurfaceParameters {
            uv: Vec2::new(distance, angle / (2.0 * PI)),
            dp_du: self.axis_u * azimuth.x + self.axis_v * azimuth.y,
            dp_dv: around * (2.0 * PI * distance),
            geometric_normal: point.geometric_normal,
            attributes: None,
        }
    }

    pub(super) fn area(&self) -> f32 {
        PI * self.axis_u.cross(self.axis_v).length()
    }

    pub(super) fn sample(&self, reference: Vec3, u: [f32; 2]) -> ShapeSample {
        let p = warp::disk(u);
        ShapeSample::by_area(reference, self.point(p.x, p.y), self.area())
    }
}
