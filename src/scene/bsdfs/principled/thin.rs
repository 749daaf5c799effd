//! `principledthin`: a principled sheet, such as paper or a leaf, with air on both sides. It has two sides, which look alike.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `base_color` | spectrum or texture | colour | 0.5 |
//! | `roughness` | float or texture | roughness of the specular lobes, whose alpha is its square | 0.5 |
//! | `anisotropic` | float or texture | how much they are stretched | 0 |
//! | `spec_trans` | float or texture | share of the specular lobes | 0 |
//! | `eta` | float or texture | index of refraction of the sheet | 1.5 |
//! | `spec_tint` | float or texture | how much reflections are tinted by the colour | 0 |
//! | `sheen` | float or texture | strength of a shine towards grazing angles | 0 |
//! | `sheen_tint` | float or texture | how much that is tinted by the colour | 0 |
//! | `flatness` | float or texture | how much diffuse reflection looks like subsurface scattering | 0 |
//! | `diff_trans` | float or texture | share of diffuse light that goes through, in [0, 2]: 2 is all | 0 |
//! | `diffuse_reflectance_sampling_rate`, `diffuse_transmittance_sampling_rate`, `specular_reflectance_sampling_rate`, `specular_transmittance_sampling_rate` | float | how often lobes are sampled | 1 |
//!
//! Where nothing else is said, numbers are in [0, 1].

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::{
    CommonParameters, diffuse, diffuse_albedo, facets, interface_weight, normal_reflectance,
    sampling_rate, schlick, schlick_weight, share, tint,
};
use crate::sampling::warp;
use crate::scene::bsdfs::microfacet::Microfacets;
use crate::scene::bsdfs::{
    BsdfSample, BsdfValue, DirectionNumbers, Lobes, fresnel, mixed_shininess,
};
use crate::scene::error::SceneError;
use crate::scene::shapes::SurfaceParameters;
use crate::scene::textures::{FloatTexture, TextureLoader};
use crate::scene::xml::Object;
use crate::spectrum::{Colour, SpectrumArithmetic};

/// A principled sheet as the scene states it; every field is a parameter of the scene file.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct PrincipledThinMaterial {
    pub common: CommonParameters,
    pub eta: FloatTexture,
    pub diff_trans: FloatTexture,
    /// Of specular reflection and transmission, diffuse reflection and transmission.
    pub sampling_rates: [f32; 4],
}

impl PrincipledThinMaterial {
    pub(in crate::scene::bsdfs) fn load(
        object: &Object,
        textures: &mut TextureLoader,
    ) -> Result<Self, SceneError> {
        let common = CommonParameters::load(object, textures)?;
        let material = Self {
            eta: textures.number(object, "eta", 1.5)?,
            diff_trans: share(object, textures, "diff_trans", 0.0, 2.0)?,
            common,
            sampling_rates: [
                sampling_rate(object, "specular_reflectance_sampling_rate")?,
                sampling_rate(object, "specular_transmittance_sampling_rate")?,
                sampling_rate(object, "diffuse_reflectance_sampling_rate")?,
                sampling_rate(object, "diffuse_transmittance_sampling_rate")?,
            ],
        };
        object.finish()?;
        match material.eta {
            FloatTexture::Uniform(eta) if !(eta > 0.0 && eta.is_finite()) => {
                Err(object
                    .parameter_error("eta", format!("`eta` is {eta}; an index must be positive")))
            }
            _ => Ok(material),
        }
    }

    pub(in crate::scene::bsdfs) fn needs_parameters(&self) -> bool {
        self.common.anisotropic.can_be_positive() || self.varies()
    }

    /// Whether it differs from point to point.
    pub(in crate::scene::bsdfs) fn varies(&self) -> bool {
        self.common.varies() || self.eta.varies() || self.diff_trans.varies()
    }

    /// Makes it the same everywhere, with the means of its textures.
    pub(in crate::scene::bsdfs) fn make_uniform(&mut self) {
        self.common.make_uniform();
        self.eta.make_uniform();
        self.diff_trans.make_uniform();
    }

