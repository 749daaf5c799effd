//! The effects that materials call for.

use super::surface::Surface;
use crate::scene::effects::Effect;

impl Surface {
    /// What this surface and those that it contains call for, each once.
    pub(super) fn effects(&self) -> Vec<Effect> {
        let mut effects = Vec::new();
        self.collect_effects(&mut |effect, is_called_for| {
            if is_called_for && !effects.contains(&effect) {
                effects.push(effect);
            }
        });
        effects
    }

    /// Tells `call` of effects and whether they are called for.
    fn collect_effects(&self, call: &mut dyn FnMut(Effect, bool)) {
        match self {
            Self::Diffuse(material) => call(Effect::Textures, material.reflectance.varies()),
            Self::Conductor(material) => {
                call(Effect::Mirrors, true);
                call(Effect::Textures, material.specular_reflectance.varies());
            }
            Self::RoughConductor(material) => {
                call(Effect::Gloss, true);
                call(Effect::Anisotropy, material.roughness.is_anisotropic());
                let varies = material.metal.specular_reflectance.varies();
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
            Self::TwoSided(sides) => {
                sides.front.collect_effects(call);
                sides.back.collect_effects(call);
            }
            Self::Mask(mask) => {
                call(Effect::Opacity, true);
                call(Effect::Textures, mask.opacity.varies());
                mask.surface.collect_effects(call);
            }
            Self::Blend(blend) => {
                call(Effect::Blends, true);
                call(Effect::Textures, blend.weight.varies());
                for surface in &blend.surfaces {
                    surface.collect_effects(call);
                }
            }
            Self::BumpMap(map) => {
                call(Effect::BumpMaps, true);
                map.nested.surface.collect_effects(call);
            }
            Self::NormalMap(map) => {
                call(Effect::BumpMaps, true);
                map.nested.surface.collect_effects(call);
            }
        }
    }
}
