//! Spectra for linear sRGB colours: Jakob and Hanika 2019, "A low-dimensional function space for efficient
//! spectral upsampling".
//!
//! The space of section 3: S(λ) = σ(c₀λ² + c₁λ + c₂) with σ(x) = 1/2 + x / (2√(1 + x²)), always a valid
//! reflectance. Instead of the paper's precomputed table, the coefficients of each colour of a scene are fitted
//! when it is loaded, by damped Gauss-Newton steps along the straight way from a grey to the colour.

use super::cie::{STEP, WAVELENGTH_MAX, WAVELENGTH_MIN, illuminant_d65, matching_srgb};
use glam::{DMat3, DVec3, Vec3};
use std::sync::LazyLock;

/// A smooth reflectance: the sigmoid of a quadratic polynomial.
///
/// The polynomial is one in the wavelength scaled to [-1, 1], which keeps it accurate in `f32`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SigmoidPolynomial {
    /// Coefficients from the square to the constant.
    coefficients: [f32; 3],
}

/// Middle of the wavelengths, in nm.
const CENTRE: f32 = 0.5 * (WAVELENGTH_MIN + WAVELENGTH_MAX);
/// Reciprocal of half the range of the wavelengths, per nm.
const PER_HALF_RANGE: f32 = 2.0 / (WAVELENGTH_MAX - WAVELENGTH_MIN);

impl SigmoidPolynomial {
    /// The reflectance whose colour under D65 is `rgb`, linear sRGB with components in [0, 1].
    pub(super) fn fit(rgb: [f32; 3]) -> Self {
        let target = DVec3::from_array(rgb.map(f64::from));
        let coefficients = fit(target).as_vec3().to_array();
        Self { coefficients }
    }

    /// The reflectance whose colour under D65 is `rgb`, sought from this one, whose colour is near.
    pub(super) fn refit(self, rgb: [f32; 3]) -> Self {
        const ITERATIONS: u32 = 20;
        let start = DVec3::from_array(self.coefficients.map(f64::from));
        let target = DVec3::from_array(rgb.map(f64::from));
        let coefficients = levenberg_marquardt(&QUADRATURE, start, target, ITERATIONS);
        Self {
            coefficients: coefficients.as_vec3().to_array(),
        }
    }

    /// The polynomial between four at the corners of a square: upper left, upper right, lower left, lower right.
    pub(super) fn mix(corners: [Self; 4], across: f32, down: f32) -> Self {
        let [c00, c10, c01, c11] = corners.map(|corner| Vec3::from(corner.coefficients));
        let coefficients = c00.lerp(c10, across).lerp(c01.lerp(c11, across), down);
        Self {
            coefficients: coefficients.to_array(),
        }
    }

    /// As [`Self::fit`], an order of magnitude faster and to about 3e-4 of the colour's greatest component: for the many colours of
    /// an image. `rgb` is limited to [0, 1].
    pub(super) fn fit_quickly(rgb: [f32; 3]) -> Self {
        const ENOUGH: f64 = 3e-4;
        let rgb = rgb.map(|channel| channel.clamp(0.0, 1.0));
        let target = DVec3::from_array(rgb.map(f64::from));
        let start = grey(target);
        if is_grey(target) {
            let coefficients = start.as_vec3().to_array();
            return Self { coefficients };
        }
        let nodes = &COARSE_QUADRATURE;
        let coefficients = levenberg_marquardt(nodes, start, target, 60);
        let (colour, _) = colour_and_derivatives(nodes, coefficients);
        if (colour - target).length() < ENOUGH * target.max_element() {
            let coefficients = coefficients.as_vec3().to_array();
            return Self { coefficients };
        }
        Self::fit(rgb)
    }

    /// The reflectance at the wavelength `nm`, in [0, 1].
    #[inline]
    pub(super) fn at(&self, nm: f32) -> f32 {
        let [c0, c1, c2] = self.coefficients;
        let t = (nm - CENTRE) * PER_HALF_RANGE;
        let x = (c0 * t + c1) * t + c2;
        0.5 + 0.5 * x / (1.0 + x * x).sqrt()
    }
}