    pub(in crate::scene::bsdfs) fn at<C: Colour>(
        &self,
        point: &SurfaceParameters,
        wavelengths: &C::Wavelengths,
    ) -> PrincipledThin<C::Spectrum> {
        let (roughness, eta) = (self.common.roughness.number(point), self.eta.number(point));
        let anisotropic = self.common.anisotropic.number(point);
        // Light that goes through is spread by two faces (Burley 2015, figure 15).
        let spread = (0.65 * eta - 0.35) * roughness;
        PrincipledThin {
            base_color: self.common.base_color.spectrum::<C>(point, wavelengths),
            luminance: self.common.base_color.number(point),
            facets: facets(roughness, anisotropic),
            spread_facets: facets(spread, anisotropic),
            roughness,
            eta,
            specular: self.common.spec_trans.number(point),
            transmitted: 0.5 * self.diff_trans.number(point),
            spec_tint: self.common.spec_tint.number(point),
            sheen: self.common.sheen.number(point),
            sheen_tint: self.common.sheen_tint.number(point),
            flatness: self.common.flatness.number(point),
            sampling_rates: self.sampling_rates,
        }
    }
}

/// A principled sheet at the wavelengths of one path.
#[derive(Clone, Copy, Debug)]
pub struct PrincipledThin<S> {
    base_color: S,
    luminance: f32,
    facets: Microfacets,
    /// The facets as light that goes through sees them.
    spread_facets: Microfacets,
    roughness: f32,
    eta: f32,
    specular: f32,
    /// Share of diffuse light that goes through.
    transmitted: f32,
    spec_tint: f32,
    sheen: f32,
    sheen_tint: f32,
    flatness: f32,
    sampling_rates: [f32; 4],
}

impl<S: SpectrumArithmetic> PrincipledThin<S> {
    /// The probabilities of specular reflection and transmission, diffuse reflection and transmission.
    fn probabilities(&self) -> [f32; 4] {
        let matt = 1.0 - self.specular;
        let shares = [
            0.5 * self.specular,
            0.5 * self.specular,
            matt * (1.0 - self.transmitted),
            matt * self.transmitted,
        ];
        let parts: [f32; 4] = std::array::from_fn(|i| self.sampling_rates[i] * shares[i]);
        let scale = 1.0 / parts.iter().sum::<f32>();
        parts.map(|part| part * scale)
    }

    /// What facets reflect at the cosine `cos`, tinted.
    fn reflected(&self, cos: f32) -> S {
        let dielectric = S::splat(fresnel::dielectric(cos, self.eta).reflectance);
        if self.spec_tint <= 0.0 {
            return dielectric;
        }
        let normal = tint(self.base_color, self.luminance) * normal_reflectance(self.eta);
        let tinted = schlick(normal, interface_weight(cos, self.eta));
        dielectric * (1.0 - self.spec_tint) + tinted * self.spec_tint
    }

    /// The specular and the diffuse part of the albedo.
    fn albedo_parts(&self, outgoing: Vec3) -> [S; 2] {
        let cos = self.facets.usual_cosine(outgoing);
        let passing = 1.0 - fresnel::dielectric(cos, self.eta).reflectance;
        let specular = self.reflected(cos) + self.base_color * passing;
        let [diffuse, sheen] = diffuse_albedo(outgoing);
        let reflected = 1.0 - self.transmitted;
        let diffuse = self.base_color * (self.transmitted + reflected * diffuse)
            + S::splat(reflected * self.sheen * sheen);
        [specular * self.specular, diffuse * (1.0 - self.specular)]
    }

    pub(in crate::scene::bsdfs) fn albedo(&self, outgoing: Vec3) -> S {
        let [specular, diffuse] = self.albedo_parts(outgoing);
        (specular + diffuse).map(|share| share.min(1.0))
    }

    pub(in crate::scene::bsdfs) fn shininess(&self, outgoing: Vec3) -> f32 {
        let shares = self.albedo_parts(outgoing).map(SpectrumArithmetic::mean);
        mixed_shininess(shares, [self.facets.shininess(), 0.0])
    }

