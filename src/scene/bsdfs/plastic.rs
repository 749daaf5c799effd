//! `plastic`: a diffuse base under a smooth dielectric coating. One-sided.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `diffuse_reflectance` | spectrum or texture | albedo of the base, in [0, 1] | 0.5 |
//! | `specular_reflectance` | spectrum or texture | factor of the light that the coating reflects, in [0, 1]; physically 1 | 1 |
//! | `nonlinear` | boolean | let the reflections between base and coating shift the colour, as they do | false |
//! | `int_ior`, `ext_ior` | float or string | indices of refraction: see [`index`](super::index) | `polypropylene`, `air` |

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::index::Indices;
use super::surface::Surface;
use super::{
    BsdfSample, BsdfValue, DiffuseMaterial, DirectionNumbers, Lobes, fresnel, mixed_shininess,
};
use crate::sampling::warp;
use crate::scene::error::SceneError;
use crate::scene::shapes::SurfaceParameters;
use crate::scene::textures::{SpectrumTexture, TextureLoader};
use crate::scene::xml::Object;
use crate::spectrum::{Colour, SpectrumArithmetic};

/// What `plastic` and `roughplastic` have in common, as the scene states it.
#[derive(Clone, Debug)]
pub struct CoatedBase {
    /// Albedo of the base.
    pub diffuse_reflectance: SpectrumTexture,
    /// Factor of the light that the coating reflects.
    pub specular_reflectance: SpectrumTexture,
    /// Whether reflections between base and coating shift the colour.
    pub nonlinear: bool,
    /// Index of refraction of the coating over that of what is before it.
    pub eta: f32,
}

impl CoatedBase {
    pub(super) fn load(object: &Object, textures: &mut TextureLoader) -> Result<Self, SceneError> {
        Ok(Self {
            diffuse_reflectance: textures.reflectance(object, "diffuse_reflectance", 0.5)?,
            specular_reflectance: textures.reflectance(object, "specular_reflectance", 1.0)?,
            nonlinear: object.boolean_or("nonlinear", false)?,
            eta: Indices::load_relative(object, "polypropylene")?,
        })
    }

    pub(super) fn needs_parameters(&self) -> bool {
        self.diffuse_reflectance.varies() || self.specular_reflectance.varies()
    }

    /// How much more often than by the coating's reflectance alone light reflected by the coating is sampled, in [0, 1].
    pub(super) fn specular_sampling_weight(&self) -> f32 {
        let (diffuse, specular) = (
            self.diffuse_reflectance.mean(),
            self.specular_reflectance.mean(),
        );
        if diffuse + specular > 0.0 {
            specular / (diffuse + specular)
        } else {
            0.5
        }
    }

    /// What of the light that entered leaves the coating from below, as a factor of what gets through it twice, where
    /// `internal` is the share of diffuse light that the coating reflects back to the base.
    pub(super) fn base<C: Colour>(
        &self,
        point: &SurfaceParameters,
        wavelengths: &C::Wavelengths,
        internal: f32,
    ) -> C::Spectrum {
        let diffuse = self.diffuse_reflectance.spectrum::<C>(point, wavelengths);
        let inverse_eta_squared = 1.0 / (self.eta * self.eta);
        diffuse.map(|albedo| {
            let reflected = if self.nonlinear {
                albedo * internal
            } else {
                internal
            };
            albedo * inverse_eta_squared / (1.0 - reflected)
        })
    }
}

/// A smooth plastic as the scene states it.
#[derive(Clone, Debug)]
pub struct PlasticMaterial {
    /// Base and coating.
    pub base: CoatedBase,
    internal_reflectance: f32,
    specular_sampling_weight: f32,
}

impl PlasticMaterial {
    /// The plastic; its base alone where there is no coating.
    pub(super) fn load(
        object: &Object,
        textures: &mut TextureLoader,
    ) -> Result<Surface, SceneError> {
        let base = CoatedBase::load(object, textures)?;
        object.finish()?;
        Ok(if base.eta == 1.0 {
            Surface::Diffuse(DiffuseMaterial {
                reflectance: base.diffuse_reflectance,
            })
        } else {
            Surface::Plastic(Self::new(base))
        })
    }

