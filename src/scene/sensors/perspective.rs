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
use thiserror::Error;

use super::{CameraRay, ImageSize};
use crate::scene::error::{SceneError, list};
use crate::scene::xml::Object;

/// Along which side of the image the field of view is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FovAxis {
    /// Horizontally.
    X,
    /// Vertically.
    Y,
    /// From corner to corner.
    Diagonal,
    /// Along the shorter side.
    Smaller,
    /// Along the longer side.
    Larger,
}

impl FovAxis {
    /// The names in scene files.
    pub const NAMES: [&'static str; 5] = ["x", "y", "diagonal", "smaller", "larger"];

    /// The axis with this name in scene files.
    pub fn from_name(name: &str) -> Option<Self> {
        Some(match name {
            "x" => Self::X,
            "y" => Self::Y,
            "diagonal" => Self::Diagonal,
            "smaller" => Self::Smaller,
            "larger" => Self::Larger,
            _ => return None,
        })
    }
}

/// How much a camera sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FieldOfView {
    /// Full angle in degrees, in (0, 180).
    pub degrees: f64,
    /// Where it is measured.
    pub axis: FovAxis,
}

impl FieldOfView {
    /// The field of view of a lens with this 35 mm equivalent focal length in mm.
    pub fn from_focal_length(millimetres: f64) -> Self {
        let diagonal = 36.0_f64.hypot(24.0);
        Self {
            degrees: 2.0 * (0.5 * diagonal / millimetres).atan().to_degrees(),
            axis: FovAxis::Diagonal,
        }
    }

    /// The tangent of half the horizontal field of view for an image of this width over height.
    fn half_width(&self, aspect: f64) -> f64 {
        let tangent = (0.5 * self.degrees).to_radians().tan();
        match self.axis {
            FovAxis::X => tangent,
            FovAxis::Y => tangent * aspect,
            FovAxis::Diagonal => tangent * aspect / 1.0_f64.hypot(aspect),
            FovAxis::Smaller if aspect > 1.0 => tangent * aspect,
            FovAxis::Larger if aspect < 1.0 => tangent * aspect,
            FovAxis::Smaller | FovAxis::Larger => tangent,
        }
    }
}

/// What cannot be a camera.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum CameraError {
    /// The field of view is out of range.
    #[error("the field of view is {0} degrees; it must be above 0 and below 180")]
    FieldOfView(f64),
    /// The clipping planes are out of order.
    #[error("the clipping planes are at {near} and {far}; they must satisfy 0 < near < far")]
    ClippingPlanes {
        /// `near_clip`
        near: f64,
        /// `far_clip`
        far: f64,
    },
    /// `to_world` scales by zero or is not finite.
    #[error("`to_world` of the camera has no inverse")]
    SingularTransform,
    /// Rays of the camera would have coordinates that `f32` cannot hold.
    #[error(
        "the camera is too far away, or its `to_world` or field of view is too extreme, for 32-bit coordinates"
    )]
    OutOfRange,
}

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
        let field_of_view = match (object.float("fov")?, object.string("focal_length")?) {
            (Some(_), Some(_)) => {
                let message = "`fov` and `focal_length` cannot both be given";
                return Err(object.parameter_error("focal_length", message));
            }
            (Some(degrees), None) => {
                let name = object.string_or("fov_axis", "x")?;
                let axis = FovAxis::from_name(name).ok_or_else(|| {
                    let names = list(FovAxis::NAMES);
                    object.parameter_error(
                        "fov_axis",
                        format!("`fov_axis` is `{name}`; it must be one of {names}"),
                    )
                })?;
                FieldOfView { degrees, axis }
            }
            (None, focal_length) => {
                let text = focal_length.unwrap_or("50mm");
                let number = text.strip_suffix("mm").unwrap_or(text).trim().parse().ok();
                let millimetres = number.filter(|&mm: &f64| mm > 0.0 && mm.is_finite()).ok_or_else(|| {
                    let message = format!("`focal_length` is `{text}`; it must be a positive number of millimetres such as 50mm");
                    object.parameter_error("focal_length", message)
                })?;
                FieldOfView::from_focal_length(millimetres)
            }
        };
        let clip = (
            object.float_or("near_clip", 1e-2)?,
            object.float_or("far_clip", 1e4)?,
        );
        let offset = glam::DVec2::new(
            object.float_or("principal_point_offset_x", 0.0)?,
            object.float_or("principal_point_offset_y", 0.0)?,
        );
        object.float("focus_distance")?;
        let to_world = object.transform("to_world")?.unwrap_or(DMat4::IDENTITY);
        Self::new(to_world, field_of_view, clip, offset.as_vec2())
            .map_err(|error| object.error(error.to_string()))
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
        if !(near > 0.0 && near < far) {
            return Err(CameraError::ClippingPlanes { near, far });
        }
        let determinant = to_world.determinant();
        if !(to_world.is_finite() && determinant != 0.0 && determinant.is_finite()) {
            return Err(CameraError::SingularTransform);
        }
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
        let Projection { origin, corner, .. } = camera.project(square);
        if !(origin.is_finite() && corner.length_squared().is_normal()) {
            return Err(CameraError::OutOfRange);
        }
        Ok(camera)
    }

    /// The camera in front of a film of this size, ready to make rays.
    pub fn project(&self, film: ImageSize) -> Projection {
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
        Projection {
            origin: self.to_world.transform_point3(DVec3::ZERO).as_vec3(),
            corner: axis(DVec3::new(corner_x, corner_y, 1.0)),
            per_column,
            per_row,
            near: self.near as f32,
            far: self.far as f32,
        }
    }
}

/// A camera in front of a film: an affine map from raster positions to points of the plane at depth 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projection {
    origin: Vec3,
    corner: Vec3,
    per_column: Vec3,
    per_row: Vec3,
    near: f32,
    far: f32,
}

impl Projection {
    /// The distance at which a ray of the camera with this unit direction meets the far clipping plane.
    pub fn far_along(&self, direction: Vec3) -> f32 {
        let normal = self.per_column.cross(self.per_row);
        self.far * self.corner.dot(normal) / direction.dot(normal)
    }

    /// The ray through `raster`, in pixels from the upper left corner of the whole film (not of its crop window).
    #[inline]
    pub fn ray(&self, raster: Vec2) -> CameraRay {
        let at_unit_depth = self.corner + self.per_column * raster.x + self.per_row * raster.y;
        let length = at_unit_depth.length();
        CameraRay {
            origin: self.origin,
            direction: at_unit_depth / length,
            near: self.near * length,
            far: self.far * length,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
            let ray = camera(axis).project(film).ray(Vec2::new(x, y));
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
            .project(ImageSize {
                width: 10,
                height: 10,
            })
            .ray(Vec2::ZERO);
        assert!((ray.near * ray.direction.z - 1.0).abs() < 1e-6);
        assert!((ray.far * ray.direction.z - 100.0).abs() < 1e-4);
        assert!(
            (camera(FovAxis::X)
                .project(ImageSize {
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
