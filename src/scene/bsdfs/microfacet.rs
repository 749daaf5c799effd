//! Microfacet distributions: how the normals of a rough surface's facets are spread, and how facets hide each other.
//!
//! Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces"; visible normals after Heitz and d'Eon 2014,
//! "Importance Sampling Microfacet-Based BSDFs using the Distribution of Visible Normals", for Beckmann's distribution by the
//! numerical inversion of Jakob 2014, "An Improved Visible Normal Sampling Routine for the Beckmann Distribution", for GGX by
//! Heitz 2018, "Sampling the GGX Distribution of Visible Normals". All vectors are unit vectors in the local frame.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::DirectionNumbers;
use super::beckmann::{self, INVERSE_SQRT_PI};
use crate::functions::{erf, exp_of_negative, sin_cos_of_turn};
use crate::sampling::warp;

/// The smallest roughness: with less the density of a highlight leaves `f32`.
const LEAST_ROUGHNESS: f32 = 1e-4;

/// The kinds of distributions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Distribution {
    /// Beckmann's: that of Gaussian random surfaces.
    Beckmann,
    /// GGX, or Trowbridge and Reitz's, with longer tails.
    Ggx,
}

/// The facets of a rough surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Microfacets {
    distribution: Distribution,
    /// Roughness along local x and y.
    alpha: Vec2,
    /// Whether only normals are sampled that can be seen.
    visible: bool,
}

impl Microfacets {
    #[inline]
    pub fn new(distribution: Distribution, alpha: Vec2, visible: bool) -> Self {
        Self {
            distribution,
            alpha: alpha.max(Vec2::splat(LEAST_ROUGHNESS)),
            visible,
        }
    }

    /// The same with its roughness multiplied by `factor`.
    pub fn scaled(self, factor: f32) -> Self {
        Self::new(self.distribution, self.alpha * factor, self.visible)
    }

    /// Whether only normals are sampled that can be seen.
    pub fn samples_visible(&self) -> bool {
        self.visible
    }

    /// The exponent of the Phong lobe that is as wide (Walter et al. 2007, section 5.2).
    pub fn shininess(&self) -> f32 {
        (2.0 / (self.alpha.x * self.alpha.y) - 2.0).max(0.0)
    }

    /// About the cosine under which facets are seen from `outgoing`: more than the surface's towards grazing views, where the
    /// facets that are seen are those that lean towards the viewer.
    pub fn usual_cosine(&self, outgoing: Vec3) -> f32 {
        let slope = (self.alpha * Vec2::new(outgoing.x, outgoing.y)).length_squared();
        (outgoing.z * outgoing.z + slope).min(1.0).sqrt()
    }

    /// The density D of facets with the normal `m`, per solid angle and surface area.
    #[inline]
    pub fn density(&self, m: Vec3) -> f32 {
        let slope = (Vec2::new(m.x, m.y) / self.alpha).length_squared();
        let cos_squared = m.z * m.z;
        let area = PI * self.alpha.x * self.alpha.y;
        let density = match self.distribution {
            Distribution::Beckmann => {
                exp_of_negative(-slope / cos_squared) / (area * cos_squared * cos_squared)
            }
            Distribution::Ggx => {
                let sum = slope + cos_squared;
                1.0 / (area * sum * sum)
            }
        };
        // What is smaller only makes trouble in quotients. Not-a-number, at the horizon, compares false.
        if density * m.z > 1e-20 { density } else { 0.0 }
    }

    /// Smith's masking G1: the visible share, seen from `v`, of facets with the normal `m`. Beckmann's is the rational fit of
    /// Walter et al. 2007, equation 27, within 0.35 % of the exact one.
    #[inline]
    pub fn masking(&self, v: Vec3, m: Vec3) -> f32 {
        // The back of a facet is not seen from the front of the surface, nor the other way around.
        if v.dot(m) * v.z <= 0.0 {
            return 0.0;
        }
        let tan_squared = self.tan_squared(v);
        match self.distribution {
            _ if tan_squared == 0.0 => 1.0,
            Distribution::Beckmann => {
                let a = 1.0 / tan_squared.sqrt();
                if a >= 1.6 {
                    return 1.0;
                }
                (3.535 + 2.181 * a) * a / (1.0 + (2.276 + 2.577 * a) * a)
            }
            Distribution::Ggx => 2.0 / (1.0 + (1.0 + tan_squared).sqrt()),
        }
    }

