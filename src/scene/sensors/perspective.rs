//! `perspective`: a pinhole camera.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `fov` | float | field of view in degrees along `fov_axis`, in (0, 180) | see `focal_length` |
//! | `focal_length` | string | the same as a 35 mm equivalent such as `50mm`, along the diagonal | 50mm |
//! | `fov_axis` | string | `x`, `y`, `diagonal`, `smaller` or `larger` | x |
//! | `near_clip` | float | nearest depth that is seen, in scene units | 0.01 |
//! | `far_clip` | float | farthest depth that is seen, in scene units | 10000 |
//! | `principal_point_offset_x`, `_y` | float | shift of the image in fractions of its size | 0 |
//! | `focus_distance` | float | accepted, since every camera may state it; a pinhole is always in focus | |
//! | `to_world` | transform | camera to world: the camera looks along +z, +y is up, +x is left | identity |
//!
//! It contains the `film` and the `sampler`.

use glam::{DMat4, DVec3, Vec2, Vec3};

use super::camera::{CameraError, CameraRay, load_clipping_planes};
use super::{FieldOfView, ImageSize};
use crate::scene::error::SceneError;
use crate::scene::xml::Object;

/// A pinhole camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perspective {
    to_world: DMat4,
    field_of_view: FieldOfView,
    near: f64,
    far: f64,
    principal_point_offset: Vec2,
}

impl Perspective {
    pub(super) fn load(object: &Object) -> Result<Self, SceneError> {
        let field_of_view = FieldOfView::load(object)?;
        let clip = load_clipping_planes(object)?;
        let offset = glam::DVec2::new(
            object.float_or("principal_point_offset_x", 0.0)?,
            object.float_or("principal_point_offset_y", 0.0)?,
        );
        object.float("focus_distance")?;
        let to_world = object.transform("to_world")?.unwrap_or(DMat4::IDENTITY);
        Self::new(to_world, field_of_view, clip, offset.as_vec2())
            .map_err(|error| object.error(error.to_string()))
    }

    /// The camera whose space `to_world` maps to world space, with the defaults of scene files otherwise; none where there is no such one.
    pub fn usual(to_world: DMat4) -> Option<Self> {
        let normal_lens = FieldOfView::from_focal_length(50.0);
        Self::new(to_world, normal_lens, (1e-2, 1e4), Vec2::ZERO).ok()
    }

    /// The camera whose space `to_world` maps to world space (it looks along +z, +y is up, +x is left), clipping at the
    /// depths `near` and `far` in scene units, its image shifted by `principal_point_offset` in fractions of its size.
    pub fn new(
        to_world: DMat4,
        field_of_view: FieldOfView,
        (near, far): (f64, f64),
        principal_point_offset: Vec2,
    ) -> Result<Self, CameraError> {
        if !(field_of_view.degrees > 0.0 && field_of_view.degrees < 180.0) {
            return Err(CameraError::FieldOfView(field_of_view.degrees));
        }
        CameraError::check(to_world, near, far)?;
        let camera = Self {
            to_world,
            field_of_view,
            near,
            far,
            principal_point_offset,
        };
        let square = ImageSize {
            width: 1,
            height: 1,
        };
        let PinholeView { origin, corner, .. } = camera.view(square);
        if !(origin.is_finite() && corner.length_squared().is_normal()) {
            return Err(CameraError::OutOfRange);
        }
        Ok(camera)
    }

    /// The camera in front of a film of this size, ready to make rays.
    pub fn view(&self, film: ImageSize) -> PinholeView {
        let (width, height) = (f64::from(film.width), f64::from(film.height));
        let half_width = self.field_of_view.half_width(width / height);
        let half_height = half_width * height / width;
        let axis = |local: DVec3| self.to_world.transform_vector3(local).as_vec3();
        // Raster x grows to the right and camera x to the left; raster y grows downwards and camera y upwards.
        let per_column = axis(DVec3::new(-2.0 * half_width / width, 0.0, 0.0));
        let per_row = axis(DVec3::new(0.0, -2.0 * half_height / height, 0.0));
        let shift = self.principal_point_offset;
        let corner_x = half_width * (1.0 - 2.0 * f64::from(shift.x));
        let corner_y = half_height * (1.0 - 2.0 * f64::from(shift.y));
        PinholeView {
            origin: self.to_world.transform_point3(DVec3::ZERO).as_vec3(),
            corner: axis(DVec3::new(corner_x, corner_y, 1.0)),
            per_column,
            per_row,
            near: self.near as f32,
            far: self.far as f32,
        }
    }
}

