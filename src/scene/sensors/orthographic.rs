//! `orthographic`: a camera whose rays are parallel.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `near_clip` | float | nearest depth that is seen, in units of `to_world`'s z axis | 0.01 |
//! | `far_clip` | float | farthest depth that is seen | 10000 |
//! | `focus_distance` | float | accepted, since every camera may state it; everything is in focus | |
//! | `to_world` | transform | camera to world: the film is \[-1, 1\] wide about the origin, +y is up, +x is left, and it looks along +z | identity |
//!
//! How much it sees is set by scaling in `to_world`. It contains the `film` and the `sampler`.

use glam::{DMat4, DVec3, Vec2, Vec3};

use super::ImageSize;
use super::camera::{CameraError, CameraRay, load_clipping_planes};
use crate::scene::error::SceneError;
use crate::scene::xml::Object;

/// A camera without perspective.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orthographic {
    to_world: DMat4,
    near: f64,
    far: f64,
}

impl Orthographic {
    pub(super) fn load(object: &Object) -> Result<Self, SceneError> {
        let clip = load_clipping_planes(object)?;
        object.float("focus_distance")?;
        let to_world = object.transform("to_world")?.unwrap_or(DMat4::IDENTITY);
        Self::new(to_world, clip).map_err(|error| object.error(error.to_string()))
    }

    /// From camera to world space.
    pub fn to_world(&self) -> DMat4 {
        self.to_world
    }

    /// The camera whose space `to_world` maps to world space (its film is \[-1, 1\] wide about the origin, it looks along
    /// +z, +y is up, +x is left), clipping at the depth `near` of its space and `far - near` scene units farther.
    pub fn new(to_world: DMat4, (near, far): (f64, f64)) -> Result<Self, CameraError> {
        CameraError::check(to_world, near, far)?;
        let camera = Self {
            to_world,
            near,
            far,
        };
        let square = ImageSize {
            width: 1,
            height: 1,
        };
        let view = camera.view(square);
        let is_in_range = view.corner.is_finite()
            && view.direction.is_normalized()
            && view.per_column.length_squared().is_normal()
            && view.per_row.length_squared().is_normal();
        if is_in_range {
            Ok(camera)
        } else {
            Err(CameraError::OutOfRange)
        }
    }

    /// The camera in front of a film of this size, ready to make rays.
    pub fn view(&self, film: ImageSize) -> OrthographicView {
        let (width, height) = (f64::from(film.width), f64::from(film.height));
        let half_height = height / width;
        let axis = |local: DVec3| self.to_world.transform_vector3(local).as_vec3();
        let forward = self.to_world.transform_vector3(DVec3::Z);
        let near = self.near * forward.length();
        let corner = DVec3::new(1.0, half_height, 0.0);
        OrthographicView {
            // Raster x grows to the right and camera x to the left; raster y grows downwards and camera y upwards.
            corner: self.to_world.transform_point3(corner).as_vec3(),
            per_column: axis(DVec3::new(-2.0 / width, 0.0, 0.0)),
            per_row: axis(DVec3::new(0.0, -2.0 / width, 0.0)),
            direction: forward.normalize_or_zero().as_vec3(),
            near: near as f32,
            far: (near + self.far - self.near) as f32,
        }
    }
}

/// A camera without perspective in front of a film: an affine map from raster positions to points of the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrthographicView {
    corner: Vec3,
    per_column: Vec3,
    per_row: Vec3,
    direction: Vec3,
    near: f32,
    far: f32,
}

impl OrthographicView {
    /// The distance of the far clipping plane along rays, in scene units.
    pub fn far(&self) -> f32 {
        self.far
    }

    /// The ray through `raster`, in pixels from the upper left corner of the whole film.
    #[inline]
    pub fn ray(&self, raster: Vec2) -> CameraRay {
        CameraRay {
            origin: self.corner + self.per_column * raster.x + self.per_row * raster.y,
            direction: self.direction,
            near: self.near,
            far: self.far,
        }
    }
}
