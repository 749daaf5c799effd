//! `sphere`: an exact sphere.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `center` | point | centre | 0, 0, 0 |
//! | `radius` | float | radius | 1 |
//! | `flip_normals` | boolean | let the inner side be the outer one | false |
//! | `to_world` | transform | moves, turns and uniformly scales the sphere; one that mirrors flips its normals | identity |
//!
//! As a light it is sampled by the cone of directions under which it is seen from outside, and by area from inside.

use std::f32::consts::PI;

use glam::{DMat3, DVec3, Mat3, Vec2, Vec3};

use super::Placement;
use super::{HitCoordinates, ShapeSample, SurfaceParameters, SurfacePoint};
use crate::sampling::{Frame, SolidAnglePdf, warp};
use crate::scene::error::SceneError;
use crate::scene::xml::Object;

/// A sphere in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Centre in world space.
    pub center: Vec3,
    /// Radius in scene units, positive.
    pub radius: f32,
    /// Whether the inner side is the outer one.
    pub flip_normals: bool,
    /// The sphere's own axes in world space, orthonormal: its texture coordinates turn about the third.
    pub axes: Mat3,
}

/// A radius in a scene file: positive.
pub(super) fn load_radius(object: &Object) -> Result<f64, SceneError> {
    let radius = object.float_or("radius", 1.0)?;
    if radius > 0.0 {
        return Ok(radius);
    }
    Err(object.parameter_error(
        "radius",
        format!("`radius` is {radius}; it must be positive"),
    ))
}

impl Sphere {
    pub(super) fn load(object: &Object, placement: &Placement) -> Result<Self, SceneError> {
        let center = object.vector("center")?.unwrap_or(DVec3::ZERO);
        let radius = load_radius(object)? * placement.uniform_scale(object)?;
        Ok(Self {
            center: placement.to_world.transform_point3(center).as_vec3(),
            radius: radius as f32,
            flip_normals: placement.flip_normals != (placement.to_world.determinant() < 0.0),
            axes: (DMat3::from_mat4(placement.to_world)
                * (1.0 / placement.uniform_scale(object)?))
            .as_mat3(),
        })
    }

    /// The nearest distance in (`near`, `far`), in units of `direction`'s length, at which a ray in world space meets
    /// the sphere.
    ///
    /// Solved in double precision by the form that does not cancel (Press et al., Numerical Recipes, section 5.6), with the discriminant from the
    /// distance between centre and line, by a cross product. Most rays that are tried here miss, and need no division.
    #[inline]
    pub fn intersect(&self, origin: Vec3, direction: Vec3, near: f32, far: f32) -> Option<f32> {
        let radius_squared = f64::from(self.radius) * f64::from(self.radius);
        let to_center = self.center.as_dvec3() - origin.as_dvec3();
        let direction = direction.as_dvec3();
        let a = direction.length_squared();
        let discriminant = a * radius_squared - direction.cross(to_center).length_squared();
        if discriminant < 0.0 {
            return None;
        }
        let b = direction.dot(to_center);
        let c = to_center.length_squared() - radius_squared;
        let q = b + discriminant.sqrt().copysign(b);
        let (t0, t1) = (c / q, q / a);
        let (first, second) = if t0 < t1 { (t0, t1) } else { (t1, t0) };
        [first as f32, second as f32]
            .into_iter()
            .find(|&t| t > near && t < far)
    }

    pub(super) fn surface(&self, hit: &HitCoordinates) -> SurfacePoint {
        let normal = hit.normal.normalize();
        SurfacePoint::flat(self.center + normal * self.radius, normal).flipped_if(self.flip_normals)
    }

    /// u is the longitude and v the angle from the pole, in units of the whole circle and of the half.
    pub(super) fn parameters(&self, point: &SurfacePoint) -> SurfaceParameters<'static> {
        let local = self.axes.transpose() * ((point.position - self.center) / self.radius);
        let across = Vec2::new(local.x, local.y).length();
        let azimuth = Vec2::new(local.x, local.y)
            .try_normalize()
            .unwrap_or(Vec2::X);
        let longitude = azimuth.y.atan2(azimuth.x).rem_euclid(2.0 * PI);
        let along_u = Vec3::new(-local.y, local.x, 0.0) * (2.0 * PI);
        let along_v = Vec3::new(local.z * azimuth.x, local.z * azimuth.y, -across) * PI;
        SurfaceParameters {
            uv: Vec2::new(longitude / (2.0 * PI), local.z.clamp(-1.0, 1.0).acos() / PI),
            dp_du: self.axes * along_u * self.radius,
            dp_dv: self.axes * along_v * self.radius,
            geometric_normal: point.geometric_normal,
            attributes: None,
        }
    }

    pub(super) fn area(&self) -> f32 {
        4.0 * std::f32::consts::PI * self.radius * self.radius
    }

    /// 1 - cos of the half angle of the cone under which the sphere is seen, or `None` from inside.
    fn cone(&self, reference: Vec3) -> Option<f32> {
        let distance_squared = (self.center - reference).length_squared();
        // Just outside, the cone is nearly a hemisphere and its edge is ill-conditioned: area sampling takes over.
        let sin_squared = self.radius * self.radius / distance_squared;
        (sin_squared < 0.999).then(|| sin_squared / (1.0 + (1.0 - sin_squared).sqrt()))
    }

    pub(super) fn sample(&self, reference: Vec3, u: [f32; 2]) -> ShapeSample {
        let Some(one_minus_cosine) = self.cone(reference) else {
            let normal = warp::sphere(u);
            let point = SurfacePoint::flat(self.center + normal * self.radius, normal);
            return ShapeSample::by_area(
                reference,
                point.flipped_if(self.flip_normals),
                self.area(),
            );
        };
        let axis = self.center - reference;
        let center_distance = axis.length();
        let local = warp::cone_about_z(u, one_minus_cosine);
        let direction = Frame::about(axis / center_distance).to_world(local);
        // The nearer of the two points in that direction; at the silhouette both coincide.
        let along = center_distance * local.z;
        let miss_squared = center_distance * center_distance * (1.0 - local.z * local.z);
        let half_chord = (self.radius * self.radius - miss_squared).max(0.0).sqrt();
        let distance = along - half_chord;
        let normal = (reference + direction * distance - self.center).normalize();
        let point = SurfacePoint::flat(self.center + normal * self.radius, normal);
        ShapeSample {
            point: point.flipped_if(self.flip_normals),
            direction,
            distance,
            pdf: warp::cone_pdf(one_minus_cosine),
        }
    }

    pub(super) fn pdf(&self, reference: Vec3, point: &SurfacePoint) -> SolidAnglePdf {
        match self.cone(reference) {
            Some(one_minus_cosine) => warp::cone_pdf(one_minus_cosine),
            None => ShapeSample::by_area(reference, *point, self.area()).pdf,
        }
    }
}
