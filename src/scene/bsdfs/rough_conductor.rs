//! `roughconductor`: a metal with a rough surface. One-sided.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `material`, `eta`, `k` | | what it is made of: see [`conductor_materials`](super::conductor_materials) | a perfect mirror |
//! | `distribution`, `alpha`, `alpha_u`, `alpha_v`, `sample_visible` | | see [`roughness`](super::roughness) | |
//! | `specular_reflectance` | spectrum or texture | factor of the reflected light, in [0, 1]; physically 1 | 1 |

use glam::Vec3;

use super::conductor::{Conductor, ConductorMaterial};
use super::conductor_materials::ConductorIndex;
use super::microfacet::Microfacets;
use super::roughness::Roughness;
use super::surface::Surface;
use super::{BsdfSample, BsdfValue, DirectionNumbers, fresnel};
use crate::scene::error::SceneError;
use crate::scene::shapes::SurfaceParameters;
use crate::scene::textures::TextureLoader;
use crate::scene::xml::Object;
use crate::spectrum::{Colour, SpectrumArithmetic};

/// A rough metal as the scene states it.
#[derive(Clone, Debug)]
pub struct RoughConductorMaterial {
    /// The metal.
    pub metal: ConductorMaterial,
    /// How rough it is.
    pub roughness: Roughness,
}

impl RoughConductorMaterial {
    /// The rough metal; the smooth one where it has no roughness.
    pub(super) fn load(
        object: &Object,
        textures: &mut TextureLoader,
    ) -> Result<Surface, SceneError> {
        let metal = ConductorMaterial {
            index: ConductorIndex::load(object, textures)?,
            specular_reflectance: textures.reflectance(object, "specular_reflectance", 1.0)?,
        };
        let roughness = Roughness::load(object, textures)?;
        object.finish()?;
        Ok(if roughness.is_zero() {
            Surface::Conductor(metal)
        } else {
            Surface::RoughConductor(Self { metal, roughness })
        })
    }

    pub(super) fn at<C: Colour>(
        &self,
        point: &SurfaceParameters,
        wavelengths: &C::Wavelengths,
    ) -> RoughConductor<C::Spectrum> {
        RoughConductor {
            metal: self.metal.at::<C>(point, wavelengths),
            facets: self.roughness.at(point),
        }
    }
}

/// A rough metal at the wavelengths of one path.
#[derive(Clone, Copy, Debug)]
pub struct RoughConductor<S> {
    metal: Conductor<S>,
    facets: Microfacets,
}

impl<S: SpectrumArithmetic> RoughConductor<S> {
    /// About what the facets reflect. That they hide each other makes it less.
    #[inline]
    pub(super) fn albedo(&self, outgoing: Vec3) -> S {
        self.metal.fresnel(self.facets.usual_cosine(outgoing))
    }

    #[inline]
    pub(super) fn shininess(&self, _outgoing: Vec3) -> f32 {
        self.facets.shininess()
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
        let shadowing = self.facets.shadowing(outgoing, incident, m);
        let density = self.facets.density(m);
        let value = density * shadowing / (4.0 * outgoing.z);
        let cos = outgoing.dot(m).clamp(0.0, 1.0);
        // The density of a normal's mirror direction (Walter et al. 2007, equation 14).
        let pdf = self.facets.pdf_of(density, outgoing, m) / (4.0 * incident.dot(m));
        BsdfValue::of(self.metal.fresnel(cos) * value, pdf)
    }

    pub(super) fn sample(&self, outgoing: Vec3, numbers: &DirectionNumbers) -> BsdfSample<S> {
        let m = self.facets.sample_by(outgoing, numbers);
        let incident = fresnel::reflect(outgoing, m);
        BsdfSample::of_value(incident, self.evaluate(outgoing, incident))
    }
}