    pub(in crate::scene::bsdfs) fn lobes(&self) -> Lobes {
        let [_, _, diffuse, _] = self.probabilities();
        Lobes {
            diffuse,
            has_glossy: true,
        }
    }

    pub(in crate::scene::bsdfs) fn has_smooth_lobe(&self) -> bool {
        true
    }

    pub(in crate::scene::bsdfs) fn evaluate(&self, outgoing: Vec3, incident: Vec3) -> BsdfValue<S> {
        if outgoing.z <= 0.0 || incident.z == 0.0 {
            return BsdfValue::nothing();
        }
        let probabilities = self.probabilities();
        // Light that goes through is reflected light turned over: it is not bent.
        let turned = incident.with_z(incident.z.abs());
        let half = (outgoing + turned).normalize();
        let cos = outgoing.dot(half).clamp(0.0, 1.0);
        let mirrored = 1.0 / (4.0 * cos);
        let cosine_pdf = warp::cosine_hemisphere_pdf(turned.z).0;
        let lobe = |facets: &Microfacets| {
            let shadowing = facets.shadowing(outgoing, turned, half);
            self.specular * facets.density(half) * shadowing / (4.0 * outgoing.z)
        };
        if incident.z > 0.0 {
            let specular = self.reflected(cos) * lobe(&self.facets);
            let diffuse = self.evaluate_diffuse(outgoing, incident, half);
            let pdf = probabilities[0] * self.facets.pdf(outgoing, half) * mirrored
                + probabilities[2] * cosine_pdf;
            return BsdfValue::of(specular + diffuse, pdf);
        }
        // The facet must turn its back to where the light comes from.
        let passes = f32::from(u8::from(incident.dot(half) < 0.0));
        let passing = passes * (1.0 - fresnel::dielectric(cos, self.eta).reflectance);
        let specular = passing * lobe(&self.spread_facets);
        let diffuse = (1.0 - self.specular) * self.transmitted * turned.z * FRAC_1_PI;
        let pdf = passes * probabilities[1] * self.spread_facets.pdf(outgoing, half) * mirrored
            + probabilities[3] * cosine_pdf;
        BsdfValue::of(self.base_color * (specular + diffuse), pdf)
    }

    /// Diffuse reflection and sheen.
    fn evaluate_diffuse(&self, outgoing: Vec3, incident: Vec3, half: Vec3) -> S {
        let share = (1.0 - self.specular) * (1.0 - self.transmitted);
        let lobe = diffuse(outgoing, incident, half, self.roughness, self.flatness);
        let mut value = self.base_color * (share * lobe);
        if self.sheen > 0.0 {
            let white = S::ONE * (1.0 - self.sheen_tint);
            let colour = white + tint(self.base_color, self.luminance) * self.sheen_tint;
            let weight = schlick_weight(half.dot(incident).abs());
            value += colour * (share * self.sheen * weight * incident.z);
        }
        value
    }

    pub(in crate::scene::bsdfs) fn sample(
        &self,
        outgoing: Vec3,
        numbers: &DirectionNumbers,
    ) -> BsdfSample<S> {
        let place = numbers.square;
        let [reflection, transmission, diffuse, _] = self.probabilities();
        let turn_over = |v: Vec3| v.with_z(-v.z);
        let (incident, is_behind) = if numbers.choice < reflection {
            (
                fresnel::reflect(outgoing, self.facets.sample(outgoing, place)),
                false,
            )
        } else if numbers.choice < reflection + transmission {
            let m = self.spread_facets.sample(outgoing, place);
            let incident = turn_over(fresnel::reflect(outgoing, m));
            if incident.dot(m) >= 0.0 {
                return BsdfSample::failed();
            }
            (incident, true)
        } else if numbers.choice < reflection + transmission + diffuse {
            (numbers.diffuse, false)
        } else {
            (turn_over(warp::cosine_hemisphere(place)), true)
        };
        if (incident.z < 0.0) != is_behind {
            return BsdfSample::failed();
        }
        BsdfSample::of_value(incident, self.evaluate(outgoing, incident))
    }
}
