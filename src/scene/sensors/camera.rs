//! What all cameras have in common.

use std::ops::Range;

use glam::{DMat4, Vec2, Vec3};
use thiserror::Error;

use super::ImageSize;
use super::orthographic::{Orthographic, OrthographicView};
use super::perspective::{Perspective, PinholeView};
use super::thin_lens::{ThinLens, ThinLensView};
use crate::embree::RaysMut;
use crate::lanes::{CHUNK, VectorLanes};
use crate::scene::error::SceneError;
use crate::scene::xml::Object;

/// A camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Camera {
    /// `perspective`: a pinhole.
    Perspective(Perspective),
    /// `thinlens`: a lens that is in focus at one distance.
    ThinLens(ThinLens),
    /// `orthographic`: parallel rays.
    Orthographic(Orthographic),
}

/// A camera in front of a film, ready to make rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CameraView {
    /// Through a pinhole.
    Pinhole(PinholeView),
    /// Through a lens.
    ThinLens(ThinLensView),
    /// Without perspective.
    Orthographic(OrthographicView),
}

/// A camera ray in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraRay {
    /// Where it starts.
    pub origin: Vec3,
    /// Unit direction.
    pub direction: Vec3,
    /// The distance in scene units at which the near clipping plane is met.
    pub near: f32,
    /// The distance in scene units at which the far clipping plane is met.
    pub far: f32,
}

/// A [`CameraRay`] in each lane.
pub(crate) struct CameraRayLanes {
    origin: VectorLanes<CHUNK>,
    direction: VectorLanes<CHUNK>,
    near: [f32; CHUNK],
    far: [f32; CHUNK],
}

impl CameraRayLanes {
    /// Without meaning so far.
    pub fn new() -> Self {
        Self {
            origin: VectorLanes::default(),
            direction: VectorLanes::default(),
            near: [0.0; CHUNK],
            far: [0.0; CHUNK],
        }
    }

    #[inline(always)]
    fn fill(&mut self, ray: impl Fn(usize) -> CameraRay) {
        for lane in 0..CHUNK {
            let ray = ray(lane);
            self.origin.put(lane, ray.origin);
            self.direction.put(lane, ray.direction);
            self.near[lane] = ray.near;
            self.far[lane] = ray.far;
        }
    }

    /// Copies the first rays to `place`, at most [`CHUNK`] long, among those of a stream.
    #[inline(always)]
    pub fn copy_to(&self, rays: RaysMut, place: Range<usize>) {
        let vectors = self.origin.0.iter().chain(&self.direction.0);
        let columns = rays.origin.into_iter().chain(rays.direction);
        let columns = columns.chain([rays.tnear, rays.tfar]);
        for (column, lanes) in columns.zip(vectors.chain([&self.near, &self.far])) {
            column[place.clone()].copy_from_slice(&lanes[..place.len()]);
        }
    }
}

impl Camera {
    pub(super) fn load(object: &Object) -> Result<Self, SceneError> {
        match object.plugin.as_str() {
            "perspective" => Perspective::load(object).map(Self::Perspective),
            "thinlens" => super::thin_lens::load(object),
            "orthographic" => Orthographic::load(object).map(Self::Orthographic),
            _ => Err(object.unsupported(&["perspective", "thinlens", "orthographic"])),
        }
    }

    /// The camera in front of a film of this size.
    pub fn view(&self, film: ImageSize) -> CameraView {
        match self {
            Self::Perspective(camera) => CameraView::Pinhole(camera.view(film)),
            Self::ThinLens(camera) => CameraView::ThinLens(camera.view(film)),
            Self::Orthographic(camera) => CameraView::Orthographic(camera.view(film)),
        }
    }
}

impl CameraView {
    /// Whether rays depend on where they pass the lens.
    pub fn has_lens(&self) -> bool {
        matches!(self, Self::ThinLens(_))
    }

    /// The ray through `raster`, in pixels from the upper left corner of the whole film (not of its crop window), that
    /// passes the lens, if there is one, at the point which the uniform numbers `lens` in [0, 1) stand for.
    #[inline(always)]
    pub fn ray(&self, raster: Vec2, lens: [f32; 2]) -> CameraRay {
        match self {
            Self::Pinhole(view) => view.ray(raster),
            Self::ThinLens(view) => view.ray(raster, lens),
            Self::Orthographic(view) => view.ray(raster),
        }
    }

    /// The same of every lane of `raster` and `lens`.
    #[inline(always)]
    pub(crate) fn rays(
        &self,
        raster: &[[f32; CHUNK]; 2],
        lens: &[[f32; CHUNK]; 2],
        rays: &mut CameraRayLanes,
    ) {
        let raster = |lane| Vec2::new(raster[0][lane], raster[1][lane]);
        match self {
            Self::Pinhole(view) => rays.fill(|lane| view.ray(raster(lane))),
            Self::ThinLens(view) => {
                rays.fill(|lane| view.ray(raster(lane), [lens[0][lane], lens[1][lane]]));
            }
            Self::Orthographic(view) => rays.fill(|lane| view.ray(raster(lane))),
        }
    }

    /// The distance at which a ray of the camera with this unit direction meets the far clipping plane.
    pub fn far_along(&self, direction: Vec3) -> f32 {
        match self {
            Self::Pinhole(view) => view.far_along(direction),
            Self::ThinLens(view) => view.pinhole.far_along(direction),
            Self::Orthographic(view) => view.far(),
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
    /// The transform of a lens scales.
    #[error("`to_world` of a camera with a lens must not scale")]
    Scaling,
    /// The lens is no disk.
    #[error("the aperture's radius is {0}; it must be at least 0")]
    ApertureRadius(f64),
    /// The focal plane is behind the camera.
    #[error("the focus distance is {0}; it must be positive")]
    FocusDistance(f64),
    /// `to_world` scales by zero or is not finite.
    #[error("`to_world` of the camera has no inverse")]
    SingularTransform,
    /// Rays of the camera would have coordinates that `f32` cannot hold.
    #[error(
        "the camera is too far away, or its `to_world` or field of view is too extreme, for 32-bit coordinates"
    )]
    OutOfRange,
}

impl CameraError {
    /// What is wrong with a camera's transform and its clipping planes.
    pub(super) fn check(to_world: DMat4, near: f64, far: f64) -> Result<(), Self> {
        if !(near > 0.0 && near < far) {
            return Err(Self::ClippingPlanes { near, far });
        }
        let determinant = to_world.determinant();
        if !(to_world.is_finite() && determinant != 0.0 && determinant.is_finite()) {
            return Err(Self::SingularTransform);
        }
        Ok(())
    }
}

/// Distance of the near and of the far clipping plane.
pub(super) fn load_clipping_planes(object: &Object) -> Result<(f64, f64), SceneError> {
    Ok((
        object.float_or("near_clip", 1e-2)?,
        object.float_or("far_clip", 1e4)?,
    ))
}
