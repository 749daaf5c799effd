//! What was learned guides the directions of a chunk of children, and their densities.
//!
//! Where a surface is diffuse, directions are drawn from a warped square alone. Other smooth lobes are mixed with it: one of the two
//! draws the direction, and the density is that of the mixture (one-sample MIS, balance heuristic). Discrete lobes are left alone.

use std::f32::consts::FRAC_1_PI;

use glam::Vec3;

use super::variant::{Guiding, Scattering};
use crate::lanes::{CHUNK, VectorLanes};
use crate::learning::{Bin, Knowledge, MixedDirection, Odds, SquareWarp};
use crate::sampling::{Frame, warp};
use crate::scene::{BsdfSamples, BsdfValues};
use crate::spectrum::SpectrumArithmetic;

/// What is known in each lane.
pub(super) struct Guidance<'k> {
    warps: [&'k SquareWarp; CHUNK],
    /// The share of directions that are drawn from the warped square.
    share: [f32; CHUNK],
    /// Where they are mixed with the surface's own: the part of a [`GuidedShare`](crate::learning::GuidedShare) that the surface makes use of.
    reach: [f32; CHUNK],
    /// The density of the point to which each was warped.
    density: [f32; CHUNK],
    /// Which lanes draw from the warped square though it is mixed with lobes.
    is_redirected: [bool; CHUNK],
}

impl<'k> Guidance<'k> {
    /// Nothing is known.
    pub fn new() -> Self {
        Self {
            warps: [&SquareWarp::UNIFORM; CHUNK],
            share: [0.0; CHUNK],
            reach: [0.0; CHUNK],
            density: [1.0; CHUNK],
            is_redirected: [false; CHUNK],
        }
    }

    /// Asks for what is known at at most [`CHUNK`] `vertices`, with the numbers of their insights. Returns whether any of them is guided: without,
    /// there is nothing to correct.
    ///
    /// Insights lie scattered in memory, and no jump depends on them, so that they are fetched side by side.
    #[inline(always)]
    pub fn ask<'a, S: SpectrumArithmetic, V: Scattering<S>>(
        &mut self,
        knowledge: &'k Knowledge,
        vertices: impl Iterator<Item = (&'a V, u32)>,
    ) -> bool {
        let mut is_any_guided = false;
        for (lane, (vertex, number)) in (0..CHUNK).zip(vertices) {
            let insight = knowledge.insight(number);
            let (share, reach) = match vertex.guiding() {
                Guiding::None => (0.0, 0.0),
                Guiding::Mixed(reach) => (reach * insight.mixed_share.value(), reach),
                Guiding::Alone => (1.0, 0.0),
            };
            let [share, reach] = [share, reach].map(|part| if insight.guides { part } else { 0.0 });
            self.share[lane] = share;
            self.reach[lane] = reach;
            self.warps[lane] = &insight.warp;
            is_any_guided |= share > 0.0;
        }
        is_any_guided
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
        let places = SquarePlaces::of(normals, directions);
        for lane in 0..vertices.len().min(CHUNK) {
            let guided = guided_pdf(self.warps[lane], places.bins[lane], places.cosines[lane]);
            values.pdf[lane] = mixed_pdf(self.share[lane], guided, values.pdf[lane]);
        }
    }

    /// Warps the uniform `numbers` with which the first `count` vertices are about to draw directions.
    #[inline(always)]
    pub fn warp(&mut self, count: usize, numbers: &mut [[f32; CHUNK]; 3]) {
        for lane in 0..count.min(CHUNK) {
            let share = self.share[lane];
            let [u, v, choice] = numbers.each_mut().map(|numbers| &mut numbers[lane]);
            // Where it is mixed, one number decides who draws, and what is left of it chooses the lobe. Nobody can foresee who does, so
            // both are worked out, without a jump.
            let is_drawn_from_square = (share >= 1.0) | (*choice < share);
            self.is_redirected[lane] = is_drawn_from_square & (share < 1.0);
            let (point, density) = self.warps[lane].warp([*u, *v]);
            let rest = ((*choice - share) / (1.0 - share)).clamp(0.0, 1.0 - f32::EPSILON);
            let choose =
                |square: f32, lobes: f32| if is_drawn_from_square { square } else { lobes };
            [*u, *v] = [choose(point[0], *u), choose(point[1], *v)];
            self.density[lane] = choose(density, 1.0);
            *choice = choose(*choice, rest);
        }
    }

