//! The tree of bsdfs: which plugins there are, what they have to do with each other, and the walk down to one model.

use super::blend::Blend;
use super::bump_map::BumpMap;
use super::mask::Mask;
use super::material::SeenPoint;
use super::normal_map::NormalMap;
use super::null::Null;
use super::stated::Stated;
use super::{
    Bsdf, ConductorMaterial, DielectricMaterial, DiffuseMaterial, Model, PlasticMaterial,
    PrincipledMaterial, PrincipledThinMaterial, RoughConductorMaterial, RoughDielectricMaterial,
    RoughPlasticMaterial, Side, ThinDielectric, twosided,
};
use crate::scene::error::SceneError;
use crate::scene::textures::TextureLoader;
use crate::scene::xml::Object;
use crate::spectrum::Colour;

/// A bsdf of the scene file with those that it contains.
#[derive(Clone, Debug)]
pub(super) enum Surface {
    /// `diffuse`
    Diffuse(DiffuseMaterial),
    /// `conductor`
    Conductor(ConductorMaterial),
    /// `roughconductor`
    RoughConductor(RoughConductorMaterial),
    /// `dielectric`
    Dielectric(DielectricMaterial),
    /// `roughdielectric`
    RoughDielectric(RoughDielectricMaterial),
    /// `thindielectric`
    ThinDielectric(DielectricMaterial),
    /// `plastic`
    Plastic(PlasticMaterial),
    /// `roughplastic`
    RoughPlastic(RoughPlasticMaterial),
    /// `principled`
    Principled(Box<PrincipledMaterial>),
    /// `principledthin`
    PrincipledThin(Box<PrincipledThinMaterial>),
    /// `null`
    Null,
    /// `twosided`
    TwoSided(Box<twosided::TwoSided>),
    /// `mask`
    Mask(Box<Mask>),
    /// `blendbsdf`
    Blend(Box<Blend>),
    /// `bumpmap`
    BumpMap(Box<BumpMap>),
    /// `normalmap`
    NormalMap(Box<NormalMap>),
}

const SUPPORTED: [&str; 16] = [
    "diffuse",
    "conductor",
    "roughconductor",
    "dielectric",
    "roughdielectric",
    "thindielectric",
    "plastic",
    "roughplastic",
    "principled",
    "principledthin",
    "blendbsdf",
    "mask",
    "bumpmap",
    "normalmap",
    "null",
    "twosided",
];

impl Surface {
    /// The bsdf `object`. Where one that contains others cannot be seen, it is one of those.
    pub(super) fn load(
        object: &Object,
        textures: &mut TextureLoader,
    ) -> Result<Stated, SceneError> {
        match object.plugin.as_str() {
            "mask" => Mask::load(object, textures),
            "blendbsdf" => Blend::load(object, textures),
            "bumpmap" => BumpMap::load(object, textures),
            "normalmap" => NormalMap::load(object, textures),
            _ => Self::load_itself(object, textures).map(|surface| Stated::by(object, surface)),
        }
    }

    /// The same for bsdfs in whose place no other one comes.
    fn load_itself(object: &Object, textures: &mut TextureLoader) -> Result<Self, SceneError> {
        match object.plugin.as_str() {
            "diffuse" => DiffuseMaterial::load(object, textures).map(Self::Diffuse),
            "conductor" => ConductorMaterial::load(object, textures).map(Self::Conductor),
            "roughconductor" => RoughConductorMaterial::load(object, textures),
            "dielectric" => Self::interface(object, textures, Self::Dielectric),
            "roughdielectric" => RoughDielectricMaterial::load(object, textures),
            "thindielectric" => Self::interface(object, textures, Self::ThinDielectric),
            "plastic" => PlasticMaterial::load(object, textures),
            "roughplastic" => RoughPlasticMaterial::load(object, textures),
            "principled" => {
                let material = PrincipledMaterial::load(object, textures)?;
                Ok(Self::Principled(Box::new(material)))
            }
            "principledthin" => {
                let material = PrincipledThinMaterial::load(object, textures)?;
                Ok(Self::PrincipledThin(Box::new(material)))
            }
            "null" => object.finish().map(|()| Self::Null),
            "twosided" => {
                let sides = twosided::TwoSided::load(object, textures)?;
                Ok(Self::TwoSided(Box::new(sides)))
            }
            _ => Err(object.unsupported(&SUPPORTED)),
        }
    }

    /// A smooth interface, or nothing where that cannot be seen.
    fn interface(
        object: &Object,
        textures: &mut TextureLoader,
        surface: impl Fn(DielectricMaterial) -> Self,
    ) -> Result<Self, SceneError> {
        let material = DielectricMaterial::load(object, textures)?;
        Ok(if material.is_invisible() {
            Self::Null
        } else {
            surface(material)
        })
    }

    /// Whether light gets through the surface.
    pub(super) fn is_transmissive(&self) -> bool {
        match self {
            Self::Diffuse(_)
            | Self::Conductor(_)
            | Self::RoughConductor(_)
            | Self::Plastic(_)
            | Self::RoughPlastic(_)
            | Self::TwoSided(_) => false,
            Self::Dielectric(_)
            | Self::RoughDielectric(_)
            | Self::ThinDielectric(_)
            | Self::PrincipledThin(_)
            | Self::Mask(_)
            | Self::Null => true,
            Self::Principled(material) => material.is_transmissive(),
            Self::Blend(blend) => blend.surfaces.iter().any(|nested| nested.is_transmissive()),
            Self::BumpMap(map) => map.nested.surface.is_transmissive(),
            Self::NormalMap(map) => map.nested.surface.is_transmissive(),
        }
    }

