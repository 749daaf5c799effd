//! `principled` and `principledthin`: artist-friendly mixtures of diffuse, metallic, glassy and coated surfaces.
//!
//! Burley 2012, "Physically Based Shading at Disney", and 2015, "Extending the Disney BRDF to a BSDF with Integrated Subsurface
//! Scattering", as Mitsuba has them. This file has the lobes that both share.

mod common;
mod solid;
mod solid_material;
mod thin;

pub use common::CommonParameters;
pub use solid::Principled;
pub use solid_material::PrincipledMaterial;
pub use thin::{PrincipledThin, PrincipledThinMaterial};

use std::f32::consts::{FRAC_1_PI, PI};

use glam::{Vec2, Vec3};

use super::microfacet::{Distribution, Microfacets};
use crate::functions::sin_cos_of_turn;
use crate::scene::error::SceneError;
use crate::scene::textures::{FloatTexture, TextureLoader};
use crate::scene::xml::Object;
use crate::spectrum::SpectrumArithmetic;

/// Facets that are never smoother than this.
const LEAST_ROUGHNESS: f32 = 0.001;

/// A parameter of the scene file that should be in [0, `most`].
fn share(
    object: &Object,
    textures: &mut TextureLoader,
    name: &'static str,
    default: f32,
    most: f32,
) -> Result<FloatTexture, SceneError> {
    let texture = textures.number(object, name, default)?;
    match texture {
        FloatTexture::Uniform(value) if !(0.0..=most).contains(&value) => {
            let message = format!("`{name}` is {value}; it must be from 0 to {most}");
            Err(object.parameter_error(name, message))
        }
        _ => Ok(texture),
    }
}

/// A parameter that says how often a lobe is sampled relative to the others.
fn sampling_rate(object: &Object, name: &'static str) -> Result<f32, SceneError> {
    let rate = object.float_or(name, 1.0)? as f32;
    if rate > 0.0 && rate.is_finite() {
        return Ok(rate);
    }
    let message = format!(
        "`{name}` is {rate}; a lobe that is never sampled would be lost, so it must be positive"
    );
    Err(object.parameter_error(name, message))
}

/// The facets of a `roughness` in [0, 1] that are stretched by `anisotropic` in [0, 1].
fn facets(roughness: f32, anisotropic: f32) -> Microfacets {
    let alpha = roughness * roughness;
    let aspect = (1.0 - 0.9 * anisotropic).sqrt();
    let alpha = Vec2::new(alpha / aspect, alpha * aspect).max(Vec2::splat(LEAST_ROUGHNESS));
    Microfacets::new(Distribution::Ggx, alpha, true)
}

/// The fifth power with which Schlick's Fresnel reflectance rises towards grazing.
#[inline]
fn schlick_weight(cos: f32) -> f32 {
    let m = (1.0 - cos).clamp(0.0, 1.0);
    (m * m) * (m * m) * m
}

/// Schlick's weight at an interface of relative index `eta`: for eta < 1 it goes by the refracted direction.
#[inline]
fn interface_weight(cos: f32, eta: f32) -> f32 {
    if eta > 1.0 {
        return schlick_weight(cos);
    }
    let cos_refracted_squared = 1.0 - (1.0 - cos * cos) / (eta * eta);
    schlick_weight(cos_refracted_squared.max(0.0).sqrt())
}

/// Schlick's Fresnel reflectance that is `normal` at normal incidence.
#[inline]
fn schlick<S: SpectrumArithmetic>(normal: S, weight: f32) -> S {
    normal * (1.0 - weight) + S::splat(weight)
}

/// The reflectance at normal incidence of a relative index.
#[inline]
fn normal_reflectance(eta: f32) -> f32 {
    let root = (eta - 1.0) / (eta + 1.0);
    root * root
}

/// A colour without its luminance; white where that is none.
#[inline]
fn tint<S: SpectrumArithmetic>(colour: S, luminance: f32) -> S {
    if luminance > 0.0 {
        colour / luminance
    } else {
        S::ONE
    }
}

/// What of the base colour is reflected diffusely, times the cosine, with retro-reflection and, by `flatness`, something like subsurface
/// scattering (Burley 2015, section 4.1); `half` is the unit half vector.
fn diffuse(outgoing: Vec3, incident: Vec3, half: Vec3, roughness: f32, flatness: f32) -> f32 {
    let (from, to) = (outgoing.z, incident.z.abs());
    let (weight_from, weight_to) = (schlick_weight(from), schlick_weight(to));
    let lambert = (1.0 - 0.5 * weight_from) * (1.0 - 0.5 * weight_to);
    let cos = half.dot(incident);
    let retro = 2.0 * roughness * cos * cos;
    let retro_reflection =
        retro * (weight_to + weight_from + weight_to * weight_from * (retro - 1.0));
    let flat = {
        let grazing = 0.5 * retro;
        let towards = |weight: f32| 1.0 + weight * (grazing - 1.0);
        let scattered = towards(weight_to) * towards(weight_from);
        1.25 * (scattered * (1.0 / (to + from) - 0.5) + 0.5)
    };
    let curved = lambert + retro_reflection;
    to * FRAC_1_PI * (curved + flatness * (flat - curved))
}

/// About the shares of light from `outgoing` that a white diffuse lobe reflects and that a sheen of strength 1 does.
fn diffuse_albedo(outgoing: Vec3) -> [f32; 2] {
    let weight = schlick_weight(outgoing.z);
    [1.0 - 0.5 * weight, 0.3 * weight]
}

/// The facets of the clear coat: Burley's generalised Trowbridge-Reitz distribution with exponent 1 (Burley 2012, appendix B.2).
#[derive(Clone, Copy, Debug)]
struct CoatFacets {
    alpha_squared: f32,
}

impl CoatFacets {
    /// The facets of a coat with `gloss` in [0, 1].
    fn new(gloss: f32) -> Self {
        let alpha = 0.1 + gloss * (0.001 - 0.1);
        Self {
            alpha_squared: alpha * alpha,
        }
    }

    /// The density of facets with the normal `m`.
    fn density(&self, m: Vec3) -> f32 {
        let alpha_squared = self.alpha_squared;
        let density = (alpha_squared - 1.0)
            / (PI * alpha_squared.ln() * (1.0 + (alpha_squared - 1.0) * m.z * m.z));
        if density * m.z > 1e-20 { density } else { 0.0 }
    }

    /// The density with which [`Self::sample`] draws `m`.
    fn pdf(&self, m: Vec3) -> f32 {
        self.density(m) * m.z.max(0.0)
    }

    fn sample(&self, u: [f32; 2]) -> Vec3 {
        let (sin_azimuth, cos_azimuth) = sin_cos_of_turn(u[0]);
        let cos_squared = (1.0 - self.alpha_squared.powf(1.0 - u[1])) / (1.0 - self.alpha_squared);
        let sin = (1.0 - cos_squared).max(0.0).sqrt();
        Vec3::new(
            cos_azimuth * sin,
            sin_azimuth * sin,
            cos_squared.max(0.0).sqrt(),
        )
    }

    /// The masking of both directions, with a roughness of its own.
    fn shadowing(outgoing: Vec3, incident: Vec3) -> f32 {
        const ALPHA: f32 = 0.25;
        let masking = |v: Vec3| {
            let tan_squared = (1.0 - v.z * v.z).max(0.0) / (v.z * v.z);
            2.0 / (1.0 + (1.0 + ALPHA * ALPHA * tan_squared).sqrt())
        };
        masking(outgoing) * masking(incident)
    }
}