    /// How likely the direction in a lane, which was drawn with the density `pdf`, would have been with other shares of guided directions; `None`
    /// where they are not mixed with others.
    #[inline(always)]
    pub fn odds(&self, lane: usize, places: &SquarePlaces, pdf: f32) -> Option<Odds> {
        let reach = self.reach[lane];
        let is_mixed = reach > 0.0 && pdf > 0.0 && pdf < f32::INFINITY;
        is_mixed.then(|| {
            Odds::of(&MixedDirection {
                pdf,
                guided: guided_pdf(self.warps[lane], places.bins[lane], places.cosines[lane]),
                share: self.share[lane],
                reach,
            })
        })
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
        for (lane, vertex) in (0..CHUNK).zip(vertices) {
            let share = self.share[lane];
            // Of the matte ones, those that are not guided have the density 1.
            if share >= 1.0 || share <= 0.0 {
                samples.pdf[lane] *= self.density[lane];
                samples.weight[lane] *= 1.0 / self.density[lane];
            } else if self.is_redirected[lane] {
                let local = warp::cosine_hemisphere([numbers[0][lane], numbers[1][lane]]);
                let normal = normals.get(lane);
                let direction = Frame::about(normal).to_world(local);
                vertex.look(lane, direction, normal, samples);
                let guided = self.density[lane] * local.z * FRAC_1_PI;
                let pdf = mixed_pdf(share, guided, samples.pdf[lane]);
                // So far the weight is the value itself.
                samples.weight[lane] *= 1.0 / pdf;
                samples.pdf[lane] = pdf;
            } else {
                let pdf = samples.pdf[lane];
                if pdf == f32::INFINITY {
                    samples.weight[lane] *= 1.0 / (1.0 - share);
                    continue;
                }
                let (bin, cosine) = place(normals.get(lane), samples.direction.get(lane));
                let guided = guided_pdf(self.warps[lane], bin, cosine);
                let mixed = mixed_pdf(share, guided, pdf);
                let is_drawn = pdf > 0.0 && mixed > 0.0;
                samples.weight[lane] *= if is_drawn { pdf / mixed } else { 0.0 };
                samples.pdf[lane] = mixed;
            }
        }
    }
}

/// Where on the square directions are, for each lane.
pub(super) struct SquarePlaces {
    /// What part of the square gives the direction; it means nothing below the surface.
    bins: [Bin; CHUNK],
    /// The cosine of the angle to the normal; not positive below the surface.
    cosines: [f32; CHUNK],
}

impl Default for SquarePlaces {
    fn default() -> Self {
        Self {
            bins: [Bin::default(); CHUNK],
            cosines: [0.0; CHUNK],
        }
    }
}

impl SquarePlaces {
    /// Those of `directions`, seen from surfaces with these `normals`; both unit and in world space.
    #[inline(always)]
    pub fn of(normals: &VectorLanes<CHUNK>, directions: &VectorLanes<CHUNK>) -> Self {
        let mut places = Self::default();
        for lane in 0..CHUNK {
            let (bin, cosine) = place(normals.get(lane), directions.get(lane));
            places.bins[lane] = bin;
            places.cosines[lane] = cosine;
        }
        places
    }

    /// The part of the square that gives the direction in a lane; nothing gives those below the surface.
    #[inline(always)]
    pub fn bin(&self, lane: usize) -> Option<Bin> {
        (self.cosines[lane] > 0.0).then_some(self.bins[lane])
    }
}

/// What part of the square gives `direction` at a surface with the shading normal `normal`, both unit and in world space; and the cosine between the two, not
/// positive below the surface, where the part means nothing.
#[inline(always)]
fn place(normal: Vec3, direction: Vec3) -> (Bin, f32) {
    let local = Frame::about(normal).to_local(direction);
    (Bin::of(warp::cosine_hemisphere_inverse(local)), local.z)
}

/// The density over solid angle with which the warped square gives a direction in `bin`, `cosine` from the normal.
#[inline(always)]
fn guided_pdf(warp: &SquareWarp, bin: Bin, cosine: f32) -> f32 {
    warp.density(bin) * cosine.max(0.0) * FRAC_1_PI
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

#[cfg(test)]
mod tests {
    use super::*;

    /// With the share that it was drawn with, a direction is as likely as it was; where nothing is mixed there is no other share.
    #[test]
    fn odds_are_those_of_mixed_directions() {
        let mut guidance = Guidance::new();
        let mut places = SquarePlaces::default();
        places.cosines[3] = 0.5;
        let guided = 0.5 * FRAC_1_PI;
        assert_eq!(guidance.odds(3, &places, 0.2), None);
        guidance.reach[3] = 0.8;
        guidance.share[3] = 0.8 * 0.25;
        let own = 2.0;
        let pdf = mixed_pdf(guidance.share[3], guided, own);
        let direction = MixedDirection {
            pdf,
            guided,
            share: 0.2,
            reach: 0.8,
        };
        assert_eq!(guidance.odds(3, &places, pdf), Some(Odds::of(&direction)));
        assert_eq!(guidance.odds(3, &places, f32::INFINITY), None);
    }
}
