//! Sensors: cameras, and the film that they expose.

mod film;
mod perspective;

pub use film::{
    CropWindow, FilmDescription, FilmError, ImageSize, PixelFormat, ReconstructionFilter,
};
pub use perspective::{CameraError, FieldOfView, FovAxis, Perspective, Projection};

use glam::Vec3;

use super::IndependentSampler;
use super::error::SceneError;
use super::xml::{Class, Object};

/// A sensor of a scene file with what stands in it.
pub(super) struct Sensor {
    pub camera: Perspective,
    pub film: FilmDescription,
    pub sampler: IndependentSampler,
}

/// The sensor of a scene file.
pub(super) fn load(object: &Object) -> Result<Sensor, SceneError> {
    if object.plugin != "perspective" {
        return Err(object.unsupported(&["perspective"]));
    }
    let camera = Perspective::load(object)?;
    let film = match object.child(Class::Film)? {
        Some(child) => FilmDescription::load(&child.object)?,
        None => FilmDescription::default(),
    };
    let sampler = match object.child(Class::Sampler)? {
        Some(child) => IndependentSampler::load(&child.object)?,
        None => IndependentSampler::default(),
    };
    object.finish()?;
    Ok(Sensor {
        camera,
        film,
        sampler,
    })
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
