//! What can happen in a scene: which effects its objects call for, and which variant of the engine that takes.
//!
//! What cannot be seen is no effect. That is settled where plugins load: a lens of radius 0 is a pinhole, a mask of opacity 1 is
//! what it masks, an interface without a change of index is nothing, a surface of roughness 0 is the smooth one, an image of
//! one colour is that colour, and a flat spectrum is a number. So whatever is left in a [`Scene`] counts.

use std::collections::HashSet;
use std::fmt;
use std::hash::Hash;

use super::bsdfs::Material;
use super::source::Source;
use super::{Camera, Emitter, Scene};

/// Something that light does in some scenes only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Effect {
    /// Smooth metals.
    Mirrors,
    /// Interfaces and panes that refract.
    Glass,
    /// Lobes about the direction of a mirror.
    Gloss,
    /// Lobes that are wider one way than the other.
    Anisotropy,
    /// A base under a coat.
    Coatings,
    /// Wavelengths that are refracted apart.
    Dispersion,
    /// Surfaces that light passes straight.
    Opacity,
    /// Mixtures of materials.
    Blends,
    /// Parameters that vary over a surface.
    Textures,
    /// Bump and normal maps.
    BumpMaps,
    /// Light from all around.
    Surroundings,
    /// Light from all around that is not the same everywhere.
    EnvironmentMap,
    /// Lights without a surface.
    PointLights,
    /// Images thrown by a light.
    Projections,
    /// More than one light to choose from.
    ManyLights,
    /// Shapes that are seen in many places.
    Instancing,
    /// A lens.
    DepthOfField,
    /// A camera without perspective.
    Orthographic,
}

impl Effect {
    /// All effects, in the order in which they are told.
    pub const ALL: [Self; 18] = [
        Self::Mirrors,
        Self::Glass,
        Self::Gloss,
        Self::Anisotropy,
        Self::Coatings,
        Self::Dispersion,
        Self::Opacity,
        Self::Blends,
        Self::Textures,
        Self::BumpMaps,
        Self::Surroundings,
        Self::EnvironmentMap,
        Self::PointLights,
        Self::Projections,
        Self::ManyLights,
        Self::Instancing,
        Self::DepthOfField,
        Self::Orthographic,
    ];

    /// What it is called.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mirrors => "mirrors",
            Self::Glass => "glass",
            Self::Gloss => "gloss",
            Self::Anisotropy => "anisotropy",
            Self::Coatings => "coatings",
            Self::Dispersion => "dispersion",
            Self::Opacity => "opacity",
            Self::Blends => "blends",
            Self::Textures => "textures",
            Self::BumpMaps => "bump and normal maps",
            Self::Surroundings => "surroundings",
            Self::EnvironmentMap => "environment map",
            Self::PointLights => "point lights",
            Self::Projections => "projections",
            Self::ManyLights => "many lights",
            Self::Instancing => "instancing",
            Self::DepthOfField => "depth of field",
            Self::Orthographic => "orthographic camera",
        }
    }
}

impl fmt::Display for Effect {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(self.name())
    }
}

/// What can happen in a scene, and which objects call for it.
#[derive(Clone, Debug)]
pub struct Effects {
    /// Each effect with an object that calls for it.
    calls: Vec<(Effect, Source)>,
    not_matte: Vec<Source>,
}

impl Effects {
    /// Those of `scene`.
    pub fn of(scene: &Scene) -> Self {
        let mut calls: Vec<_> = scene.materials.iter().flat_map(Material::calls).collect();
        for (emitter, source) in scene.emitters.iter().zip(&scene.sources.emitters) {
            let many = (scene.emitters.len() > 1).then_some(Effect::ManyLights);
            let effects = of_emitter(emitter).iter().copied().chain(many);
            calls.extend(effects.map(|effect| (effect, source.clone())));
        }
        let groups = scene.sources.groups.iter();
        calls.extend(groups.map(|source| (Effect::Instancing, source.clone())));
        let of_camera = match scene.camera {
            Camera::Perspective(_) => None,
            Camera::ThinLens(_) => Some(Effect::DepthOfField),
            Camera::Orthographic(_) => Some(Effect::Orthographic),
        };
        calls.extend(of_camera.map(|effect| (effect, scene.sources.sensor.clone())));
        let not_matte = scene
            .materials
            .iter()
            .filter(|material| !material.is_matte());
        let emitters = scene.emitters.iter().zip(&scene.sources.emitters);
        let textured = emitters.filter(|(emitter, _)| emitter.is_textured_area());
        let not_matte = not_matte
            .filter_map(|material| material.source().cloned())
            .chain(textured.map(|(_, source)| source.clone()))
            .chain(scene.sources.groups.iter().cloned());
        Self {
            calls: each_once(calls),
            not_matte: each_once(not_matte.collect()),
        }
    }

    /// Whether something calls for `effect`.
    pub fn is_on(&self, effect: Effect) -> bool {
        self.callers(effect).next().is_some()
    }

    /// The objects that call for `effect`, in the order in which they were loaded.
    pub fn callers(&self, effect: Effect) -> impl Iterator<Item = &Source> {
        let calls = self
            .calls
            .iter()
            .filter(move |(called, _)| *called == effect);
        calls.map(|(_, source)| source)
    }

    /// The bsdfs, lights and groups for which the engine needs its general variant; none where the one for [matte](Scene::is_matte)
    /// scenes will do.
    pub fn not_matte(&self) -> &[Source] {
        &self.not_matte
    }
}

impl Scene {
    /// Whether all surfaces reflect diffusely and glow, each the same at every point, and none stands in an instance: then the
    /// engine runs the variant that holds nothing else.
    pub fn is_matte(&self) -> bool {
        self.instances.is_empty()
            && self.materials.iter().all(Material::is_matte)
            && !self.emitters.iter().any(Emitter::is_textured_area)
    }
}

/// A bsdf can be both sides of a surface, stand in several others, and be several materials, by what the meshes of its shapes say.
fn each_once<T: Clone + Eq + Hash>(mut all: Vec<T>) -> Vec<T> {
    let mut seen = HashSet::new();
    all.retain(|one| seen.insert(one.clone()));
    all
}

fn of_emitter(emitter: &Emitter) -> &'static [Effect] {
    match emitter {
        Emitter::Area(light) if light.radiance.varies() => &[Effect::Textures],
        Emitter::Area(_) => &[],
        Emitter::Spot(light) if light.is_textured() => &[Effect::PointLights, Effect::Projections],
        Emitter::Projector(light) if light.is_textured() => {
            &[Effect::PointLights, Effect::Projections]
        }
        Emitter::Point(_) | Emitter::Spot(_) | Emitter::Projector(_) | Emitter::Directional(_) => {
            &[Effect::PointLights]
        }
        Emitter::Constant(_) => &[Effect::Surroundings],
        Emitter::Environment(_) => &[Effect::Surroundings, Effect::EnvironmentMap],
    }
}

#[cfg(test)]
mod tests;