    /// Whether all that it does is to reflect diffusely, the same at every point.
    pub(super) fn is_matte(&self) -> bool {
        match self {
            Self::Diffuse(material) => !material.reflectance.varies(),
            Self::TwoSided(sides) => [&sides.front, &sides.back]
                .into_iter()
                .all(|side| matches!(side.surface, Self::Diffuse(_)) && side.is_matte()),
            _ => false,
        }
    }

    /// Whether a bump or a normal map tilts its normals somewhere.
    pub(super) fn is_tilted(&self) -> bool {
        match self {
            Self::BumpMap(_) | Self::NormalMap(_) => true,
            Self::TwoSided(sides) => sides.front.is_tilted() || sides.back.is_tilted(),
            Self::Mask(mask) => mask.surface.is_tilted(),
            Self::Blend(blend) => blend.surfaces.iter().any(|nested| nested.is_tilted()),
            _ => false,
        }
    }

    pub(super) fn needs_parameters(&self) -> bool {
        match self {
            Self::Diffuse(material) => material.reflectance.varies(),
            Self::Conductor(material) => material.varies(),
            Self::RoughConductor(material) => {
                material.metal.varies() || material.roughness.needs_parameters()
            }
            Self::Dielectric(material) | Self::ThinDielectric(material) => {
                material.needs_parameters()
            }
            Self::RoughDielectric(material) => material.needs_parameters(),
            Self::Plastic(material) => material.base.needs_parameters(),
            Self::RoughPlastic(material) => material.base.needs_parameters(),
            Self::Principled(material) => material.needs_parameters(),
            Self::PrincipledThin(material) => material.needs_parameters(),
            Self::Null => false,
            Self::TwoSided(sides) => {
                sides.front.needs_parameters() || sides.back.needs_parameters()
            }
            Self::Mask(mask) => mask.opacity.varies() || mask.surface.needs_parameters(),
            Self::Blend(blend) => {
                blend.weight.varies()
                    || blend
                        .surfaces
                        .iter()
                        .any(|nested| nested.needs_parameters())
            }
            Self::BumpMap(_) | Self::NormalMap(_) => true,
        }
    }

    pub(super) fn is_mixed(&self) -> bool {
        match self {
            Self::TwoSided(sides) => sides.front.is_mixed() || sides.back.is_mixed(),
            Self::Mask(_) | Self::Blend(_) => true,
            Self::BumpMap(map) => map.nested.surface.is_mixed(),
            Self::NormalMap(map) => map.nested.surface.is_mixed(),
            _ => false,
        }
    }

    pub(super) fn disperses(&self) -> bool {
        match self {
            Self::Dielectric(material) => material.indices.disperse(),
            Self::RoughDielectric(material) => material.interface.indices.disperse(),
            Self::Mask(mask) => mask.surface.disperses(),
            Self::Blend(blend) => blend.surfaces.iter().any(|nested| nested.disperses()),
            Self::BumpMap(map) => map.nested.surface.disperses(),
            Self::NormalMap(map) => map.nested.surface.disperses(),
            _ => false,
        }
    }

    /// See [`Material::bsdf`].
    pub(super) fn at<C: Colour>(
        &self,
        point: &SeenPoint,
        wavelengths: &C::Wavelengths,
    ) -> Option<Bsdf<C::Spectrum>> {
        let (side, parameters) = (point.side, &point.parameters);
        let is_front = side == Side::Front;
        let model = match self {
            Self::Diffuse(material) if is_front => {
                Model::Diffuse(material.at::<C>(parameters, wavelengths))
            }
            Self::Conductor(material) if is_front => {
                Model::Conductor(material.at::<C>(parameters, wavelengths))
            }
            Self::RoughConductor(material) if is_front => {
                Model::RoughConductor(material.at::<C>(parameters, wavelengths))
            }
            Self::Plastic(material) if is_front => {
                Model::Plastic(material.at::<C>(parameters, wavelengths))
            }
            Self::RoughPlastic(material) if is_front => {
                Model::RoughPlastic(material.at::<C>(parameters, wavelengths))
            }
            Self::Diffuse(_)
            | Self::Conductor(_)
            | Self::RoughConductor(_)
            | Self::Plastic(_)
            | Self::RoughPlastic(_) => return None,
            Self::Dielectric(material) => {
                Model::Dielectric(material.at::<C>(side, parameters, wavelengths))
            }
            Self::RoughDielectric(material) => {
                Model::RoughDielectric(material.at::<C>(side, parameters, wavelengths))
            }
            // Both faces look like the front of an interface.
            Self::ThinDielectric(material) => Model::ThinDielectric(ThinDielectric {
                face: material.at::<C>(Side::Front, parameters, wavelengths),
            }),
            Self::Principled(material) if is_front || material.is_transmissive() => {
                Model::Principled(material.at::<C>(side, parameters, wavelengths))
            }
            Self::Principled(_) => return None,
            Self::PrincipledThin(material) => {
                Model::PrincipledThin(material.at::<C>(parameters, wavelengths))
            }
            Self::Null => Model::Null(Null),
            Self::TwoSided(sides) => {
                let surface = if is_front { &sides.front } else { &sides.back };
                let as_front = SeenPoint {
                    side: Side::Front,
                    ..*point
                };
                return surface.at::<C>(&as_front, wavelengths);
            }
            Self::Mask(mask) => return mask.at::<C>(point, wavelengths),
            Self::Blend(blend) => return blend.at::<C>(point, wavelengths),
            Self::BumpMap(map) => return map.at::<C>(point, wavelengths),
            Self::NormalMap(map) => return map.at::<C>(point, wavelengths),
        };
        Some(Bsdf::Plain(model))
    }
}
