//! Sensors: cameras, and the film that they expose.

mod film;
mod perspective;

pub use film::{CropWindow, FilmDescription, FilmError, ImageSize, PixelFormat, ReconstructionFilter};
pub use perspective::{CameraError, FieldOfView, FovAxis, Perspective, Projection};

use glam::Vec3;

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
