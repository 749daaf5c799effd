//! What was learned guides the directions of a chunk of children, and their densities.
//!
//! Diffuse lobes draw directions from a square, by the cosine: where it is warped they draw from the product of themselves and the light that was learned.
//! Other smooth lobes are mixed with that: with a share s of directions in their place, a direction has the density
//!
//! q = (s + (1 - s) b) d c + (1 - s) (p - b c)
//!
//! where p is that of the surface, which draws from diffuse lobes with probability b, c = cos / pi, and d is the density of the warped square (one-sample
//! MIS, balance heuristic). Discrete lobes are left alone.

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
    /// The probability with which diffuse lobes are drawn from; 0 where they are not guided.
    diffuse: [f32; CHUNK],
    /// The share of directions that are drawn from the warped square in place of other lobes.
    share: [f32; CHUNK],
    /// The part of a [`GuidedShare`](crate::learning::GuidedShare) that the surface makes use of.
    reach: [f32; CHUNK],
    /// The density of the point to which each was warped.
    density: [f32; CHUNK],
    /// Which lanes draw from the warped square in place of other lobes.
    is_redirected: [bool; CHUNK],
}

impl<'k> Guidance<'k> {
    /// Nothing is known.
    pub fn new() -> Self {
        Self {
            warps: [&SquareWarp::UNIFORM; CHUNK],
            diffuse: [0.0; CHUNK],
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
            let Guiding { diffuse, reach } = vertex.guiding();
            let share = reach * insight.mixed_share.value();
            let [diffuse, share, reach] =
                [diffuse, share, reach].map(|part| if insight.guides { part } else { 0.0 });
            self.diffuse[lane] = diffuse;
            self.share[lane] = share;
            self.reach[lane] = reach;
            self.warps[lane] = &insight.warp;
            is_any_guided |= diffuse + share > 0.0;
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
            let density = self.warps[lane].density(places.bins[lane]);
            values.pdf[lane] = self.pdf(lane, density, places.cosines[lane], values.pdf[lane]);
        }
    }

    /// The density of a direction in a lane, `cosine` from the normal, where that of the warped square is `density` and that of the surface is `own`.
    #[inline(always)]
    fn pdf(&self, lane: usize, density: f32, cosine: f32, own: f32) -> f32 {
        let (diffuse, share) = (self.diffuse[lane], self.share[lane]);
        let by_cosine = cosine.max(0.0) * FRAC_1_PI;
        // Where there are no others nothing is left but rounding.
        let others = if diffuse >= 1.0 {
            0.0
        } else {
            (own - diffuse * by_cosine).max(0.0)
        };
        (share + (1.0 - share) * diffuse) * density * by_cosine + (1.0 - share) * others
    }

    /// Warps the points of the square from which the diffuse lobes of the first `count` vertices are about to draw, and takes those who draw from it in place
    /// of others; the rest of their `numbers` are for these.
    #[inline(always)]
    pub fn warp(
        &mut self,
        count: usize,
        numbers: &mut [[f32; CHUNK]; 3],
        points: &mut [[f32; CHUNK]; 2],
    ) {
        let [_, _, choices] = numbers;
        let [u, v] = points;
        for lane in 0..count.min(CHUNK) {
            let (share, choice) = (self.share[lane], choices[lane]);
            // One number decides who draws, and what is left of it chooses the lobe. Nobody can foresee who does, so both are worked out, without a jump.
            let is_redirected = choice < share;
            let rest = ((choice - share) / (1.0 - share)).clamp(0.0, 1.0 - f32::EPSILON);
            choices[lane] = if is_redirected { choice } else { rest };
            self.is_redirected[lane] = is_redirected;

            let is_guided = self.diffuse[lane] + share > 0.0;
            let (point, density) = self.warps[lane].warp([u[lane], v[lane]]);
            let choose = |warped: f32, other: f32| if is_guided { warped } else { other };
            [u[lane], v[lane]] = [choose(point[0], u[lane]), choose(point[1], v[lane])];
            self.density[lane] = choose(density, 1.0);
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

    /// Makes the directions that at most [`CHUNK`] `vertices` drew with the warped numbers and `points` those of the mixture.
    #[inline(always)]
    pub fn redirect<'a, S: SpectrumArithmetic, V: Scattering<S>>(
        &self,
        vertices: impl Iterator<Item = &'a V>,
        normals: &VectorLanes<CHUNK>,
        points: &[[f32; CHUNK]; 2],
        samples: &mut BsdfSamples<S>,
    ) {
        for (lane, vertex) in (0..CHUNK).zip(vertices) {
            let (diffuse, share) = (self.diffuse[lane], self.share[lane]);
            // Those that are not guided have the density 1.
            if diffuse >= 1.0 || diffuse + share <= 0.0 {
                samples.pdf[lane] *= self.density[lane];
                samples.weight[lane] *= 1.0 / self.density[lane];
            } else if self.is_redirected[lane] {
                let local = warp::cosine_hemisphere(points.map(|numbers| numbers[lane]));
                let normal = normals.get(lane);
                let direction = Frame::about(normal).to_world(local);
                vertex.look(lane, direction, normal, samples);
                let pdf = self.pdf(lane, self.density[lane], local.z, samples.pdf[lane]);
                // So far the weight is the value itself.
                samples.weight[lane] *= 1.0 / pdf;
                samples.pdf[lane] = pdf;
            } else {
                let own = samples.pdf[lane];
                if own == f32::INFINITY {
                    samples.weight[lane] *= 1.0 / (1.0 - share);
                    continue;
                }
                let (bin, cosine) = place(normals.get(lane), samples.direction.get(lane));
                let pdf = self.pdf(lane, self.warps[lane].density(bin), cosine, own);
                let is_drawn = own > 0.0 && pdf > 0.0;
                samples.weight[lane] *= if is_drawn { own / pdf } else { 0.0 };
                samples.pdf[lane] = pdf;
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
        let pdf = guidance.pdf(3, 1.0, 0.5, own);
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
