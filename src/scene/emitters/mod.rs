//! Emitters: where light comes from, and how next-event estimation draws a point of them.

mod area;
mod constant;
mod directional;
mod environment;
mod point;
mod projector;
mod spot;
#[cfg(test)]
mod tests;

pub use area::AreaLight;
pub use constant::ConstantLight;
pub use directional::DirectionalLight;
pub use environment::EnvironmentMap;
pub use point::PointLight;
pub use projector::Projector;
pub use spot::SpotLight;

use glam::Vec3;

use super::error::SceneError;
use super::load::Loader;
use super::shapes::{Parallelogram, SurfacePoint};
use super::xml::Object;
use super::{Shape, ShapeId};
use crate::sampling::SolidAnglePdf;
use crate::spectrum::{Colour, SpectrumArithmetic};

/// An emitter of a scene file that stands on its own.
pub(super) fn load(object: &Object, loader: &mut Loader) -> Result<Emitter, SceneError> {
    match object.plugin.as_str() {
        "point" => PointLight::load(object).map(Emitter::Point),
        "spot" => SpotLight::load(object, loader).map(Emitter::Spot),
        "projector" => Projector::load(object, loader).map(Emitter::Projector),
        "directional" => DirectionalLight::load(object).map(Emitter::Directional),
        "constant" => ConstantLight::load(object).map(Emitter::Constant),
        "envmap" => EnvironmentMap::load(object, loader),
        _ => Err(object.unsupported(&SUPPORTED)),
    }
}

/// The emitter of a scene file that stands in a shape.
pub(super) fn load_area(
    object: &Object,
    shape: ShapeId,
    loader: &mut Loader,
) -> Result<AreaLight, SceneError> {
    match object.plugin.as_str() {
        "area" => AreaLight::load(object, shape, loader),
        name if SUPPORTED.contains(&name) => {
            Err(object.error(format!("`{name}` cannot stand in a shape; only `area` can")))
        }
        _ => Err(object.unsupported(&SUPPORTED)),
    }
}

const SUPPORTED: [&str; 7] = [
    "area",
    "point",
    "spot",
    "projector",
    "directional",
    "constant",
    "envmap",
];

/// A source of light.
#[derive(Clone, Debug)]
pub enum Emitter {
    /// `area`: a shape that glows.
    Area(AreaLight),
    /// `point`: an isotropic point.
    Point(PointLight),
    /// `spot`: a point with a cone of light.
    Spot(SpotLight),
    /// `projector`: a point that casts an image.
    Projector(Projector),
    /// `directional`: infinitely far away, in one direction.
    Directional(DirectionalLight),
    /// `constant`: the same radiance from every direction.
    Constant(ConstantLight),
    /// `envmap`: an image all around.
    Environment(EnvironmentMap),
}

/// Light drawn as seen from a reference point.
#[derive(Clone, Copy, Debug)]
pub struct LightSample<S> {
    /// Unit direction from the reference point to the light, in world space.
    pub direction: Vec3,
    /// Distance to the light in scene units; infinite for surroundings and directional lights.
    pub distance: f32,
    /// The point of the light, where it has a surface.
    pub surface: Option<SurfacePoint>,
    /// Radiance over density; where there is no density, irradiance on a surface that faces the light.
    pub weight: S,
    /// The density of `direction`; `None` where only this way of sampling can find the light (points, single directions).
    pub pdf: Option<SolidAnglePdf>,
}

impl Emitter {
    /// Draws light that may arrive at `reference` (world space) from the uniform numbers `u` in [0, 1); `shapes` are
    /// the scene's. `None` where what was drawn sends no light there.
    #[inline(always)]
    pub fn sample<C: Colour>(
        &self,
        shapes: &[Shape],
        reference: Vec3,
        wavelengths: &C::Wavelengths,
        u: [f32; 2],
    ) -> Option<LightSample<C::Spectrum>> {
        match self {
            Self::Area(light) => light.sample::<C>(shapes, reference, wavelengths, u),
            Self::Point(light) => light.sample::<C>(reference, wavelengths),
            Self::Spot(light) => light.sample::<C>(reference, wavelengths),
            Self::Projector(light) => light.sample::<C>(reference, wavelengths),
            Self::Directional(light) => Some(light.sample::<C>(wavelengths)),
            Self::Constant(light) => Some(light.sample::<C>(wavelengths, u)),
            Self::Environment(light) => light.sample::<C>(wavelengths, u),
        }
    }

    /// The rectangle (or another parallelogram) that it is, if it is one of the same radiance everywhere.
    pub(crate) fn parallelogram(&self, shapes: &[Shape]) -> Option<Parallelogram> {
        match self {
            Self::Area(light) if !light.radiance.varies() => {
                shapes[light.shape.index()].geometry.parallelogram()
            }
            _ => None,
        }
    }

    /// Whether it is a shape whose radiance varies over its surface.
    pub fn is_textured_area(&self) -> bool {
        matches!(self, Self::Area(light) if light.radiance.varies())
    }

    /// Whether only next-event estimation can find this light.
    pub fn is_delta(&self) -> bool {
        matches!(
            self,
            Self::Point(_) | Self::Spot(_) | Self::Projector(_) | Self::Directional(_)
        )
    }

    /// Whether it is what rays see that leave the scene.
    pub fn surrounds(&self) -> bool {
        matches!(self, Self::Constant(_) | Self::Environment(_))
    }

    /// The radiance that arrives from `direction` (unit, world space, away from the scene) where the light
    /// [surrounds](Self::surrounds) the scene; nothing from other lights.
    #[inline]
    pub fn surrounding_radiance<C: Colour>(
        &self,
        direction: Vec3,
        wavelengths: &C::Wavelengths,
    ) -> C::Spectrum {
        match self {
            Self::Constant(light) => light.radiance::<C>(wavelengths),
            Self::Environment(light) => light.radiance::<C>(direction, wavelengths),
            _ => C::Spectrum::ZERO,
        }
    }

    /// The density with which [`Self::sample`] draws `direction` (unit, world space) where the light
    /// [surrounds](Self::surrounds) the scene; 0 for other lights.
    #[inline]
    pub fn surrounding_pdf(&self, direction: Vec3) -> SolidAnglePdf {
        match self {
            Self::Constant(light) => light.pdf(),
            Self::Environment(light) => light.pdf(direction),
            _ => SolidAnglePdf(0.0),
        }
    }
}