/// One point of the quadrature over the wavelength.
struct Node {
    /// Wavelength scaled to [-1, 1].
    t: f64,
    /// Contribution of a reflectance of 1 at this point to the linear sRGB colour under D65.
    weight: DVec3,
}

/// Simpson's rule on quarters of the CIE's intervals (on which the weights are quadratic), scaled so that the
/// perfect white is exactly (1, 1, 1): a grey colour then has a constant reflectance.
static QUADRATURE: LazyLock<Vec<Node>> = LazyLock::new(|| quadrature(4));

/// The same on whole intervals.
static COARSE_QUADRATURE: LazyLock<Vec<Node>> = LazyLock::new(|| quadrature(1));

/// Simpson's rule on `pieces_per_step` pieces of each of the CIE's intervals.
fn quadrature(pieces_per_step: usize) -> Vec<Node> {
    let piece = STEP / pieces_per_step as f32;
    let pieces = ((WAVELENGTH_MAX - WAVELENGTH_MIN) / piece) as usize;
    let mut nodes: Vec<Node> = (0..=2 * pieces)
        .map(|i| {
            let nm = WAVELENGTH_MIN + 0.5 * piece * i as f32;
            let simpson = match i {
                0 => 1.0,
                _ if i == 2 * pieces => 1.0,
                _ if i % 2 == 1 => 4.0,
                _ => 2.0,
            };
            let matching = DVec3::from_array(matching_srgb(nm).map(f64::from));
            Node {
                t: f64::from((nm - CENTRE) * PER_HALF_RANGE),
                weight: matching * f64::from(illuminant_d65(nm)) * simpson,
            }
        })
        .collect();
    let white: DVec3 = nodes.iter().map(|node| node.weight).sum();
    for node in &mut nodes {
        node.weight /= white;
    }
    nodes
}

/// Linear sRGB under D65 of the sigmoid of the polynomial with the given coefficients, and its derivatives by
/// the coefficients (one column each).
fn colour_and_derivatives(nodes: &[Node], coefficients: DVec3) -> (DVec3, DMat3) {
    let mut colour = DVec3::ZERO;
    let mut derivatives = DMat3::ZERO;
    for node in nodes {
        let x = (coefficients.x * node.t + coefficients.y) * node.t + coefficients.z;
        let root = (1.0 + x * x).sqrt();
        colour += node.weight * (0.5 + 0.5 * x / root);
        let slope = node.weight * (0.5 / (root * root * root));
        derivatives.x_axis += slope * (node.t * node.t);
        derivatives.y_axis += slope * node.t;
        derivatives.z_axis += slope;
    }
    (colour, derivatives)
}

/// The mean of the components of `target`. Black and white are limits of the space: the nearest that `f32` can tell from them.
fn mean(target: DVec3) -> f64 {
    (target.element_sum() / 3.0).clamp(1e-7, 1.0 - 1e-7)
}

/// The coefficients of the grey that is as bright as `target`: σ(x) = grey solved for x.
fn grey(target: DVec3) -> DVec3 {
    let grey = mean(target);
    DVec3::new(0.0, 0.0, (grey - 0.5) / (grey * (1.0 - grey)).sqrt())
}

fn is_grey(target: DVec3) -> bool {
    target.max_element() - target.min_element() < 1e-7
}

/// The coefficients for the colour `target`.
fn fit(target: DVec3) -> DVec3 {
    const STEPS: u32 = 16;
    let mut coefficients = grey(target);
    if is_grey(target) {
        return coefficients;
    }
    let grey = mean(target);
    for step in 1..=STEPS {
        let towards = DVec3::splat(grey).lerp(target, f64::from(step) / f64::from(STEPS));
        let iterations = if step == STEPS { 200 } else { 10 };
        coefficients = levenberg_marquardt(&QUADRATURE, coefficients, towards, iterations);
    }
    coefficients
}

