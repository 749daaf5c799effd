//! Scenes without one of their effects, so that what the effect costs can be measured.

use super::effects::Effect;
use super::emitters::{ConstantLight, Emitter};
use super::{Camera, Perspective};
use super::{EmitterId, Scene};

impl Effect {
    /// What stands in for it in the plain counterpart of a scene, which [`Scene::without`] makes.
    pub fn plain_counterpart(self) -> &'static str {
        match self {
            Self::Mirrors | Self::Glass | Self::Gloss | Self::Coatings => {
                "diffuse surfaces of reflectance 0.5"
            }
            Self::Anisotropy => "the mean roughness both ways",
            Self::Dispersion => "the index at 589.3 nm",
            Self::Opacity => "opaque surfaces, diffuse ones for `null`",
            Self::Blends => "the first of both bsdfs",
            Self::Textures => "greys and numbers, the textures' means",
            Self::BumpMaps => "the bsdfs in them",
            Self::Surroundings => "no light from all around",
            Self::EnvironmentMap => "a constant light from all around",
            Self::PointLights => "no such lights",
            Self::Projections => "the same lights without images",
            Self::ManyLights => "the first of the lights alone",
            Self::Instancing => "only the shapes that stand in no group",
            Self::DepthOfField => "a pinhole",
            Self::Orthographic => "a perspective camera at the same place",
        }
    }
}

impl Scene {
    /// The scene with the [plain counterpart](Effect::plain_counterpart) of `effect` in its place; the same scene where the effect
    /// is off. Everything else stays, also objects that have nothing left to do.
    pub fn without(mut self, effect: Effect) -> Self {
        let materials = std::mem::take(&mut self.materials).into_iter();
        self.materials = materials.map(|material| material.without(effect)).collect();
        match effect {
            Effect::Textures | Effect::Projections => self.even_lights(effect),
            Effect::Surroundings => self.keep_emitters(|_, emitter| !emitter.surrounds()),
            Effect::PointLights => self.keep_emitters(|_, emitter| !emitter.is_delta()),
            Effect::Instancing => self.instances.clear(),
            Effect::ManyLights => self.keep_emitters(|index, _| index == 0),
            Effect::EnvironmentMap => {
                for emitter in &mut self.emitters {
                    if let Emitter::Environment(_) = emitter {
                        *emitter = Emitter::Constant(ConstantLight::default());
                    }
                }
            }
            _ => {}
        }
        self.camera = match (effect, self.camera) {
            (Effect::DepthOfField, Camera::ThinLens(camera)) => {
                Camera::Perspective(camera.pinhole())
            }
            (Effect::Orthographic, Camera::Orthographic(camera)) => {
                // A camera whose numbers a perspective one cannot have stays what it is.
                Perspective::usual(camera.to_world()).map_or(self.camera, Camera::Perspective)
            }
            (_, camera) => camera,
        };
        self
    }

    /// Takes the images, or the textures, out of lights.
    fn even_lights(&mut self, effect: Effect) {
        let shapes = &self.shapes;
        for emitter in &mut self.emitters {
            match (effect, emitter) {
                (Effect::Textures, Emitter::Area(light)) => {
                    light.make_uniform(&shapes[light.shape.index()].geometry);
                }
                (Effect::Projections, Emitter::Spot(light)) => light.make_even(),
                (Effect::Projections, Emitter::Projector(light)) => light.make_even(),
                _ => {}
            }
        }
    }

    /// Takes out the emitters that `keep` does not want to keep, by index.
    fn keep_emitters(&mut self, keep: impl Fn(usize, &Emitter) -> bool) {
        let emitters = std::mem::take(&mut self.emitters);
        let sources = std::mem::take(&mut self.sources.emitters);
        let mut places = Vec::new();
        for (index, (emitter, source)) in emitters.into_iter().zip(sources).enumerate() {
            let is_kept = keep(index, &emitter);
            places.push(is_kept.then_some(EmitterId(self.emitters.len() as u32)));
            if is_kept {
                self.emitters.push(emitter);
                self.sources.emitters.push(source);
            }
        }
        for shape in &mut self.shapes {
            shape.emitter = shape.emitter.and_then(|emitter| places[emitter.index()]);
        }
    }
}
