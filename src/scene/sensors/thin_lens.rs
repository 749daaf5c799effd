//! `thinlens`: a perspective camera whose lens is in focus at one distance.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `aperture_radius` | float | radius of the lens in scene units, at least 0; 0 is a pinhole | required |
//! | `focus_distance` | float | distance of the plane in focus from the lens, in scene units, positive | `far_clip` |
//! | `fov` | float | field of view in degrees along `fov_axis`, in (0, 180) | see `focal_length` |
//! | `focal_length` | string | the same as a 35 mm equivalent such as `50mm`, along the diagonal | 50mm |
//! | `fov_axis` | string | `x`, `y`, `diagonal`, `smaller` or `larger` | x |
//! | `near_clip` | float | nearest depth that is seen, in scene units | 0.01 |
//! | `far_clip` | float | farthest depth that is seen, in scene units | 10000 |
//! | `to_world` | transform | camera to world, without scaling: the camera looks along +z, +y is up, +x is left | identity |
//!
//! It contains the `film` and the `sampler`.

use glam::{DMat3, DMat4, DVec3, Vec2, Vec3};

use super::camera::{Camera, CameraError, CameraRay, load_clipping_planes};
use super::perspective::{Perspective, PinholeView};
use super::{FieldOfView, ImageSize};
use crate::sampling::warp;
use crate::scene::error::SceneError;
use crate::scene::xml::Object;

/// A camera with a thin lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinLens {
    /// The camera that it would be if the lens were a point.
    perspective: Perspective,
    /// The lens' axes in world space, as long as its radius.
    axes: [Vec3; 2],
    focus_distance: f32,
}

/// The camera of a scene file. Through a lens without extent it is a pinhole camera.
pub(super) fn load(object: &Object) -> Result<Camera, SceneError> {
    let field_of_view = FieldOfView::load(object)?;
    let clip = load_clipping_planes(object)?;
    let radius = object
        .float("aperture_radius")?
        .ok_or_else(|| object.missing("aperture_radius"))?;
    let focus_distance = object.float_or("focus_distance", clip.1)?;
    let to_world = object.transform("to_world")?.unwrap_or(DMat4::IDENTITY);
    let perspective = Perspective::new(to_world, field_of_view, clip, Vec2::ZERO)
        .map_err(|error| object.error(error.to_string()))?;
    let camera = ThinLens::new(perspective, to_world, radius, focus_distance)
        .map_err(|error| object.error(error.to_string()))?;
    Ok(if radius == 0.0 {
        Camera::Perspective(perspective)
    } else {
        Camera::ThinLens(camera)
    })
}

impl ThinLens {
    /// The camera that it would be if the lens were a point.
    pub fn pinhole(&self) -> Perspective {
        self.perspective
    }

    /// The camera that is `perspective`, whose `to_world` does not scale, with a lens of this `radius`, in focus at the
    /// depth `focus_distance`, both in scene units.
    pub fn new(
        perspective: Perspective,
        to_world: DMat4,
        radius: f64,
        focus_distance: f64,
    ) -> Result<Self, CameraError> {
        let axes = DMat3::from_mat4(to_world);
        let deviation = axes.transpose() * axes - DMat3::IDENTITY;
        if deviation
            .to_cols_array()
            .iter()
            .any(|deviation| deviation.abs() > 1e-3)
        {
            return Err(CameraError::Scaling);
        }
        if radius < 0.0 {
            return Err(CameraError::ApertureRadius(radius));
        }
        if focus_distance <= 0.0 {
            return Err(CameraError::FocusDistance(focus_distance));
        }
        let camera = Self {
            perspective,
            axes: [DVec3::X, DVec3::Y].map(|axis| (axes * (axis * radius)).as_vec3()),
            focus_distance: focus_distance as f32,
        };
        let extent = camera.axes[0].length_squared() + camera.focus_distance.powi(2);
        if extent.is_normal() {
            Ok(camera)
        } else {
            Err(CameraError::OutOfRange)
        }
    }

    /// The camera in front of a film of this size, ready to make rays.
    pub fn view(&self, film: ImageSize) -> ThinLensView {
        ThinLensView {
            pinhole: self.perspective.view(film),
            axes: self.axes,
            focus_distance: self.focus_distance,
        }
    }
}

/// A camera with a thin lens in front of a film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThinLensView {
    /// The view through the middle of the lens.
    pub(super) pinhole: PinholeView,
    axes: [Vec3; 2],
    focus_distance: f32,
}

impl ThinLensView {
    /// The ray through `raster`, in pixels from the upper left corner of the whole film, and through the point of the lens
    /// that the uniform numbers `lens` in [0, 1) stand for.
    #[inline]
    pub fn ray(&self, raster: Vec2, lens: [f32; 2]) -> CameraRay {
        let point = warp::disk(lens);
        let on_lens = self.axes[0] * point.x + self.axes[1] * point.y;
        let in_focus = self.pinhole.at_unit_depth(raster) * self.focus_distance;
        let through = in_focus - on_lens;
        let length = through.length();
        // Per unit of depth.
        let slant = length / self.focus_distance;
        CameraRay {
            origin: self.pinhole.origin + on_lens,
            direction: through / length,
            near: self.pinhole.near * slant,
            far: self.pinhole.far * slant,
        }
    }
}