    /// Masking of both directions, taken as independent.
    #[inline]
    pub fn shadowing(&self, outgoing: Vec3, incident: Vec3, m: Vec3) -> f32 {
        self.masking(outgoing, m) * self.masking(incident, m)
    }

    /// The density with which [`Self::sample`] draws `m`, per solid angle of facet normals.
    #[inline]
    pub fn pdf(&self, outgoing: Vec3, m: Vec3) -> f32 {
        self.pdf_of(self.density(m), outgoing, m)
    }

    /// The same where the [`density`](Self::density) of facets with that normal is known.
    #[inline]
    pub fn pdf_of(&self, density: f32, outgoing: Vec3, m: Vec3) -> f32 {
        if !self.visible {
            return density * m.z.max(0.0);
        }
        let toward = outgoing.dot(m);
        if toward <= 0.0 {
            return 0.0;
        }
        density * self.exact_masking(outgoing) * toward / outgoing.z
    }

    /// See [`Bsdf::slope_view`](super::Bsdf::slope_view).
    #[inline]
    pub fn slope_view(&self, outgoing: Vec3) -> Option<f32> {
        let searches = self.visible && self.distribution == Distribution::Beckmann;
        searches.then(|| self.stretched(outgoing).z)
    }

    /// Draws the normal of a facet seen from `outgoing` (z > 0) by what is not for choosing among the `numbers`.
    #[inline]
    pub fn sample_by(&self, outgoing: Vec3, numbers: &DirectionNumbers) -> Vec3 {
        match numbers.slope {
            Some(slope) => self.with_slope(self.stretched(outgoing), slope),
            None => self.sample(outgoing, numbers.square),
        }
    }

    /// Draws the normal of a facet seen from `outgoing` (z > 0) from the uniform numbers `u` in [0, 1).
    #[inline]
    pub fn sample(&self, outgoing: Vec3, u: [f32; 2]) -> Vec3 {
        if !self.visible {
            return self.sample_all(u);
        }
        let stretched = self.stretched(outgoing);
        let slope = match self.distribution {
            Distribution::Beckmann => beckmann::slope_seen(stretched.z, u),
            Distribution::Ggx => ggx_slope_seen(stretched.z, u),
        };
        self.with_slope(stretched, slope)
    }

    /// The direction from which a surface is seen that was stretched to roughness 1, seen before from `outgoing`.
    #[inline]
    fn stretched(&self, outgoing: Vec3) -> Vec3 {
        let Vec3 { x, y, z } = outgoing;
        let stretched = Vec3::new(self.alpha.x * x, self.alpha.y * y, z).normalize();
        stretched.with_z(stretched.z.min(1.0))
    }

    /// The normal of a facet that has this slope along and across the direction from which it is seen, once it has been
    /// [stretched](Self::stretched).
    #[inline]
    fn with_slope(&self, stretched: Vec3, slope: Vec2) -> Vec3 {
        let azimuth = Vec2::new(stretched.x, stretched.y)
            .try_normalize()
            .unwrap_or(Vec2::X);
        let slope = azimuth.rotate(slope) * self.alpha;
        Vec3::new(-slope.x, -slope.y, 1.0).normalize()
    }

    /// Draws the normal of a facet, seen or not, with the density D cos.
    fn sample_all(&self, u: [f32; 2]) -> Vec3 {
        let (sin, cos) = sin_cos_of_turn(u[1]);
        let azimuth = (self.alpha * Vec2::new(cos, sin)).normalize();
        let alpha_squared = 1.0 / (azimuth / self.alpha).length_squared();
        let tan_squared = match self.distribution {
            Distribution::Beckmann => -alpha_squared * (-u[0]).ln_1p(),
            Distribution::Ggx => alpha_squared * u[0] / (1.0 - u[0]),
        };
        let cos = 1.0 / (1.0 + tan_squared).sqrt();
        let sin = (1.0 - cos * cos).max(0.0).sqrt();
        Vec3::new(azimuth.x * sin, azimuth.y * sin, cos)
    }

