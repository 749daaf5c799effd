//! What gets through a rough dielectric coating: the table that `roughplastic` is evaluated with.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use glam::{Vec2, Vec3};
use multiversion::multiversion;

use super::beckmann::SlopeLanes;
use super::microfacet::{Distribution, Microfacets};
use super::{DirectionNumbers, fresnel};
use crate::lanes::CHUNK;

/// Entries of the table.
const ENTRIES: usize = 64;

/// Transmittance and internal reflectance of a rough coating, as Mitsuba computes them.
#[derive(Debug)]
pub(super) struct RoughCoating {
    /// The share of the light that gets through from outside, at cosines spread evenly from 0 to 1.
    transmittance: [f32; ENTRIES],
    /// The share of diffuse light from inside that is reflected.
    pub internal_reflectance: f32,
}

/// The coatings computed so far, by distribution and the bits of roughness and index.
type Known = BTreeMap<(bool, u32, u32), &'static RoughCoating>;

impl RoughCoating {
    /// The coating of relative index `eta`. What was computed is kept for good, so that the bsdfs of paths can be plain copies: a
    /// few hundred bytes for each different coating.
    pub fn of(distribution: Distribution, alpha: f32, eta: f32) -> &'static Self {
        static KNOWN: Mutex<Known> = Mutex::new(BTreeMap::new());
        let key = (
            distribution == Distribution::Ggx,
            alpha.to_bits(),
            eta.to_bits(),
        );
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        known.entry(key).or_insert_with(|| {
            let facets = Microfacets::new(distribution, Vec2::splat(alpha), true);
            Box::leak(Box::new(Self::compute(&facets, eta)))
        })
    }

    fn compute(facets: &Microfacets, eta: f32) -> Self {
        let cosines: [f32; ENTRIES] =
            std::array::from_fn(|i| (i as f32 / (ENTRIES - 1) as f32).max(1e-6));
        let (outer, inner) = (gauss_legendre(nodes(eta)), gauss_legendre(nodes(1.0 / eta)));
        let reflected = cosines.map(|cos| cos * scattered(facets, 1.0 / eta, cos, &inner, true));
        Self {
            transmittance: cosines.map(|cos| scattered(facets, eta, cos, &outer, false)),
            internal_reflectance: 2.0 * reflected.iter().sum::<f32>() / ENTRIES as f32,
        }
    }

    /// The share of the light that gets through from outside at the cosine `cos` in [0, 1].
    #[inline]
    pub fn transmittance(&self, cos: f32) -> f32 {
        let position = cos * (ENTRIES - 1) as f32;
        let entry = (position as usize).min(ENTRIES - 2);
        let (before, after) = (self.transmittance[entry], self.transmittance[entry + 1]);
        before + (position - entry as f32) * (after - before)
    }
}

/// How many nodes the quadrature has in each dimension: more where total reflection makes a discontinuity.
fn nodes(eta: f32) -> usize {
    if eta > 1.0 { 32 } else { 128 }
}

/// The share of the light from the cosine `cos` that is reflected, or else refracted, by quadrature over the facets seen.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
fn scattered(
    facets: &Microfacets,
    eta: f32,
    cos: f32,
    quadrature: &[Node],
    reflected: bool,
) -> f32 {
    let outgoing = Vec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
    let view = facets.slope_view(outgoing);
    let mut sum = 0.0;
    for (across, along) in quadrature
        .iter()
        .flat_map(|across| quadrature.chunks(CHUNK).map(move |along| (across, along)))
    {
        let mut slopes = SlopeLanes::new();
        if let Some(view) = view {
            for (lane, along) in along.iter().enumerate() {
                slopes.ask(lane, view, [along.at, across.at]);
            }
            slopes.find();
        }
        for (lane, along) in along.iter().enumerate() {
            let numbers = DirectionNumbers::new([along.at, across.at, 0.0]);
            let m = facets.sample_by(outgoing, &numbers.with_slope(slopes.get(lane)));
            let toward = outgoing.dot(m);
            let interface = fresnel::dielectric(toward.clamp(0.0, 1.0), eta);
            let (incident, share) = if reflected {
                (fresnel::reflect(outgoing, m), interface.reflectance)
            } else {
                let incident = fresnel::refract(outgoing, m, interface.cos_refracted, eta);
                (incident, 1.0 - interface.reflectance)
            };
            if (incident.z > 0.0) == reflected && incident.z != 0.0 {
                sum += along.weight * across.weight * share * facets.masking(incident, m);
            }
        }
    }
    sum
}

/// A node of a quadrature over [0, 1], whose weights add up to 1.
struct Node {
    at: f32,
    weight: f32,
}

/// The Gauss-Legendre quadrature with `count` nodes (Press et al., Numerical Recipes, section 4.6).
fn gauss_legendre(count: usize) -> Vec<Node> {
    let degree = count as f64;
    let node = |index: usize| {
        let mut x = ((index as f64 + 0.75) / (degree + 0.5) * std::f64::consts::PI).cos();
        let mut derivative = 1.0;
        for _ in 0..20 {
            // Legendre's polynomials of the degrees below and at `count`.
            let (mut below, mut value) = (0.0, 1.0);
            for k in 0..count {
                let k = k as f64;
                (below, value) = (value, ((2.0 * k + 1.0) * x * value - k * below) / (k + 1.0));
            }
            derivative = degree * (x * value - below) / (x * x - 1.0);
            x -= value / derivative;
        }
        Node {
            at: (0.5 - 0.5 * x) as f32,
            weight: (1.0 / ((1.0 - x * x) * derivative * derivative)) as f32,
        }
    };
    (0..count).map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_quadrature_is_exact_for_polynomials() {
        for count in [4, 32, 128] {
            let nodes = gauss_legendre(count);
            for power in 0..2 * count.min(20) as i32 {
                let integral: f64 = nodes
                    .iter()
                    .map(|node| f64::from(node.weight) * f64::from(node.at).powi(power))
                    .sum();
                assert!(
                    (integral * f64::from(power + 1) - 1.0).abs() < 1e-5,
                    "{count} {power}"
                );
            }
        }
    }

    #[test]
    fn a_smooth_coating_is_fresnels() {
        let coating = RoughCoating::of(Distribution::Ggx, 1e-4, 1.5);
        for i in 8..ENTRIES {
            let cos = i as f32 / (ENTRIES - 1) as f32;
            let smooth = 1.0 - fresnel::dielectric(cos, 1.5).reflectance;
            assert!((coating.transmittance(cos) - smooth).abs() < 1e-3, "{cos}");
        }
        let diffuse = fresnel::diffuse_reflectance(1.0 / 1.5);
        assert!((coating.internal_reflectance - diffuse).abs() < 2e-2);
    }
}
