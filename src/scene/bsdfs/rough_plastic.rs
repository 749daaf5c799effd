//! `roughplastic`: a diffuse base under a rough dielectric coating. One-sided.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `diffuse_reflectance` | spectrum or texture | albedo of the base, in [0, 1] | 0.5 |
//! | `specular_reflectance` | spectrum or texture | factor of the light that the coating reflects, in [0, 1]; physically 1 | 1 |
//! | `nonlinear` | boolean | let the reflections between base and coating shift the colour, as they do | false |
//! | `int_ior`, `ext_ior` | float or string | indices of refraction, not the same: see [`index`](super::index) | `polypropylene`, `air` |
//! | `distribution`, `sample_visible` | | see [`roughness`](super::roughness) | |
//! | `alpha` | float | roughness of the coating | 0.1 |

use std::f32::consts::FRAC_1_PI;

use glam::{Vec2, Vec3};

use super::microfacet::{Distribution, Microfacets};
use super::plastic::{CoatedBase, PlasticMaterial, specular_probability};
use super::rough_coating::RoughCoating;
use super::surface::Surface;
use super::{BsdfSample, BsdfValue, DirectionNumbers, Lobes, fresnel, mixed_shininess, roughness};
use crate::sampling::warp;
use crate::scene::error::SceneError;
use crate::scene::shapes::SurfaceParameters;
use crate::scene::textures::TextureLoader;
use crate::scene::xml::Object;
use crate::spectrum::{Colour, SpectrumArithmetic};

/// A rough plastic as the scene states it.
#[derive(Clone, Debug)]
pub struct RoughPlasticMaterial {
    /// Base and coating.
    pub base: CoatedBase,
    /// The kind of the coating's facets.
    pub distribution: Distribution,
    /// Roughness of the coating.
    pub alpha: f32,
    facets: Microfacets,
    coating: &'static RoughCoating,
    specular_sampling_weight: f32,
}

impl RoughPlasticMaterial {
    /// The rough plastic; the smooth one where its coating has no roughness.
    pub(super) fn load(
        object: &Object,
        textures: &mut TextureLoader,
    ) -> Result<Surface, SceneError> {
        let base = CoatedBase::load(object, textures)?;
        let (distribution, sample_visible) = roughness::kind(object)?;
        let alpha = object.float_or("alpha", 0.1)? as f32;
        roughness::check(object, "alpha", alpha)?;
        object.finish()?;
        if base.eta == 1.0 {
            return Err(object.error(
                "`int_ior` and `ext_ior` of a `roughplastic` must differ: there would be no coating",
            ));
        }
        if alpha == 0.0 {
            return Ok(Surface::Plastic(PlasticMaterial::new(base)));
        }
        Ok(Surface::RoughPlastic(Self {
            coating: RoughCoating::of(distribution, alpha, base.eta),
            facets: Microfacets::new(distribution, Vec2::splat(alpha), sample_visible),
            specular_sampling_weight: base.specular_sampling_weight(),
            base,
            distribution,
            alpha,
        }))
    }

    pub(super) fn at<C: Colour>(
        &self,
        point: &SurfaceParameters,
        wavelengths: &C::Wavelengths,
    ) -> RoughPlastic<C::Spectrum> {
        let specular = &self.base.specular_reflectance;
        let internal = self.coating.internal_reflectance;
        RoughPlastic {
            base: self.base.base::<C>(point, wavelengths, internal),
            specular: specular.spectrum::<C>(point, wavelengths),
            facets: self.facets,
            eta: self.base.eta,
            specular_sampling_weight: self.specular_sampling_weight,
            coating: self.coating,
        }
    }
}

/// A rough plastic at the wavelengths of one path.
#[derive(Clone, Copy, Debug)]
pub struct RoughPlastic<S> {
    /// See [`CoatedBase::base`].
    base: S,
    specular: S,
    facets: Microfacets,
    eta: f32,
    specular_sampling_weight: f32,
    coating: &'static RoughCoating,
}

impl<S: SpectrumArithmetic> RoughPlastic<S> {
    /// The probability with which the coating's reflection is sampled, where it lets the share `transmitted` through.
    fn specular_probability(&self, transmitted: f32) -> f32 {
        specular_probability(
            1.0 - transmitted,
            transmitted,
            self.specular_sampling_weight,
        )
    }

    /// What the base reflects, about: averaged over the directions into which it leaves the coating as if that were smooth.
    fn diffuse_albedo(&self, transmitted: f32) -> S {
        self.base * (transmitted * (1.0 - fresnel::diffuse_reflectance(self.eta)))
    }

    pub(super) fn albedo(&self, outgoing: Vec3) -> S {
        let transmitted = self.coating.transmittance(outgoing.z);
        let specular = self.specular * (1.0 - transmitted);
        (specular + self.diffuse_albedo(transmitted)).map(|share| share.min(1.0))
    }

    pub(super) fn shininess(&self, outgoing: Vec3) -> f32 {
        let transmitted = self.coating.transmittance(outgoing.z);
        let shares = [
            (self.specular * (1.0 - transmitted)).mean(),
            self.diffuse_albedo(transmitted).mean(),
        ];
        mixed_shininess(shares, [self.facets.shininess(), 0.0])
    }

    pub(super) fn lobes(&self, outgoing: Vec3) -> Lobes {
        let transmitted = self.coating.transmittance(outgoing.z);
        Lobes {
            diffuse: 1.0 - self.specular_probability(transmitted),
            has_glossy: true,
        }
    }

    #[inline]
    pub(super) fn has_smooth_lobe(&self) -> bool {
        true
    }

    /// See [`Bsdf::slope_view`](super::Bsdf::slope_view).
    #[inline]
    pub(super) fn slope_view(&self, outgoing: Vec3) -> Option<f32> {
        self.facets.slope_view(outgoing)
    }

    pub(super) fn evaluate(&self, outgoing: Vec3, incident: Vec3) -> BsdfValue<S> {
        if outgoing.z <= 0.0 || incident.z <= 0.0 {
            return BsdfValue::nothing();
        }
        let m = (outgoing + incident).normalize();
        let cos = outgoing.dot(m).clamp(0.0, 1.0);
        let reflected = fresnel::dielectric(cos, self.eta).reflectance;
        let shadowing = self.facets.shadowing(outgoing, incident, m);
        let density = self.facets.density(m);
        let specular = reflected * density * shadowing / (4.0 * outgoing.z);
        let transmitted = self.coating.transmittance(outgoing.z);
        let diffuse = transmitted * self.coating.transmittance(incident.z) * incident.z * FRAC_1_PI;
        let probability = self.specular_probability(transmitted);
        let pdf = probability * self.facets.pdf_of(density, outgoing, m) / (4.0 * cos)
            + (1.0 - probability) * warp::cosine_hemisphere_pdf(incident.z).0;
        BsdfValue::of(self.specular * specular + self.base * diffuse, pdf)
    }

    pub(super) fn sample(&self, outgoing: Vec3, numbers: &DirectionNumbers) -> BsdfSample<S> {
        let transmitted = self.coating.transmittance(outgoing.z);
        let incident = if numbers.choice < self.specular_probability(transmitted) {
            fresnel::reflect(outgoing, self.facets.sample_by(outgoing, numbers))
        } else {
            numbers.diffuse
        };
        BsdfSample::of_value(incident, self.evaluate(outgoing, incident))
    }
}