    /// The squared tangent of `v`'s angle to the normal, times the squared roughness in its direction.
    #[inline]
    fn tan_squared(&self, v: Vec3) -> f32 {
        (self.alpha * Vec2::new(v.x, v.y)).length_squared() / (v.z * v.z)
    }

    /// G1 without approximation, which the density of the visible normals is normalised by.
    #[inline]
    fn exact_masking(&self, v: Vec3) -> f32 {
        let tan_squared = self.tan_squared(v);
        if tan_squared == 0.0 {
            return 1.0;
        }
        match self.distribution {
            Distribution::Beckmann => {
                let a = 1.0 / tan_squared.sqrt();
                2.0 / (1.0 + erf(a) + INVERSE_SQRT_PI * exp_of_negative(-a * a) / a)
            }
            Distribution::Ggx => 2.0 / (1.0 + (1.0 + tan_squared).sqrt()),
        }
    }
}

/// A slope of a GGX surface of roughness 1 seen from the cosine `cos`, along the view's azimuth and across.
fn ggx_slope_seen(cos: f32, u: [f32; 2]) -> Vec2 {
    let mut p = warp::disk(u);
    // The half of the disk that faces away is compressed by the projection.
    let s = 0.5 * (1.0 + cos);
    let edge = (1.0 - p.x * p.x).max(0.0).sqrt();
    p.y = edge + s * (p.y - edge);
    let z = (1.0 - p.length_squared()).max(0.0).sqrt();
    let sin = (1.0 - cos * cos).max(0.0).sqrt();
    Vec2::new(cos * p.y - sin * z, p.x) / (sin * p.y + cos * z)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The projected area of the facets is that of the surface: the integral of D cos over normals is 1, and that of the
    /// visible normals' density too.
    #[test]
    fn densities_integrate_to_one() {
        for distribution in [Distribution::Beckmann, Distribution::Ggx] {
            for alpha in [
                Vec2::new(0.2, 0.2),
                Vec2::new(0.1, 0.5),
                Vec2::new(0.9, 0.6),
            ] {
                for visible in [false, true] {
                    let facets = Microfacets::new(distribution, alpha, visible);
                    let outgoing = Vec3::new(0.6, -0.3, 0.4).normalize();
                    let (steps, mut sum) = (1000, 0.0);
                    for i in 0..steps {
                        for j in 0..steps {
                            // Stretched so that the peak is met often enough.
                            let t = (i as f32 + 0.5) / steps as f32;
                            let theta = 0.5 * PI * t * t;
                            let phi = 2.0 * PI * (j as f32 + 0.5) / steps as f32;
                            let (sin, cos) = theta.sin_cos();
                            let m = Vec3::new(sin * phi.cos(), sin * phi.sin(), cos);
                            sum += f64::from(facets.pdf(outgoing, m) * sin * PI * t)
                                * 2.0
                                * std::f64::consts::PI
                                / f64::from(steps * steps);
                        }
                    }
                    assert!((sum - 1.0).abs() < 2e-3, "{facets:?} {sum}");
                }
            }
        }
    }

    #[test]
    fn the_fitted_masking_is_close_to_the_exact_one() {
        let facets = Microfacets::new(Distribution::Beckmann, Vec2::splat(0.7), true);
        for i in 1..1000 {
            let cos = i as f32 / 1000.0;
            let v = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
            let (fitted, exact) = (facets.masking(v, Vec3::Z), facets.exact_masking(v));
            assert!(
                (fitted / exact - 1.0).abs() < 3.6e-3,
                "{cos}: {fitted} {exact}"
            );
        }
    }
}