/// Improves `coefficients` by at most `iterations` damped Gauss-Newton steps towards the colour `target`.
///
/// The residual is relative to the colour's greatest component, so that dark colours are met as well as bright.
fn levenberg_marquardt(
    nodes: &[Node],
    mut coefficients: DVec3,
    target: DVec3,
    iterations: u32,
) -> DVec3 {
    const ACCURACY: f64 = 1e-7;
    let scale = 1.0 / target.max_element();
    let mut damping = 1e-4;
    let (colour, mut derivatives) = colour_and_derivatives(nodes, coefficients);
    let mut residual = (colour - target) * scale;
    for _ in 0..iterations {
        if residual.length() < ACCURACY {
            break;
        }
        let jacobian = derivatives * scale;
        let normal = jacobian.transpose() * jacobian;
        let diagonal = DVec3::new(normal.x_axis.x, normal.y_axis.y, normal.z_axis.z);
        let damped = normal + DMat3::from_diagonal(diagonal * damping + DVec3::splat(1e-18));
        let candidate = coefficients - damped.inverse() * (jacobian.transpose() * residual);
        let (colour, candidate_derivatives) = colour_and_derivatives(nodes, candidate);
        let candidate_residual = (colour - target) * scale;
        // A step that is not a number compares false and is rejected.
        if candidate_residual.length() < residual.length() {
            (coefficients, derivatives, residual) =
                (candidate, candidate_derivatives, candidate_residual);
            damping = (damping * 0.2).max(1e-12);
        } else {
            damping = (damping * 8.0).min(1e12);
        }
    }
    coefficients
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Linear sRGB under D65, normalised to a white of (1, 1, 1), of what `at` evaluates (in `f32`).
    fn colour(reflectance: &SigmoidPolynomial) -> [f64; 3] {
        let value = |t: f64| f64::from(reflectance.at(CENTRE + (t as f32) / PER_HALF_RANGE));
        QUADRATURE
            .iter()
            .map(|node| node.weight * value(node.t))
            .sum::<DVec3>()
            .to_array()
    }

    #[track_caller]
    fn assert_round_trip(rgb: [f32; 3]) {
        let reflectance = SigmoidPolynomial::fit(rgb);
        for (channel, back) in rgb.into_iter().zip(colour(&reflectance)) {
            assert!(
                (f64::from(channel) - back).abs() < 1e-3,
                "{rgb:?} -> {:?}",
                colour(&reflectance)
            );
        }
    }

    #[test]
    fn a_grid_of_colours_comes_back() {
        let levels = [0.0, 1e-3, 0.02, 0.2, 0.5, 0.8, 0.98, 1.0];
        for r in levels {
            for g in levels {
                for b in levels {
                    assert_round_trip([r, g, b]);
                }
            }
        }
    }

    #[test]
    fn the_quick_fit_is_close() {
        let levels = [0.0, 1e-2, 0.1, 0.3, 0.6, 0.9, 1.0];
        for r in levels {
            for g in levels {
                for b in levels {
                    let back = colour(&SigmoidPolynomial::fit_quickly([r, g, b]));
                    for (channel, back) in [r, g, b].into_iter().zip(back) {
                        assert!(
                            (f64::from(channel) - back).abs() < 2e-3,
                            "{r} {g} {b} -> {back}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn dark_colours_keep_their_hue() {
        for rgb in [[1e-3, 3e-4, 2e-4], [2e-4, 1e-3, 5e-4], [1e-4, 2e-4, 1e-3]] {
            for (channel, back) in rgb.into_iter().zip(colour(&SigmoidPolynomial::fit(rgb))) {
                assert!(
                    (back / f64::from(channel) - 1.0).abs() < 5e-3,
                    "{rgb:?}: {back} for {channel}"
                );
            }
        }
    }

    #[test]
    fn greys_are_constant() {
        for grey in [0.0, 1e-4, 0.18, 0.5, 0.9, 1.0] {
            let reflectance = SigmoidPolynomial::fit([grey; 3]);
            for nm in [360.0, 500.0, 830.0] {
                assert!(
                    (reflectance.at(nm) - grey).abs() < 1e-6,
                    "{grey}: {}",
                    reflectance.at(nm)
                );
            }
        }
    }
}
