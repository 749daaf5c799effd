//! The lobes of `principled`.

use glam::Vec3;

use super::{
    CoatFacets, diffuse, diffuse_albedo, interface_weight, normal_reflectance, schlick,
    schlick_weight, tint,
};
use crate::sampling::warp;
use crate::scene::bsdfs::microfacet::Microfacets;
use crate::scene::bsdfs::{
    BsdfSample, BsdfValue, DirectionNumbers, Lobes, Side, fresnel, mixed_shininess,
};
use crate::spectrum::SpectrumArithmetic;

/// How often the lobes of a principled surface are sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SamplingRates {
    /// Diffuse reflection.
    pub diffuse: f32,
    /// Specular reflection and refraction.
    pub specular: f32,
    /// Reflection by the clear coat.
    pub clearcoat: f32,
}

/// A principled surface, seen from one side, at the wavelengths of one path.
#[derive(Clone, Copy, Debug)]
pub struct Principled<S> {
    pub(super) side: Side,
    pub(super) base_color: S,
    pub(super) luminance: f32,
    pub(super) facets: Microfacets,
    pub(super) roughness: f32,
    pub(super) metallic: f32,
    /// Share of the diffuse lobe and its company.
    pub(super) opaque: f32,
    /// Share of the refracting lobe.
    pub(super) glassy: f32,
    pub(super) spec_tint: f32,
    pub(super) sheen: f32,
    pub(super) sheen_tint: f32,
    pub(super) flatness: f32,
    pub(super) clearcoat: f32,
    pub(super) coat: CoatFacets,
    /// Index of refraction behind the surface over the one before it.
    pub(super) eta: f32,
    pub(super) sampling: SamplingRates,
}

/// The probabilities of the lobes; they add up to 1.
struct Probabilities {
    reflection: f32,
    refraction: f32,
    clearcoat: f32,
    diffuse: f32,
}

impl<S: SpectrumArithmetic> Principled<S> {
    /// The probabilities where a facet reflects the share `reflected`. Inside, light is only reflected and refracted.
    fn probabilities(&self, reflected: f32) -> Probabilities {
        let rates = &self.sampling;
        let parts = match self.side {
            Side::Front => [
                rates.specular * (1.0 - self.glassy * (1.0 - reflected)),
                rates.specular * self.glassy * (1.0 - reflected),
                0.25 * self.clearcoat * rates.clearcoat,
                self.opaque * rates.diffuse,
            ],
            Side::Back => [reflected, 1.0 - reflected, 0.0, 0.0],
        };
        let scale = 1.0 / parts.iter().sum::<f32>();
        let [reflection, refraction, clearcoat, diffuse] = parts.map(|part| part * scale);
        Probabilities {
            reflection,
            refraction,
            clearcoat,
            diffuse,
        }
    }

    /// What facets reflect at the cosine `cos`: dielectric, tinted and metallic in their shares.
    fn reflected(&self, cos: f32) -> S {
        let dielectric = fresnel::dielectric(cos, self.eta).reflectance;
        if self.side == Side::Back {
            return S::splat(self.glassy * dielectric);
        }
        let weight = interface_weight(cos, self.eta);
        let plain = (1.0 - self.metallic) * (1.0 - self.spec_tint) * dielectric;
        let mut reflected = S::splat(plain) + schlick(self.base_color, weight) * self.metallic;
        if self.spec_tint > 0.0 {
            let tinted = tint(self.base_color, self.luminance) * normal_reflectance(self.eta);
            reflected += schlick(tinted, weight) * ((1.0 - self.metallic) * self.spec_tint);
        }
        reflected
    }

    /// The parts of [`Self::albedo`] that are reflected by facets, refracted and diffuse.
    fn albedo_parts(&self, outgoing: Vec3) -> [S; 3] {
        let cos = self.facets.usual_cosine(outgoing);
        let passing = 1.0 - fresnel::dielectric(cos, self.eta).reflectance;
        let coat = 0.25 * self.clearcoat * (0.04 + 0.96 * schlick_weight(outgoing.z));
        let [diffuse, sheen] = diffuse_albedo(outgoing);
        let sheen = self.sheen * (1.0 - self.metallic) * sheen;
        let (diffuse, coat) = match self.side {
            Side::Front => (
                self.base_color * (self.opaque * diffuse) + S::splat(sheen),
                coat,
            ),
            Side::Back => (S::ZERO, 0.0),
        };
        [
            self.reflected(cos) + S::splat(coat),
            self.base_color.map(f32::sqrt) * (self.glassy * passing),
            diffuse,
        ]
    }

    pub(in crate::scene::bsdfs) fn albedo(&self, outgoing: Vec3) -> S {
        let [reflected, refracted, diffuse] = self.albedo_parts(outgoing);
        (reflected + refracted + diffuse).map(|share| share.min(1.0))
    }

    pub(in crate::scene::bsdfs) fn shininess(&self, outgoing: Vec3) -> f32 {
        let shares = self.albedo_parts(outgoing).map(SpectrumArithmetic::mean);
        let facets = self.facets.shininess();
        mixed_shininess(shares, [facets, facets, 0.0])
    }

    pub(in crate::scene::bsdfs) fn lobes(&self) -> Lobes {
        Lobes {
            // What a facet reflects makes no difference to that.
            diffuse: self.probabilities(0.0).diffuse,
            has_glossy: true,
        }
    }

