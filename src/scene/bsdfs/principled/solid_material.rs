//! `principled`: the surface of a solid. One-sided unless it lets light through.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `base_color` | spectrum or texture | colour | 0.5 |
//! | `roughness` | float or texture | roughness of the main specular lobes, whose alpha is its square | 0.5 |
//! | `anisotropic` | float or texture | how much they are stretched | 0 |
//! | `metallic` | float or texture | share of a metal | 0 |
//! | `spec_trans` | float or texture | share of glass in what is no metal | 0 |
//! | `specular` | float | sets the index of refraction to 2 / (1 - sqrt(0.08 specular)) - 1 | 0.5 |
//! | `eta` | float | instead of `specular`: index of refraction inside over outside | |
//! | `spec_tint` | float or texture | how much reflections of what is no metal are tinted by the colour | 0 |
//! | `sheen` | float or texture | strength of a shine towards grazing angles | 0 |
//! | `sheen_tint` | float or texture | how much that is tinted by the colour | 0 |
//! | `flatness` | float or texture | how much diffuse reflection looks like subsurface scattering | 0 |
//! | `clearcoat` | float or texture | strength of a clear coat | 0 |
//! | `clearcoat_gloss` | float or texture | gloss of the clear coat | 0 |
//! | `diffuse_reflectance_sampling_rate`, `main_specular_sampling_rate`, `clearcoat_sampling_rate` | float | how often lobes are sampled | 1 |
//!
//! All but `eta` and the rates are in [0, 1]. Tints are by the luminance of the colour, in three channels and by wavelength alike.

use super::solid::{Principled, SamplingRates};
use super::{CoatFacets, CommonParameters, facets, sampling_rate, share};
use crate::scene::bsdfs::Side;
use crate::scene::error::SceneError;
use crate::scene::shapes::SurfaceParameters;
use crate::scene::textures::{FloatTexture, TextureLoader};
use crate::scene::xml::Object;
use crate::spectrum::Colour;

/// A principled surface as the scene states it; every field is a parameter of the scene file.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct PrincipledMaterial {
    pub common: CommonParameters,
    pub metallic: FloatTexture,
    pub clearcoat: FloatTexture,
    pub clearcoat_gloss: FloatTexture,
    pub eta: f32,
    pub sampling: SamplingRates,
}

impl PrincipledMaterial {
    pub(in crate::scene::bsdfs) fn load(
        object: &Object,
        textures: &mut TextureLoader,
    ) -> Result<Self, SceneError> {
        let common = CommonParameters::load(object, textures)?;
        let mut number = |name, default| share(object, textures, name, default, 1.0);
        let material = Self {
            metallic: number("metallic", 0.0)?,
            clearcoat: number("clearcoat", 0.0)?,
            clearcoat_gloss: number("clearcoat_gloss", 0.0)?,
            eta: load_eta(object, common.is_transmissive())?,
            common,
            sampling: SamplingRates {
                diffuse: sampling_rate(object, "diffuse_reflectance_sampling_rate")?,
                specular: sampling_rate(object, "main_specular_sampling_rate")?,
                clearcoat: sampling_rate(object, "clearcoat_sampling_rate")?,
            },
        };
        object.finish()?;
        Ok(material)
    }

    pub(in crate::scene::bsdfs) fn is_transmissive(&self) -> bool {
        self.common.is_transmissive()
    }

    pub(in crate::scene::bsdfs) fn needs_parameters(&self) -> bool {
        self.common.anisotropic.can_be_positive() || self.varies()
    }

    /// Whether it differs from point to point.
    pub(in crate::scene::bsdfs) fn varies(&self) -> bool {
        let own = [&self.metallic, &self.clearcoat, &self.clearcoat_gloss];
        self.common.varies() || own.into_iter().any(FloatTexture::varies)
    }

    /// Makes it the same everywhere, with the means of its textures.
    pub(in crate::scene::bsdfs) fn make_uniform(&mut self) {
        self.common.make_uniform();
        self.metallic.make_uniform();
        self.clearcoat.make_uniform();
        self.clearcoat_gloss.make_uniform();
    }

    pub(in crate::scene::bsdfs) fn at<C: Colour>(
        &self,
        side: Side,
        point: &SurfaceParameters,
        wavelengths: &C::Wavelengths,
    ) -> Principled<C::Spectrum> {
        let (metallic, spec_trans) = (
            self.metallic.number(point),
            self.common.spec_trans.number(point),
        );
        let roughness = self.common.roughness.number(point);
        Principled {
            side,
            base_color: self.common.base_color.spectrum::<C>(point, wavelengths),
            luminance: self.common.base_color.number(point),
            facets: facets(roughness, self.common.anisotropic.number(point)),
            roughness,
            metallic,
            opaque: (1.0 - metallic) * (1.0 - spec_trans),
            glassy: (1.0 - metallic) * spec_trans,
            spec_tint: self.common.spec_tint.number(point),
            sheen: self.common.sheen.number(point),
            sheen_tint: self.common.sheen_tint.number(point),
            flatness: self.common.flatness.number(point),
            clearcoat: self.clearcoat.number(point),
            coat: CoatFacets::new(self.clearcoat_gloss.number(point)),
            eta: match side {
                Side::Front => self.eta,
                Side::Back => 1.0 / self.eta,
            },
            sampling: self.sampling,
        }
    }
}

/// The relative index of refraction, from `eta` or `specular`. A surface that lets light through must have one that is not 1.
fn load_eta(object: &Object, transmits: bool) -> Result<f32, SceneError> {
    let specular = object.float("specular")?.map(|specular| specular as f32);
    match object.float("eta")?.map(|eta| eta as f32) {
        Some(_) if specular.is_some() => {
            Err(object.parameter_error("eta", "give either `eta` or `specular`, not both"))
        }
        Some(eta) if !(eta > 0.0 && eta.is_finite()) => {
            Err(object.parameter_error("eta", format!("`eta` is {eta}; an index must be positive")))
        }
        Some(1.0) if transmits => Ok(1.001),
        Some(eta) => Ok(eta),
        None => {
            let specular = match specular.unwrap_or(0.5) {
                0.0 if transmits => 1e-3,
                specular => specular,
            };
            if !(0.0..=1.0).contains(&specular) {
                let message = format!("`specular` is {specular}; it must be from 0 to 1");
                return Err(object.parameter_error("specular", message));
            }
            Ok(2.0 / (1.0 - (0.08 * specular).sqrt()) - 1.0)
        }
    }
}
