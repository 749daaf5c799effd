//! `roughdielectric`: the rough interface of two transparent materials, such as ground glass. It has two sides.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `int_ior`, `ext_ior` | float, string or spectrum | indices of refraction, not the same: see [`index`](super::index) | `bk7`, `air` |
//! | `distribution`, `alpha`, `alpha_u`, `alpha_v`, `sample_visible` | | see [`roughness`](super::roughness) | |
//! | `specular_reflectance` | spectrum or texture | factor of the reflected light, in [0, 1]; physically 1 | 1 |
//! | `specular_transmittance` | spectrum or texture | factor of the refracted light, in [0, 1]; physically 1 | 1 |
//!
//! The model is that of Walter et al. 2007.

use glam::Vec3;

use super::dielectric::{Dielectric, DielectricMaterial};
use super::microfacet::Microfacets;
use super::roughness::Roughness;
use super::surface::Surface;
use super::{BsdfSample, BsdfValue, DirectionNumbers, Side, fresnel};
use crate::sampling::SolidAnglePdf;
use crate::scene::error::SceneError;
use crate::scene::shapes::SurfaceParameters;
use crate::scene::textures::TextureLoader;
use crate::scene::xml::Object;
use crate::spectrum::{Colour, SpectrumArithmetic};

/// A rough interface as the scene states it.
#[derive(Clone, Debug)]
pub struct RoughDielectricMaterial {
    /// The interface of a facet.
    pub interface: DielectricMaterial,
    /// How rough it is.
    pub roughness: Roughness,
}

impl RoughDielectricMaterial {
    /// The rough interface; the smooth one where it has no roughness.
    pub(super) fn load(
        object: &Object,
        textures: &mut TextureLoader,
    ) -> Result<Surface, SceneError> {
        let interface = DielectricMaterial::load_parameters(object, textures)?;
        let roughness = Roughness::load(object, textures)?;
        object.finish()?;
        if interface.indices.are_equal() {
            return Err(object.error(
                "`int_ior` and `ext_ior` of a `roughdielectric` must differ: there would be no interface",
            ));
        }
        Ok(if roughness.is_zero() {
            Surface::Dielectric(interface)
        } else {
            Surface::RoughDielectric(Self {
                interface,
                roughness,
            })
        })
    }

    pub(super) fn needs_parameters(&self) -> bool {
        self.interface.needs_parameters() || self.roughness.needs_parameters()
    }

    pub(super) fn at<C: Colour>(
        &self,
        side: Side,
        point: &SurfaceParameters,
        wavelengths: &C::Wavelengths,
    ) -> RoughDielectric<C::Spectrum> {
        RoughDielectric {
            interface: self.interface.at::<C>(side, point, wavelengths),
            facets: self.roughness.at(point),
        }
    }
}

/// A rough interface, seen from one side, at the wavelengths of one path.
#[derive(Clone, Copy, Debug)]
pub struct RoughDielectric<S> {
    interface: Dielectric<S>,
    facets: Microfacets,
}

impl<S: SpectrumArithmetic> RoughDielectric<S> {
    /// About what the facets scatter. That they hide each other makes it less.
    #[inline]
    pub(super) fn albedo(&self, outgoing: Vec3) -> S {
        self.interface.albedo_at(self.facets.usual_cosine(outgoing))
    }

    #[inline]
    pub(super) fn shininess(&self, _outgoing: Vec3) -> f32 {
        self.facets.shininess()
    }

    #[inline]
    pub(super) fn has_smooth_lobe(&self) -> bool {
        true
    }

    /// The facets that normals are drawn from. Where not only visible ones are drawn, roughness is increased towards normal
    /// incidence, which keeps weights small (Walter et al. 2007, section 5.3).
    fn sampled_facets(&self, outgoing: Vec3) -> Microfacets {
        if self.facets.samples_visible() {
            self.facets
        } else {
            self.facets.scaled(1.2 - 0.2 * outgoing.z.sqrt())
        }
    }

    /// See [`Bsdf::slope_view`](super::Bsdf::slope_view).
    #[inline]
    pub(super) fn slope_view(&self, outgoing: Vec3) -> Option<f32> {
        self.facets.slope_view(outgoing)
    }

    pub(super) fn evaluate(&self, outgoing: Vec3, incident: Vec3) -> BsdfValue<S> {
        if outgoing.z <= 0.0 || incident.z == 0.0 {
            BsdfValue::nothing()
        } else if incident.z > 0.0 {
            self.evaluate_reflection(outgoing, incident)
        } else {
            self.evaluate_refraction(outgoing, incident)
        }
    }

    fn evaluate_reflection(&self, outgoing: Vec3, incident: Vec3) -> BsdfValue<S> {
        let m = (outgoing + incident).normalize();
        let cos = outgoing.dot(m).clamp(0.0, 1.0);
        let reflected = self.interface.fresnel(cos);
        let shadowing = self.facets.shadowing(outgoing, incident, m);
        let value = self.facets.density(m) * shadowing / (4.0 * outgoing.z);
        let pdf = self.sampled_facets(outgoing).pdf(outgoing, m) / (4.0 * cos);
        BsdfValue::of(
            self.interface.reflectance * reflected * value,
            pdf * reflected.hero(),
        )
    }

    /// Walter et al. 2007, equations 16, 17 and 21, with the scaling of radiance. For the hero wavelength alone where there
    /// is dispersion: the same directions belong to other facets at other wavelengths.
    fn evaluate_refraction(&self, outgoing: Vec3, incident: Vec3) -> BsdfValue<S> {
        let eta = self.interface.eta.hero();
        let half = outgoing + incident * eta;
        let Some(m) = (half * half.z.signum()).try_normalize() else {
            return BsdfValue::nothing();
        };
        let (before, behind) = (outgoing.dot(m), incident.dot(m));
        if before <= 0.0 || behind >= 0.0 {
            return BsdfValue::nothing();
        }
        let refracted = 1.0 - fresnel::dielectric(before.min(1.0), eta).reflectance;
        let sum = before + eta * behind;
        // Solid angle of facet normals over that of incident directions.
        let jacobian = -eta * eta * behind / (sum * sum);
        let shadowing = self.facets.shadowing(outgoing, incident, m);
        let value = refracted * self.facets.density(m) * shadowing * before * jacobian
            / (outgoing.z * eta * eta);
        let pdf = self.sampled_facets(outgoing).pdf(outgoing, m) * refracted * jacobian;
        BsdfValue {
            value: self.interface.transmittance * value,
            pdf: SolidAnglePdf(pdf),
            is_dispersive: self.interface.is_dispersive(),
        }
    }

    pub(super) fn sample(&self, outgoing: Vec3, numbers: &DirectionNumbers) -> BsdfSample<S> {
        let eta = self.interface.eta.hero();
        let m = self.sampled_facets(outgoing).sample_by(outgoing, numbers);
        let cos = outgoing.dot(m);
        if cos <= 0.0 {
            return BsdfSample::failed();
        }
        let interface = fresnel::dielectric(cos.min(1.0), eta);
        let is_reflected = numbers.choice < interface.reflectance;
        let incident = if is_reflected {
            fresnel::reflect(outgoing, m)
        } else {
            fresnel::refract(outgoing, m, interface.cos_refracted, eta)
        };
        // A tilted facet can send light to the wrong side of the surface, which no second facet catches here.
        if (incident.z > 0.0) != is_reflected {
            return BsdfSample::failed();
        }
        BsdfSample {
            eta: if is_reflected { 1.0 } else { eta },
            ..BsdfSample::of_value(incident, self.evaluate(outgoing, incident))
        }
    }
}