    pub(in crate::scene::bsdfs) fn has_smooth_lobe(&self) -> bool {
        true
    }

    pub(in crate::scene::bsdfs) fn evaluate(&self, outgoing: Vec3, incident: Vec3) -> BsdfValue<S> {
        if outgoing.z <= 0.0 || incident.z == 0.0 {
            BsdfValue::nothing()
        } else if incident.z > 0.0 {
            self.evaluate_reflection(outgoing, incident)
        } else {
            self.evaluate_refraction(outgoing, incident)
        }
    }

    fn evaluate_reflection(&self, outgoing: Vec3, incident: Vec3) -> BsdfValue<S> {
        let half = (outgoing + incident).normalize();
        let cos = outgoing.dot(half).clamp(0.0, 1.0);
        let dielectric = fresnel::dielectric(cos, self.eta).reflectance;
        let probabilities = self.probabilities(dielectric);
        let mirrored = 1.0 / (4.0 * cos);
        let mut pdf = probabilities.reflection * self.facets.pdf(outgoing, half) * mirrored
            + probabilities.diffuse * warp::cosine_hemisphere_pdf(incident.z).0;
        let mut value = S::ZERO;
        if dielectric > 0.0 {
            let shadowing = self.facets.shadowing(outgoing, incident, half);
            let lobe = self.facets.density(half) * shadowing / (4.0 * outgoing.z);
            value += self.reflected(cos) * lobe;
        }
        if self.side == Side::Front {
            if self.clearcoat > 0.0 {
                pdf += probabilities.clearcoat * self.coat.pdf(half) * mirrored;
                let weight = interface_weight(cos, self.eta);
                let fresnel = 0.04 + 0.96 * weight;
                let shadowing = CoatFacets::shadowing(outgoing, incident);
                let lobe = fresnel * self.coat.density(half) * shadowing * incident.z;
                value += S::splat(0.25 * self.clearcoat * lobe);
            }
            value += self.evaluate_diffuse(outgoing, incident, half);
        }
        BsdfValue::of(value, pdf)
    }

    /// Diffuse reflection and sheen.
    fn evaluate_diffuse(&self, outgoing: Vec3, incident: Vec3, half: Vec3) -> S {
        if self.opaque <= 0.0 {
            return S::ZERO;
        }
        let lobe = diffuse(outgoing, incident, half, self.roughness, self.flatness);
        let mut value = self.base_color * (self.opaque * lobe);
        if self.sheen > 0.0 {
            let white = S::ONE * (1.0 - self.sheen_tint);
            let colour = white + tint(self.base_color, self.luminance) * self.sheen_tint;
            let weight = schlick_weight(half.dot(incident).abs());
            value += colour * (self.sheen * (1.0 - self.metallic) * weight * incident.z);
        }
        value
    }

    fn evaluate_refraction(&self, outgoing: Vec3, incident: Vec3) -> BsdfValue<S> {
        let half = outgoing + incident * self.eta;
        let m = (half * half.z.signum()).try_normalize();
        let Some(m) = m.filter(|_| self.glassy > 0.0) else {
            return BsdfValue::nothing();
        };
        let (before, behind) = (outgoing.dot(m), incident.dot(m));
        if before <= 0.0 || behind >= 0.0 {
            return BsdfValue::nothing();
        }
        let reflected = fresnel::dielectric(before.min(1.0), self.eta).reflectance;
        let sum = before + self.eta * behind;
        let jacobian = -self.eta * self.eta * behind / (sum * sum);
        let shadowing = self.facets.shadowing(outgoing, incident, m);
        let lobe = (1.0 - reflected) * self.facets.density(m) * shadowing * before * jacobian
            / (outgoing.z * self.eta * self.eta);
        let probability = self.probabilities(reflected).refraction;
        BsdfValue::of(
            self.base_color.map(f32::sqrt) * (self.glassy * lobe),
            probability * self.facets.pdf(outgoing, m) * jacobian,
        )
    }

    pub(in crate::scene::bsdfs) fn sample(
        &self,
        outgoing: Vec3,
        numbers: &DirectionNumbers,
    ) -> BsdfSample<S> {
        let place = numbers.square;
        let m = self.facets.sample(outgoing, place);
        let cos = outgoing.dot(m).clamp(0.0, 1.0);
        let interface = fresnel::dielectric(cos, self.eta);
        let probabilities = self.probabilities(interface.reflectance);
        let mut limit = probabilities.diffuse;
        let is_diffuse = numbers.choice < limit;
        limit += probabilities.clearcoat;
        let is_coat = numbers.choice < limit;
        limit += probabilities.refraction;
        let is_refracted = !is_coat && numbers.choice < limit;
        let incident = if is_diffuse {
            numbers.diffuse
        } else if is_coat {
            fresnel::reflect(outgoing, self.coat.sample(place))
        } else if is_refracted {
            fresnel::refract(outgoing, m, interface.cos_refracted, self.eta)
        } else {
            fresnel::reflect(outgoing, m)
        };
        if (incident.z < 0.0) != is_refracted {
            return BsdfSample::failed();
        }
        BsdfSample {
            eta: if is_refracted { self.eta } else { 1.0 },
            ..BsdfSample::of_value(incident, self.evaluate(outgoing, incident))
        }
    }
}
