//! `diffuse`: an ideally diffuse (Lambertian) surface. One-sided: its back is black unless it stands in a `twosided`.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `reflectance` | spectrum or texture | share of the incident light that is reflected, in [0, 1] | 0.5 |

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::{BsdfSample, BsdfValue, DirectionNumbers, Lobes};
use crate::sampling::warp;
use crate::scene::error::SceneError;
use crate::scene::shapes::SurfaceParameters;
use crate::scene::textures::{SpectrumTexture, TextureLoader};
use crate::scene::xml::Object;
use crate::spectrum::{Colour, SpectralCurve, SpectrumArithmetic};

const DEFAULT_REFLECTANCE: f32 = 0.5;

/// A diffuse surface as the scene states it.
#[derive(Clone, Debug)]
pub struct DiffuseMaterial {
    /// Share of the incident light that is reflected.
    pub reflectance: SpectrumTexture,
}

impl Default for DiffuseMaterial {
    fn default() -> Self {
        let reflectance = SpectralCurve::constant_reflectance(DEFAULT_REFLECTANCE);
        Self {
            reflectance: SpectrumTexture::Uniform(reflectance.unwrap_or(SpectralCurve::BLACK)),
        }
    }
}

impl DiffuseMaterial {
    pub(super) fn load(object: &Object, textures: &mut TextureLoader) -> Result<Self, SceneError> {
        let reflectance = textures.reflectance(object, "reflectance", DEFAULT_REFLECTANCE)?;
        object.finish()?;
        Ok(Self { reflectance })
    }

    #[inline]
    pub(super) fn at<C: Colour>(
        &self,
        point: &SurfaceParameters,
        wavelengths: &C::Wavelengths,
    ) -> Diffuse<C::Spectrum> {
        Diffuse {
            reflectance: self.reflectance.spectrum::<C>(point, wavelengths),
        }
    }
}

/// A diffuse surface at the wavelengths of one path: f = reflectance / pi.
#[derive(Clone, Copy, Debug)]
pub struct Diffuse<S> {
    /// Share of the incident light that is reflected, in [0, 1].
    pub reflectance: S,
}

impl<S: SpectrumArithmetic> Diffuse<S> {
    #[inline]
    pub(super) fn albedo(&self, _outgoing: Vec3) -> S {
        self.reflectance
    }

    #[inline]
    pub(super) fn shininess(&self, _outgoing: Vec3) -> f32 {
        0.0
    }

    #[inline]
    pub(super) fn lobes(&self) -> Lobes {
        Lobes {
            diffuse: 1.0,
            has_glossy: false,
        }
    }

    #[inline]
    pub(super) fn has_smooth_lobe(&self) -> bool {
        true
    }

    #[inline]
    pub(super) fn evaluate(&self, outgoing: Vec3, incident: Vec3) -> BsdfValue<S> {
        if outgoing.z <= 0.0 || incident.z <= 0.0 {
            return BsdfValue::nothing();
        }
        let value = self.reflectance * (incident.z * FRAC_1_PI);
        BsdfValue::of(value, warp::cosine_hemisphere_pdf(incident.z).0)
    }

    #[inline]
    pub(super) fn sample(&self, _outgoing: Vec3, numbers: &DirectionNumbers) -> BsdfSample<S> {
        let incident = numbers.diffuse;
        let pdf = warp::cosine_hemisphere_pdf(incident.z).0;
        // (reflectance / pi) cos / (cos / pi)
        BsdfSample::smooth(incident, self.reflectance, pdf)
    }
}