    /// With a smooth coating on `base`.
    pub(super) fn new(base: CoatedBase) -> Self {
        Self {
            internal_reflectance: fresnel::diffuse_reflectance(1.0 / base.eta),
            specular_sampling_weight: base.specular_sampling_weight(),
            base,
        }
    }

    pub(super) fn at<C: Colour>(
        &self,
        point: &SurfaceParameters,
        wavelengths: &C::Wavelengths,
    ) -> Plastic<C::Spectrum> {
        let specular = &self.base.specular_reflectance;
        Plastic {
            base: self
                .base
                .base::<C>(point, wavelengths, self.internal_reflectance),
            specular: specular.spectrum::<C>(point, wavelengths),
            eta: self.base.eta,
            specular_sampling_weight: self.specular_sampling_weight,
        }
    }
}

/// A smooth plastic at the wavelengths of one path.
#[derive(Clone, Copy, Debug)]
pub struct Plastic<S> {
    /// See [`CoatedBase::base`].
    base: S,
    specular: S,
    eta: f32,
    specular_sampling_weight: f32,
}

/// The probability with which the reflection of a coating is sampled that reflects the share `reflected` and lets `transmitted` through;
/// `weight` is [`CoatedBase::specular_sampling_weight`].
#[inline]
pub(super) fn specular_probability(reflected: f32, transmitted: f32, weight: f32) -> f32 {
    let (specular, diffuse) = (reflected * weight, transmitted * (1.0 - weight));
    if specular + diffuse > 0.0 {
        specular / (specular + diffuse)
    } else {
        0.0
    }
}

impl<S: SpectrumArithmetic> Plastic<S> {
    #[inline]
    fn reflected(&self, cos: f32) -> f32 {
        fresnel::dielectric(cos, self.eta).reflectance
    }

    /// The probability with which the coating's reflection is sampled, where it reflects the share `reflected`.
    #[inline]
    fn specular_probability(&self, reflected: f32) -> f32 {
        specular_probability(reflected, 1.0 - reflected, self.specular_sampling_weight)
    }

    /// What the base reflects, averaged over the directions into which it leaves the coating.
    fn diffuse_albedo(&self, reflected: f32) -> S {
        self.base * ((1.0 - reflected) * (1.0 - fresnel::diffuse_reflectance(self.eta)))
    }

    pub(super) fn albedo(&self, outgoing: Vec3) -> S {
        let reflected = self.reflected(outgoing.z);
        (self.specular * reflected + self.diffuse_albedo(reflected)).map(|share| share.min(1.0))
    }

    pub(super) fn shininess(&self, outgoing: Vec3) -> f32 {
        let reflected = self.reflected(outgoing.z);
        let shares = [
            (self.specular * reflected).mean(),
            self.diffuse_albedo(reflected).mean(),
        ];
        mixed_shininess(shares, [f32::INFINITY, 0.0])
    }

    pub(super) fn lobes(&self, outgoing: Vec3) -> Lobes {
        Lobes {
            diffuse: 1.0 - self.specular_probability(self.reflected(outgoing.z)),
            has_glossy: false,
        }
    }

    #[inline]
    pub(super) fn has_smooth_lobe(&self) -> bool {
        true
    }

    pub(super) fn evaluate(&self, outgoing: Vec3, incident: Vec3) -> BsdfValue<S> {
        if outgoing.z <= 0.0 || incident.z <= 0.0 {
            return BsdfValue::nothing();
        }
        let reflected = self.reflected(outgoing.z);
        let transmitted = (1.0 - reflected) * (1.0 - self.reflected(incident.z));
        let probability = 1.0 - self.specular_probability(reflected);
        BsdfValue::of(
            self.base * (transmitted * incident.z * FRAC_1_PI),
            probability * warp::cosine_hemisphere_pdf(incident.z).0,
        )
    }

    pub(super) fn sample(&self, outgoing: Vec3, numbers: &DirectionNumbers) -> BsdfSample<S> {
        let reflected = self.reflected(outgoing.z);
        let probability = self.specular_probability(reflected);
        if numbers.choice < probability {
            let incident = fresnel::reflect_local(outgoing);
            return BsdfSample::discrete(incident, self.specular * (reflected / probability));
        }
        let incident = numbers.diffuse;
        BsdfSample::of_value(incident, self.evaluate(outgoing, incident))
    }
}
