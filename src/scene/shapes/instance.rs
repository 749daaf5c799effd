//! `instance`: the shapes of a group in another place.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | (nested) | shape | the `shapegroup` that is shown: a `<ref>` to one, or one nested here | required |
//! | `to_world` | transform | any affine transform with an inverse, from the group's space to the world | identity |
//!
//! Outer sides stay outer sides, even under a transform that mirrors. An instance has no bsdf of its own: materials belong to the
//! shapes of the group. In memory, a group is there once, however many instances show it.

use glam::{DMat3, DMat4, Mat3, Vec3};

use super::extent::{FARTHEST, is_near};
use super::{Geometry, HitCoordinates, ShapeGroup, SurfaceParameters, SurfacePoint};
use crate::scene::ShapeGroupId;
use crate::scene::error::SceneError;
use crate::scene::load::Loader;
use crate::scene::xml::{Class, Object};

/// A group of shapes in its place in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// The group that it shows.
    pub group: ShapeGroupId,
    /// Where the axes of the group's space go.
    axes: Mat3,
    /// Where the origin of the group's space goes.
    origin: Vec3,
    /// The inverse of the map of axes.
    inverse: Mat3,
}

/// The greatest stretching, and the greatest shrinking, of a group.
const MOST_SCALED: f32 = 1e15;

/// A bound for the relative error of what is summed up on the way of a point to the group's space or back: the inverse matrix that the
/// intersection layer makes, its translation, and a product with a vector take fewer than 16 roundings.
const ROUNDING: f32 = 8.0 * f32::EPSILON;

impl Instance {
    /// The group `group` moved by `to_world`; `None` if that has no inverse in single precision, in which rays are traced.
    pub fn new(group: ShapeGroupId, to_world: DMat4) -> Option<Self> {
        let exact = DMat3::from_mat4(to_world);
        let (axes, origin) = (exact.as_mat3(), to_world.w_axis.truncate().as_vec3());
        let is_fine = |matrix: Mat3| {
            let mut entries = matrix.to_cols_array().into_iter();
            entries.all(|entry| entry.abs() <= MOST_SCALED)
        };
        let is_invertible = axes.determinant().is_normal() && is_fine(axes.inverse());
        (is_fine(axes) && is_invertible && origin.is_finite()).then(|| Self {
            group,
            axes,
            origin,
            inverse: exact.inverse().as_mat3(),
        })
    }

    /// The instance that `object` states, its group loaded by `loader` if it is a new one.
    pub(in crate::scene) fn load(object: &Object, loader: &mut Loader) -> Result<Self, SceneError> {
        let Some(shown) = object.child(Class::Shape)? else {
            return Err(object.error(
                "the `instance` needs a `shapegroup` to show, such as <ref id=\"...\"/> of one",
            ));
        };
        if shown.object.plugin != "shapegroup" {
            let message = format!(
                "an `instance` shows a `shapegroup`, not the {}",
                shown.object
            );
            return Err(SceneError::at(&shown.location, message));
        }
        let to_world = object.transform("to_world")?.unwrap_or(DMat4::IDENTITY);
        let group = loader.group(&shown.object)?;
        object.finish()?;
        let Some(instance) = Self::new(group, to_world) else {
            return Err(object.parameter_error(
                "to_world",
                "`to_world` of the `instance` has no inverse in single precision: it flattens the group, or makes it too large or \
                 too small",
            ));
        };
        if instance.is_within_reach(loader.known_group(group)) {
            return Ok(instance);
        }
        Err(object.error(format!(
            "this `instance` is too large or too far away: coordinates must be at most {FARTHEST:e}"
        )))
    }

    fn is_within_reach(&self, group: &ShapeGroup) -> bool {
        let mut corners = (0..8).map(|corner| {
            Vec3::from_array(std::array::from_fn(|axis| {
                group.bounds[corner >> axis & 1][axis]
            }))
        });
        corners.all(|corner| is_near(self.position(corner)))
    }

    /// Where the unit vectors of the group's space go.
    pub fn axes(&self) -> [Vec3; 3] {
        [self.axes.x_axis, self.axes.y_axis, self.axes.z_axis]
    }

    /// Where the origin of the group's space goes.
    pub fn origin(&self) -> Vec3 {
        self.origin
    }

    #[inline]
    fn position(&self, local: Vec3) -> Vec3 {
        self.axes * local + self.origin
    }

    #[inline]
    fn normal(&self, local: Vec3) -> Vec3 {
        transposed(&self.inverse, local).normalize_or_zero()
    }

    /// The point of the world that `local`, a point of one of the group's shapes in the group's space, is here.
    #[inline]
    pub fn point(&self, local: &SurfacePoint) -> SurfacePoint {
        SurfacePoint {
            position: self.position(local.position),
            geometric_normal: self.normal(local.geometric_normal),
            shading_normal: self.normal(local.shading_normal),
        }
    }

    /// Where a hit on `geometry`, one of the group's shapes, lies on it; directions are in world space.
    pub fn parameters<'s>(
        &self,
        geometry: &'s Geometry,
        hit: &HitCoordinates,
    ) -> SurfaceParameters<'s> {
        let local = geometry.parameters(hit, &geometry.surface(hit));
        SurfaceParameters {
            dp_du: self.axes * local.dp_du,
            dp_dv: self.axes * local.dp_dv,
            geometric_normal: self.normal(local.geometric_normal),
            ..local
        }
    }

    /// The least distance by which a ray from `point`, one of the instance in world space, must start off the surface, so that
    /// rounding does not bring it back or to the other side.
    ///
    /// Such a ray is moved to the group's space and so rounded in other directions and by other amounts than `point` itself shows:
    /// where a large translation is added to coordinates that are large the other way, much is lost of a small sum. Bounds of both
    /// errors, that of `point` in the world and that of the ray in the group's space, component by component, say how far the two
    /// reach along the normal (Pharr, Jakob and Humphreys, Physically Based Rendering, 4th edition, section 6.8).
    #[inline]
    pub fn clearance(&self, point: &SurfacePoint) -> f32 {
        let (normal, origin) = (point.geometric_normal, self.origin.abs());
        let local = self.inverse * (point.position - self.origin);
        let sum = self.axes.abs() * local.abs() + origin;
        let in_group = self.inverse.abs() * (point.position.abs() + sum);
        let along_normal = transposed(&self.axes, normal).abs();
        ROUNDING * (normal.abs().dot(sum) + along_normal.dot(in_group))
    }
}

/// The product of the transpose of `matrix` and a vector.
#[inline]
fn transposed(matrix: &Mat3, vector: Vec3) -> Vec3 {
    Vec3::new(
        matrix.x_axis.dot(vector),
        matrix.y_axis.dot(vector),
        matrix.z_axis.dot(vector),
    )
}
