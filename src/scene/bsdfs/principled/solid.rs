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

use glam::Vec3;

use super::{
    CoatFacets, diffuse, diffuse_albedo, facets, interface_weight, normal_reflectance,
    sampling_rate, schlick, schlick_weight, share, tint,
};
use crate::sampling::warp;
use crate::scene::bsdfs::microfacet::Microfacets;
use crate::scene::bsdfs::{BsdfSample, BsdfValue, Side, fresnel, mixed_shininess};
use crate::scene::error::SceneError;
use crate::scene::shapes::SurfaceParameters;
use crate::scene::textures::{FloatTexture, SpectrumTexture, TextureLoader};
use crate::scene::xml::Object;
use crate::spectrum::{Colour, SpectrumArithmetic};

/// A principled surface as the scene states it; every field is a parameter of the scene file.
#[derive(Clone, Debug)]
#[allow(missing_docs)]
pub struct PrincipledMaterial {
    pub base_color: SpectrumTexture,
    pub roughness: FloatTexture,
    pub anisotropic: FloatTexture,
    pub metallic: FloatTexture,
    pub spec_trans: FloatTexture,
    pub spec_tint: FloatTexture,
    pub sheen: FloatTexture,
    pub sheen_tint: FloatTexture,
    pub flatness: FloatTexture,
    pub clearcoat: FloatTexture,
    pub clearcoat_gloss: FloatTexture,
    pub eta: f32,
    pub sampling: SamplingRates,
}

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

impl PrincipledMaterial {
    pub(in crate::scene::bsdfs) fn load(
        object: &Object,
        textures: &mut TextureLoader,
    ) -> Result<Self, SceneError> {
        let mut number = |name, default| share(object, textures, name, default, 1.0);
        let roughness = number("roughness", 0.5)?;
        let anisotropic = number("anisotropic", 0.0)?;
        let metallic = number("metallic", 0.0)?;
        let spec_trans = number("spec_trans", 0.0)?;
        let spec_tint = number("spec_tint", 0.0)?;
        let sheen = number("sheen", 0.0)?;
        let sheen_tint = number("sheen_tint", 0.0)?;
        let flatness = number("flatness", 0.0)?;
        let clearcoat = number("clearcoat", 0.0)?;
        let clearcoat_gloss = number("clearcoat_gloss", 0.0)?;
        let transmits = can_be_positive(&spec_trans);
        let material = Self {
            base_color: textures.reflectance(object, "base_color", 0.5)?,
            eta: load_eta(object, transmits)?,
            sampling: SamplingRates {
                diffuse: sampling_rate(object, "diffuse_reflectance_sampling_rate")?,
                specular: sampling_rate(object, "main_specular_sampling_rate")?,
                clearcoat: sampling_rate(object, "clearcoat_sampling_rate")?,
            },
            roughness,
            anisotropic,
            metallic,
            spec_trans,
            spec_tint,
            sheen,
            sheen_tint,
            flatness,
            clearcoat,
            clearcoat_gloss,
        };
        object.finish()?;
        Ok(material)
    }

    pub(in crate::scene::bsdfs) fn is_transmissive(&self) -> bool {
        can_be_positive(&self.spec_trans)
    }

    pub(in crate::scene::bsdfs) fn needs_parameters(&self) -> bool {
        let numbers = [
            &self.roughness,
            &self.metallic,
            &self.spec_trans,
            &self.spec_tint,
            &self.sheen,
            &self.sheen_tint,
            &self.flatness,
            &self.clearcoat,
            &self.clearcoat_gloss,
        ];
        self.base_color.varies()
            || can_be_positive(&self.anisotropic)
            || numbers.iter().any(|number| number.varies())
    }

    pub(in crate::scene::bsdfs) fn at<C: Colour>(
        &self,
        side: Side,
        point: &SurfaceParameters,
        wavelengths: &C::Wavelengths,
    ) -> Principled<C::Spectrum> {
        let (metallic, spec_trans) = (self.metallic.number(point), self.spec_trans.number(point));
        let roughness = self.roughness.number(point);
        Principled {
            side,
            base_color: self.base_color.spectrum::<C>(point, wavelengths),
            luminance: self.base_color.number(point),
            facets: facets(roughness, self.anisotropic.number(point)),
            roughness,
            metallic,
            opaque: (1.0 - metallic) * (1.0 - spec_trans),
            glassy: (1.0 - metallic) * spec_trans,
            spec_tint: self.spec_tint.number(point),
            sheen: self.sheen.number(point),
            sheen_tint: self.sheen_tint.number(point),
            flatness: self.flatness.number(point),
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

fn can_be_positive(number: &FloatTexture) -> bool {
    !matches!(number, FloatTexture::Uniform(0.0))
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

/// A principled surface, seen from one side, at the wavelengths of one path.
#[derive(Clone, Copy, Debug)]
pub struct Principled<S> {
    side: Side,
    base_color: S,
    luminance: f32,
    facets: Microfacets,
    roughness: f32,
    metallic: f32,
    /// Share of the diffuse lobe and its company.
    opaque: f32,
    /// Share of the refracting lobe.
    glassy: f32,
    spec_tint: f32,
    sheen: f32,
    sheen_tint: f32,
    flatness: f32,
    clearcoat: f32,
    coat: CoatFacets,
    /// Index of refraction behind the surface over the one before it.
    eta: f32,
    sampling: SamplingRates,
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

    pub(in crate::scene::bsdfs) fn sample(&self, outgoing: Vec3, u: [f32; 3]) -> BsdfSample<S> {
        let place = [u[0], u[1]];
        let m = self.facets.sample(outgoing, place);
        let cos = outgoing.dot(m).clamp(0.0, 1.0);
        let interface = fresnel::dielectric(cos, self.eta);
        let probabilities = self.probabilities(interface.reflectance);
        let mut limit = probabilities.diffuse;
        let is_diffuse = u[2] < limit;
        limit += probabilities.clearcoat;
        let is_coat = u[2] < limit;
        limit += probabilities.refraction;
        let is_refracted = !is_coat && u[2] < limit;
        let incident = if is_diffuse {
            warp::cosine_hemisphere(place)
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
