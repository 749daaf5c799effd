//! The effects that materials call for.

use super::stated::Stated;
use super::surface::Surface;
use crate::scene::effects::Effect;
use crate::scene::source::Source;

impl Surface {
    /// What this surface and those that it contains call for.
    pub(super) fn effects(&self) -> Vec<Effect> {
        let nested = self.nested().into_iter();
        let of_nested = nested.flat_map(|nested| nested.effects());
        self.own_effects().into_iter().chain(of_nested).collect()
    }

    /// The same, each with the object that calls for it; this surface is stated by `source`.
    pub(super) fn calls(&self, source: &Source) -> Vec<(Effect, Source)> {
        let own = self.own_effects().into_iter();
        let nested = self.nested().into_iter();
        own.map(|effect| (effect, source.clone()))
            .chain(nested.flat_map(|nested| nested.calls(&nested.source)))
            .collect()
    }

    /// The surfaces that it contains.
    fn nested(&self) -> Vec<&Stated> {
        match self {
            Self::TwoSided(sides) => vec![&sides.front, &sides.back],
            Self::Mask(mask) => vec![&mask.surface],
            Self::Blend(blend) => blend.surfaces.iter().collect(),
            Self::BumpMap(map) => vec![&map.nested.surface],
            Self::NormalMap(map) => vec![&map.nested.surface],
            _ => Vec::new(),
        }
    }

    /// What the surface itself calls for.
    fn own_effects(&self) -> Vec<Effect> {
        let mut effects = Vec::new();
        let mut call = |effect, is_called_for| {
            if is_called_for {
                effects.push(effect);
            }
        };
        match self {
            Self::Diffuse(material) => call(Effect::Textures, material.reflectance.varies()),
            Self::Conductor(material) => {
                call(Effect::Mirrors, true);
                call(Effect::Textures, material.varies());
            }
            Self::RoughConductor(material) => {
                call(Effect::Gloss, true);
                call(Effect::Anisotropy, material.roughness.is_anisotropic());
                let varies = material.metal.varies();
                call(Effect::Textures, varies || material.roughness.varies());
            }
            Self::Dielectric(material) => {
                call(Effect::Glass, true);
                call(Effect::Dispersion, material.indices.disperse());
                call(Effect::Textures, material.needs_parameters());
            }
            // A pane lets wavelengths go on together.
            Self::ThinDielectric(material) => {
                call(Effect::Glass, true);
                call(Effect::Textures, material.needs_parameters());
            }
            Self::RoughDielectric(material) => {
                call(Effect::Glass, true);
                call(Effect::Gloss, true);
                call(Effect::Anisotropy, material.roughness.is_anisotropic());
                call(Effect::Dispersion, material.interface.indices.disperse());
                let varies = material.interface.needs_parameters();
                call(Effect::Textures, varies || material.roughness.varies());
            }
            Self::Plastic(material) => {
                call(Effect::Coatings, true);
                call(Effect::Textures, material.base.needs_parameters());
            }
            Self::RoughPlastic(material) => {
                call(Effect::Coatings, true);
                call(Effect::Gloss, true);
                call(Effect::Textures, material.base.needs_parameters());
            }
            Self::Principled(material) => {
                call(Effect::Gloss, true);
                call(
                    Effect::Anisotropy,
                    material.common.anisotropic.can_be_positive(),
                );
                call(Effect::Coatings, material.clearcoat.can_be_positive());
                call(Effect::Glass, material.is_transmissive());
                call(Effect::Textures, material.varies());
            }
            Self::PrincipledThin(material) => {
                let glass = material.common.spec_trans.can_be_positive();
                call(Effect::Gloss, glass);
                call(
                    Effect::Anisotropy,
                    glass && material.common.anisotropic.can_be_positive(),
                );
                call(Effect::Glass, glass);
                call(Effect::Textures, material.varies());
            }
            Self::Null => call(Effect::Opacity, true),
            Self::TwoSided(_) => {}
            Self::Mask(mask) => {
                call(Effect::Opacity, true);
                call(Effect::Textures, mask.opacity.varies());
            }
            Self::Blend(blend) => {
                call(Effect::Blends, true);
                call(Effect::Textures, blend.weight.varies());
            }
            Self::BumpMap(_) | Self::NormalMap(_) => call(Effect::BumpMaps, true),
        }
        effects
    }
}
