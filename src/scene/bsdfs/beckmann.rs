//! Slopes of the facets of a Beckmann surface that are seen from a direction: found by a search, one by one or side by side.

use std::f32::consts::FRAC_2_SQRT_PI;

use glam::Vec2;

use crate::functions::{erf, exp_of_negative, inverse_erf, ln};
use crate::lanes::CHUNK;

/// 1 / sqrt(pi).
pub(super) const INVERSE_SQRT_PI: f32 = 0.5 * FRAC_2_SQRT_PI;

/// A slope of a surface of roughness 1 seen from the cosine `cos` in (0, 1], along the view's azimuth and across, from uniform numbers in [0, 1).
///
/// Jakob 2014, "An Improved Visible Normal Sampling Routine for the Beckmann Distribution".
#[inline(always)]
pub(super) fn slope_seen(cos: f32, [u, v]: [f32; 2]) -> Vec2 {
    const MARGIN: f32 = 1e-6;
    let inside = |u: f32| u.clamp(MARGIN, 1.0 - MARGIN);
    let (u, v) = (inside(u), inside(v));
    let tan = (1.0 - cos * cos).max(0.0).sqrt() / cos;
    let cot = 1.0 / tan;
    // The search is for erf of the slope. It starts at the solution for a grazing view, the least linear case.
    let greatest = erf(cot);
    let x = greatest - (greatest + 1.0) * erf((-ln(u)).sqrt());
    let wanted = u * (1.0 + greatest + INVERSE_SQRT_PI * tan * exp_of_negative(-cot * cot));
    let improve = |x: f32| {
        let slope = inverse_erf(x);
        let value = 1.0 + x + INVERSE_SQRT_PI * tan * exp_of_negative(-slope * slope) - wanted;
        x - value / (1.0 - slope * tan)
    };
    // Three times; a loop within that over lanes would not become vector instructions.
    let x = improve(improve(improve(x)));
    Vec2::new(inverse_erf(x), inverse_erf(2.0 * v - 1.0))
}

/// Lanes that are searched at once: a search is one long chain, of which so many run side by side.
const BLOCK: usize = 16;

/// Slopes for some vertices of a chunk.
pub(crate) struct SlopeLanes {
    /// By lane, the place among those that are searched, counted from 1; 0 where there is nothing to find.
    places: [u8; CHUNK],
    count: usize,
    cosine: [f32; CHUNK],
    square: [[f32; CHUNK]; 2],
    slope: [[f32; CHUNK]; 2],
}

impl SlopeLanes {
    /// There is nothing to find.
    #[inline(always)]
    pub fn new() -> Self {
        Self {
            places: [0; CHUNK],
            count: 0,
            cosine: [1.0; CHUNK],
            square: [[0.5; CHUNK]; 2],
            slope: [[0.0; CHUNK]; 2],
        }
    }

    /// In this lane, which has none yet, the slope is to be found that `square`, uniform in [0, 1)^2, gives where a surface is
    /// [seen](super::Bsdf::slope_view) under the cosine `view`.
    #[inline(always)]
    pub fn ask(&mut self, lane: usize, view: f32, [u, v]: [f32; 2]) {
        let place = self.count % CHUNK;
        self.cosine[place] = view;
        self.square[0][place] = u;
        self.square[1][place] = v;
        self.count += 1;
        self.places[lane] = self.count as u8;
    }

    /// Finds them all.
    #[inline(always)]
    pub fn find(&mut self) {
        let blocks = self.count.div_ceil(BLOCK);
        let (cosines, _) = self.cosine.as_chunks::<BLOCK>();
        let [u, v] = self.square.each_ref().map(|u| u.as_chunks::<BLOCK>().0);
        let slopes = self.slope.each_mut();
        let [along, across] = slopes.map(|slope| slope.as_chunks_mut::<BLOCK>().0);
        let asked = cosines.iter().zip(u).zip(v);
        for (((cosine, u), v), (along, across)) in
            asked.zip(along.iter_mut().zip(across)).take(blocks)
        {
            for place in 0..BLOCK {
                let slope = slope_seen(cosine[place], [u[place], v[place]]);
                along[place] = slope.x;
                across[place] = slope.y;
            }
        }
    }

    /// That of a lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Option<Vec2> {
        let place = usize::from(self.places[lane]).checked_sub(1)?;
        let [along, across] = &self.slope;
        Some(Vec2::new(along[place % CHUNK], across[place % CHUNK]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_found_side_by_side_are_those_found_alone() {
        let mut lanes = SlopeLanes::new();
        let asked = |lane: usize| {
            let part = lane as f32 / CHUNK as f32;
            (0.02 + 0.98 * part, [part, 1.0 - part])
        };
        let is_asked = |lane: usize| lane % 3 != 1;
        for lane in (0..CHUNK).filter(|&lane| is_asked(lane)) {
            let (view, square) = asked(lane);
            lanes.ask(lane, view, square);
        }
        lanes.find();
        for lane in 0..CHUNK {
            let (view, square) = asked(lane);
            let expected = is_asked(lane).then(|| slope_seen(view, square));
            assert_eq!(lanes.get(lane), expected);
        }
    }
}
