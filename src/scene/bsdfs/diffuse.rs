//! `diffuse`: an ideally diffuse (Lambertian) surface. One-sided: its back is black unless it stands in a `twosided`.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `reflectance` | spectrum | share of the incident light that is reflected, in [0, 1] | 0.5 |

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::{BsdfSample, BsdfValue};
use crate::sampling::{SolidAnglePdf, warp};
use crate::scene::error::SceneError;
use crate::scene::spectra::{Quantity, spectrum_or};
use crate::scene::xml::Object;
use crate::spectrum::{Colour, SpectralCurve, SpectrumArithmetic};

const DEFAULT_REFLECTANCE: f32 = 0.5;

/// A diffuse surface as the scene states it.
#[derive(Clone, Debug)]
pub struct DiffuseMaterial {
    /// Share of the incident light that is reflected.
    pub reflectance: SpectralCurve,
}

impl Default for DiffuseMaterial {
    fn default() -> Self {
        let reflectance = SpectralCurve::constant_reflectance(DEFAULT_REFLECTANCE);
        Self {
            reflectance: reflectance.unwrap_or(SpectralCurve::BLACK),
        }
    }
}

impl DiffuseMaterial {
    pub(super) fn load(object: &Object) -> Result<Self, SceneError> {
        let reflectance = spectrum_or(
            object,
            "reflectance",
            Quantity::Reflectance,
            DEFAULT_REFLECTANCE,
        )?;
        object.finish()?;
        Ok(Self { reflectance })
    }

    #[inline]
    pub(super) fn at<C: Colour>(&self, wavelengths: &C::Wavelengths) -> Diffuse<C::Spectrum> {
        Diffuse {
            reflectance: C::evaluate(&self.reflectance, wavelengths),
        }
    }
}

/// A diffuse surface at the wavelengths of one path: f = reflectance / pi.
#[derive(Clone, Copy, Debug)]
pub struct Diffuse<S> {
    reflectance: S,
}

impl<S: SpectrumArithmetic> Diffuse<S> {
    #[inline]
    pub(super) fn albedo(&self) -> S {
        self.reflectance
    }

    #[inline]
    pub(super) fn shininess(&self) -> f32 {
        0.0
    }

    #[inline]
    pub(super) fn evaluate(&self, outgoing: Vec3, incident: Vec3) -> BsdfValue<S> {
        if outgoing.z <= 0.0 || incident.z <= 0.0 {
            return BsdfValue {
                value: S::ZERO,
                pdf: SolidAnglePdf(0.0),
            };
        }
        BsdfValue {
            value: self.reflectance * (incident.z * FRAC_1_PI),
            pdf: warp::cosine_hemisphere_pdf(incident.z),
        }
    }

    #[inline]
    pub(super) fn sample(&self, _outgoing: Vec3, u: [f32; 2]) -> BsdfSample<S> {
        let incident = warp::cosine_hemisphere(u);
        BsdfSample {
            incident,
            // (reflectance / pi) cos / (cos / pi)
            weight: self.reflectance,
            pdf: warp::cosine_hemisphere_pdf(incident.z),
        }
    }
}
