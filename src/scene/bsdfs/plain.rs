//! Materials without an effect: see [`Effect::plain_counterpart`].

use super::material::Material;
use super::surface::Surface;
use super::{CoatedBase, DielectricMaterial, DiffuseMaterial, Indices, Roughness};
use crate::scene::effects::Effect;
use crate::scene::textures::{FloatTexture, SpectrumTexture};

impl Material {
    /// The material without `effect`.
    pub(in crate::scene) fn without(self, effect: Effect) -> Self {
        if !self.effects().contains(&effect) {
            return self;
        }
        self.changed(|tree| tree.without(effect))
    }
}

impl Surface {
    /// The surface without `effect`, and those in it.
    fn without(mut self, effect: Effect) -> Self {
        match &mut self {
            Self::TwoSided(sides) => {
                leave_out(&mut sides.front.surface, effect);
                leave_out(&mut sides.back.surface, effect);
                return self;
            }
            Self::Mask(mask) => leave_out(&mut mask.surface.surface, effect),
            Self::Blend(blend) => {
                for nested in &mut blend.surfaces {
                    leave_out(&mut nested.surface, effect);
                }
            }
            Self::BumpMap(map) => leave_out(&mut map.nested.surface.surface, effect),
            Self::NormalMap(map) => leave_out(&mut map.nested.surface.surface, effect),
            _ => {}
        }
        match (effect, self) {
            (Effect::Opacity, Self::Mask(mask)) => mask.surface.surface,
            (Effect::Blends, Self::Blend(blend)) => {
                let [first, _] = blend.surfaces;
                first.surface
            }
            (Effect::BumpMaps, Self::BumpMap(map)) => map.nested.surface.surface,
            (Effect::BumpMaps, Self::NormalMap(map)) => map.nested.surface.surface,
            (Effect::Textures, surface) => surface.even(),
            (Effect::Anisotropy, surface) => surface.isotropic(),
            (Effect::Dispersion, surface) => surface.undispersed(),
            (
                _,
                surface @ (Self::Mask(_) | Self::Blend(_) | Self::BumpMap(_) | Self::NormalMap(_)),
            ) => surface,
            (effect, surface) if surface.effects().contains(&effect) => {
                Self::Diffuse(DiffuseMaterial::default())
            }
            (_, surface) => surface,
        }
    }

    /// With the means of its textures.
    fn even(mut self) -> Self {
        match &mut self {
            Self::Diffuse(material) => material.reflectance.make_uniform(),
            Self::Conductor(material) => material.make_uniform(),
            Self::RoughConductor(material) => {
                material.metal.make_uniform();
                even_roughness(&mut material.roughness);
            }
            Self::Dielectric(material) | Self::ThinDielectric(material) => even_interface(material),
            Self::RoughDielectric(material) => {
                even_interface(&mut material.interface);
                even_roughness(&mut material.roughness);
            }
            Self::Plastic(material) => even_base(&mut material.base),
            Self::RoughPlastic(material) => even_base(&mut material.base),
            Self::Principled(material) => material.make_uniform(),
            Self::PrincipledThin(material) => material.make_uniform(),
            Self::Mask(mask) => mask.opacity.make_uniform(),
            Self::Blend(blend) => blend.weight.make_uniform(),
            Self::Null | Self::TwoSided(_) | Self::BumpMap(_) | Self::NormalMap(_) => {}
        }
        self
    }

    /// With lobes as wide one way as the other.
    fn isotropic(mut self) -> Self {
        match &mut self {
            Self::RoughConductor(material) => material.roughness.make_isotropic(),
            Self::RoughDielectric(material) => material.roughness.make_isotropic(),
            Self::Principled(material) => material.common.anisotropic = FloatTexture::Uniform(0.0),
            Self::PrincipledThin(material) => {
                material.common.anisotropic = FloatTexture::Uniform(0.0)
            }
            _ => {}
        }
        self
    }

    /// With one index of refraction for all wavelengths.
    fn undispersed(mut self) -> Self {
        match &mut self {
            Self::Dielectric(material) => material.indices = material.indices.undispersed(),
            Self::RoughDielectric(material) => {
                let indices: &mut Indices = &mut material.interface.indices;
                *indices = indices.undispersed();
            }
            _ => {}
        }
        self
    }
}

fn leave_out(surface: &mut Surface, effect: Effect) {
    *surface = std::mem::replace(surface, Surface::Null).without(effect);
}

fn even_interface(interface: &mut DielectricMaterial) {
    interface.specular_reflectance.make_uniform();
    interface.specular_transmittance.make_uniform();
}

fn even_base(base: &mut CoatedBase) {
    let colours: [&mut SpectrumTexture; 2] = [
        &mut base.diffuse_reflectance,
        &mut base.specular_reflectance,
    ];
    colours.into_iter().for_each(SpectrumTexture::make_uniform);
}

fn even_roughness(roughness: &mut Roughness) {
    roughness.alpha_u.make_uniform();
    roughness.alpha_v.make_uniform();
}