/// A pinhole camera in front of a film: an affine map from raster positions to points of the plane at depth 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PinholeView {
    pub(super) origin: Vec3,
    pub(super) corner: Vec3,
    pub(super) per_column: Vec3,
    pub(super) per_row: Vec3,
    pub(super) near: f32,
    pub(super) far: f32,
}

impl PinholeView {
    /// The distance at which a ray of the camera with this unit direction meets the far clipping plane.
    pub fn far_along(&self, direction: Vec3) -> f32 {
        let normal = self.per_column.cross(self.per_row);
        self.far * self.corner.dot(normal) / direction.dot(normal)
    }

    /// Where the ray through `raster` is at depth 1, relative to the pinhole, in world space.
    #[inline(always)]
    pub(super) fn at_unit_depth(&self, raster: Vec2) -> Vec3 {
        self.corner + self.per_column * raster.x + self.per_row * raster.y
    }

    /// The ray through `raster`, in pixels from the upper left corner of the whole film (not of its crop window).
    #[inline(always)]
    pub fn ray(&self, raster: Vec2) -> CameraRay {
        let at_unit_depth = self.at_unit_depth(raster);
        let length = at_unit_depth.length();
        CameraRay {
            origin: self.origin,
            direction: at_unit_depth * (1.0 / length),
            near: self.near * length,
            far: self.far * length,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::sensors::FovAxis;

    fn camera(axis: FovAxis) -> Perspective {
        let fov = FieldOfView {
            degrees: 90.0,
            axis,
        };
        Perspective::new(DMat4::IDENTITY, fov, (1.0, 100.0), Vec2::ZERO).unwrap()
    }

    #[test]
    fn the_field_of_view_reaches_the_edges_of_its_axis() {
        let film = ImageSize {
            width: 200,
            height: 100,
        };
        let edge = |axis, x, y| {
            let ray = camera(axis).view(film).ray(Vec2::new(x, y));
            ray.direction / ray.direction.z
        };
        assert!((edge(FovAxis::X, 0.0, 50.0) - Vec3::new(1.0, 0.0, 1.0)).length() < 1e-6);
        assert!((edge(FovAxis::Larger, 200.0, 50.0) - Vec3::new(-1.0, 0.0, 1.0)).length() < 1e-6);
        assert!((edge(FovAxis::Y, 100.0, 0.0) - Vec3::new(0.0, 1.0, 1.0)).length() < 1e-6);
        assert!((edge(FovAxis::Smaller, 100.0, 100.0) - Vec3::new(0.0, -1.0, 1.0)).length() < 1e-6);
        let corner = edge(FovAxis::Diagonal, 0.0, 0.0);
        assert!((corner.truncate().length() - 1.0).abs() < 1e-6);
    }

    #[test]
    fn clipping_planes_are_planes() {
        let ray = camera(FovAxis::X)
            .view(ImageSize {
                width: 10,
                height: 10,
            })
            .ray(Vec2::ZERO);
        assert!((ray.near * ray.direction.z - 1.0).abs() < 1e-6);
        assert!((ray.far * ray.direction.z - 100.0).abs() < 1e-4);
        assert!(
            (camera(FovAxis::X)
                .view(ImageSize {
                    width: 10,
                    height: 10
                })
                .far_along(ray.direction)
                - ray.far)
                .abs()
                < 1e-3
        );
    }

    #[test]
    fn nonsense_is_refused() {
        let fov = |degrees| FieldOfView {
            degrees,
            axis: FovAxis::X,
        };
        for (degrees, near, far) in [
            (0.0, 1.0, 2.0),
            (180.0, 1.0, 2.0),
            (40.0, 0.0, 2.0),
            (40.0, 3.0, 2.0),
            (f64::NAN, 1.0, 2.0),
        ] {
            assert!(
                Perspective::new(DMat4::IDENTITY, fov(degrees), (near, far), Vec2::ZERO).is_err()
            );
        }
        for (to_world, error) in [
            (DMat4::ZERO, CameraError::SingularTransform),
            (
                DMat4::from_translation(DVec3::splat(1e40)),
                CameraError::OutOfRange,
            ),
            (
                DMat4::from_scale(DVec3::splat(1e-30)),
                CameraError::OutOfRange,
            ),
            (
                DMat4::from_scale(DVec3::splat(1e25)),
                CameraError::OutOfRange,
            ),
        ] {
            let camera = Perspective::new(to_world, fov(40.0), (1.0, 2.0), Vec2::ZERO);
            assert_eq!(camera, Err(error));
        }
    }
}
