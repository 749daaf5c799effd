//! What was learned guides the directions of a chunk of children, and their densities.
//!
//! Where a surface is diffuse, directions are drawn from a warped square alone. Other smooth lobes are mixed with it: one of the two
//! draws the direction, and the density is that of the mixture (one-sample MIS, balance heuristic). Discrete lobes are left alone.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::variant::Scattering;
use crate::lanes::{CHUNK, VectorLanes};
use crate::learning::{Bin, Insight, Knowledge};
use crate::sampling::warp;
use crate::scene::{BsdfSamples, BsdfValues};
use crate::spectrum::SpectrumArithmetic;

/// What is known in each lane.
pub(super) struct Guidance<'k> {
    insights: [Option<&'k Insight>; CHUNK],
    /// The density of the point to which each was warped.
    density: [f32; CHUNK],
    /// Which lanes draw from the warped square though it is mixed with lobes.
    is_redirected: [bool; CHUNK],
}

impl<'k> Guidance<'k> {
    /// Nothing is known.
    pub fn new() -> Self {
        Self {
            insights: [None; CHUNK],
            density: [1.0; CHUNK],
            is_redirected: [false; CHUNK],
        }
    }

    /// Asks for what is known at the `addresses` of at most [`CHUNK`] vertices.
    #[inline(always)]
    pub fn ask(&mut self, knowledge: &'k Knowledge, addresses: impl Iterator<Item = u32>) {
        for (insight, address) in self.insights.iter_mut().zip(addresses) {
            *insight = knowledge.insight(address);
        }
    }

    /// Corrects the densities with which the `vertices` draw `directions`.
    #[inline(always)]
    pub fn mix<S: SpectrumArithmetic, V: Scattering<S>>(
        &self,
        vertices: &[V],
        normals: &VectorLanes<CHUNK>,
        directions: &VectorLanes<CHUNK>,
        values: &mut BsdfValues<S>,
    ) {
        for (lane, vertex) in vertices.iter().enumerate() {
            if let Some(insight) = self.insights[lane] {
                let share = vertex.guided_share();
                let local = vertex
                    .frame(normals.get(lane))
                    .to_local(directions.get(lane));
                values.pdf[lane] = mixed_pdf(share, guided_pdf(insight, local), values.pdf[lane]);
            }
        }
    }

    /// Warps the uniform `numbers` with which at most [`CHUNK`] `vertices` are about to draw directions.
    #[inline(always)]
    pub fn warp<'a, S: SpectrumArithmetic, V: Scattering<S>>(
        &mut self,
        vertices: impl Iterator<Item = &'a V>,
        numbers: &mut [[f32; CHUNK]; 3],
    ) {
        for (lane, vertex) in vertices.enumerate() {
            let Some(insight) = self.insights[lane] else {
                continue;
            };
            let share = vertex.guided_share();
            let [u, v, choice] = numbers.each_mut().map(|numbers| &mut numbers[lane]);
            // Where it is mixed, one number decides who draws, and what is left of it chooses the lobe.
            let is_drawn_from_square = share >= 1.0 || *choice < share;
            self.is_redirected[lane] = is_drawn_from_square && share < 1.0;
            if is_drawn_from_square {
                let (point, density) = insight.warp.warp([*u, *v]);
                [*u, *v] = point;
                self.density[lane] = density;
            } else {
                *choice = ((*choice - share) / (1.0 - share)).clamp(0.0, 1.0 - f32::EPSILON);
            }
        }
    }

    /// Makes the directions that at most [`CHUNK`] `vertices` drew with the warped `numbers` those of the mixture.
    #[inline(always)]
    pub fn redirect<'a, S: SpectrumArithmetic, V: Scattering<S>>(
        &self,
        vertices: impl Iterator<Item = &'a V>,
        normals: &VectorLanes<CHUNK>,
        numbers: &[[f32; CHUNK]; 3],
        samples: &mut BsdfSamples<S>,
    ) {
        for (lane, vertex) in vertices.enumerate() {
            let Some(insight) = self.insights[lane] else {
                continue;
            };
            let share = vertex.guided_share();
            if share >= 1.0 {
                samples.pdf[lane] *= self.density[lane];
                samples.weight[lane] *= 1.0 / self.density[lane];
            } else if self.is_redirected[lane] {
                let local = warp::cosine_hemisphere([numbers[0][lane], numbers[1][lane]]);
                vertex.look(lane, normals.get(lane), local, samples);
                let guided = self.density[lane] * local.z * FRAC_1_PI;
                let pdf = mixed_pdf(share, guided, samples.pdf[lane]);
                // So far the weight is the value itself.
                samples.weight[lane] *= 1.0 / pdf;
                samples.pdf[lane] = pdf;
            } else if share > 0.0 {
                let pdf = samples.pdf[lane];
                if pdf == f32::INFINITY {
                    samples.weight[lane] *= 1.0 / (1.0 - share);
                    continue;
                }
                let direction = samples.direction.get(lane);
                let local = vertex.frame(normals.get(lane)).to_local(direction);
                let mixed = mixed_pdf(share, guided_pdf(insight, local), pdf);
                let is_drawn = pdf > 0.0 && mixed > 0.0;
                samples.weight[lane] *= if is_drawn { pdf / mixed } else { 0.0 };
                samples.pdf[lane] = mixed;
            }
        }
    }
}

/// The density over solid angle with which the warped square gives `local`, a unit direction in the frame of the vertex.
#[inline(always)]
fn guided_pdf(insight: &Insight, local: Vec3) -> f32 {
    match bin(local) {
        Some(bin) => insight.warp.density(bin) * local.z * FRAC_1_PI,
        None => 0.0,
    }
}

/// The part of the square that gives `local`, a unit direction in the frame of a vertex; nothing gives those below the surface.
#[inline(always)]
pub(super) fn bin(local: Vec3) -> Option<Bin> {
    (local.z > 0.0).then(|| Bin::of(warp::cosine_hemisphere_inverse(local)))
}

/// The density of a mixture with that `share` of guided directions.
#[inline(always)]
fn mixed_pdf(share: f32, guided: f32, pdf: f32) -> f32 {
    if share >= 1.0 {
        guided
    } else {
        share * guided + (1.0 - share) * pdf
    }
}
