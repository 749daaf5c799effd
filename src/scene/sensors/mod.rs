//! Sensors: cameras, and the film that they expose.

mod camera;
mod field_of_view;
mod film;
mod orthographic;
mod perspective;
mod thin_lens;

pub(crate) use camera::CameraRayLanes;
pub use camera::{Camera, CameraError, CameraRay, CameraView};
pub use field_of_view::{FieldOfView, FovAxis};
pub use film::{
    CropWindow, FilmDescription, FilmError, ImageSize, PixelFormat, ReconstructionFilter,
};
pub use orthographic::{Orthographic, OrthographicView};
pub use perspective::{Perspective, PinholeView};
pub use thin_lens::{ThinLens, ThinLensView};

use super::IndependentSampler;
use super::error::SceneError;
use super::xml::{Class, Object};

/// A sensor of a scene file with what stands in it.
pub(super) struct Sensor {
    pub camera: Camera,
    pub film: FilmDescription,
    pub sampler: IndependentSampler,
}

/// The sensor of a scene file.
pub(super) fn load(object: &Object) -> Result<Sensor, SceneError> {
    let camera = Camera::load(object)?;
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

#[cfg(test)]
mod tests;
