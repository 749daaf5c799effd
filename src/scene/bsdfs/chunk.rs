//! Bsdfs of many vertices at once. For diffuse surfaces there is a loop over lanes for what has to do with directions, and one over
//! vertices for spectra, which are lanes themselves.
//!
//! Here directions are in world space: the frames of diffuse surfaces need not be stored.

use super::{Diffuse, Refraction};
use crate::lanes::{CHUNK, VectorLanes};
use crate::sampling::{Frame, warp};
use crate::spectrum::SpectrumArithmetic;

/// A [`BsdfValue`](super::BsdfValue) in each lane.
pub(crate) struct BsdfValues<S> {
    /// Bsdf times cosine of the incident direction, in 1/sr.
    pub value: [S; CHUNK],
    /// The density, over solid angle, with which the incident direction is drawn.
    pub pdf: [f32; CHUNK],
}

/// A [`BsdfSample`](super::BsdfSample) in each lane.
pub(crate) struct BsdfSamples<S> {
    /// The incident direction: unit, in world space.
    pub direction: VectorLanes<CHUNK>,
    /// Bsdf times cosine over density.
    pub weight: [S; CHUNK],
    /// The density of the direction over solid angle; infinite in a discrete lobe.
    pub pdf: [f32; CHUNK],
    /// What refraction has done to the path that goes on.
    pub refraction: [Refraction; CHUNK],
}

impl<S: SpectrumArithmetic> BsdfValues<S> {
    /// Black everywhere.
    pub fn new() -> Self {
        Self {
            value: [S::ZERO; CHUNK],
            pdf: [0.0; CHUNK],
        }
    }

    /// Evaluates diffuse `bsdfs`, at most [`CHUNK`], each with the unit shading normal of its side and a unit incident direction,
    /// both in world space.
    #[inline(always)]
    pub fn evaluate_diffuse(
        &mut self,
        bsdfs: &[Diffuse<S>],
        normals: &VectorLanes<CHUNK>,
        directions: &VectorLanes<CHUNK>,
    ) {
        self.find_cosine_pdfs(normals, directions);
        for (lane, bsdf) in bsdfs.iter().enumerate().take(CHUNK) {
            self.put_diffuse(lane, bsdf);
        }
    }

    /// Puts the density with which a diffuse surface draws a unit incident direction, and the unit shading normal of its side, both in world space, into
    /// every lane.
    #[inline(always)]
    pub fn find_cosine_pdfs(
        &mut self,
        normals: &VectorLanes<CHUNK>,
        directions: &VectorLanes<CHUNK>,
    ) {
        for lane in 0..CHUNK {
            let cosine = normals.get(lane).dot(directions.get(lane));
            self.pdf[lane] = warp::cosine_hemisphere_pdf(cosine).0;
        }
    }

    /// Puts the value of a diffuse bsdf into a lane where its density is.
    #[inline(always)]
    pub fn put_diffuse(&mut self, lane: usize, bsdf: &Diffuse<S>) {
        // The density is the cosine over pi, too.
        self.value[lane] = bsdf.reflectance * self.pdf[lane];
    }
}

impl<S: SpectrumArithmetic> BsdfSamples<S> {
    /// Black everywhere.
    pub fn new() -> Self {
        Self {
            direction: VectorLanes::default(),
            weight: [S::ZERO; CHUNK],
            pdf: [0.0; CHUNK],
            refraction: [Refraction::NONE; CHUNK],
        }
    }

    /// Draws an incident direction for each of the diffuse `bsdfs`, at most [`CHUNK`], with the unit shading normals of their sides
    /// in world space, from the uniform numbers `u` and `v` in [0, 1).
    #[inline(always)]
    pub fn sample_diffuse<'a>(
        &mut self,
        bsdfs: impl Iterator<Item = &'a Diffuse<S>>,
        normals: &VectorLanes<CHUNK>,
        u: &[f32; CHUNK],
        v: &[f32; CHUNK],
    ) {
        self.draw_by_cosine(normals, u, v);
        for (weight, bsdf) in self.weight.iter_mut().zip(bsdfs) {
            *weight = bsdf.reflectance;
        }
    }

    /// Draws the incident direction of a diffuse surface in every lane, and puts its density beside it, from the same.
    #[inline(always)]
    pub fn draw_by_cosine(
        &mut self,
        normals: &VectorLanes<CHUNK>,
        u: &[f32; CHUNK],
        v: &[f32; CHUNK],
    ) {
        for (lane, (&u, &v)) in u.iter().zip(v).enumerate() {
            let local = warp::cosine_hemisphere([u, v]);
            let frame = Frame::about(normals.get(lane));
            self.direction.put(lane, frame.to_world(local));
            self.pdf[lane] = warp::cosine_hemisphere_pdf(local.z).0;
        }
    }
}
