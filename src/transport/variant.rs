//! Variants of the engine: it is compiled once for scenes whose surfaces are all matte, and once for all others, so that
//! nobody pays for what a scene does not call for.

use std::fmt::Debug;

use glam::Vec3;

use super::batch::Segments;
use crate::lanes::{CHUNK, VectorLanes};
use crate::sampling::{Sampler, SequencePoint};
use crate::scene::{
    BsdfSamples, BsdfValues, HitCoordinates, Material, Refraction, Shape, Side, SurfaceLanes,
    SurfacePoint,
};
use crate::spectrum::{Colour, SpectrumArithmetic};

/// What the surfaces of a scene can do, as far as the engine is compiled for it.
pub(super) trait Variant: Send + Sync + 'static {
    /// How a surface scatters light at a vertex of a path that carries values `S`.
    type Scattering<S: SpectrumArithmetic>: Scattering<S>;

    /// Whether one of several lobes may be drawn: that takes a third random number for a direction.
    const CHOOSES_LOBES: bool;

    /// Whether light may be refracted.
    const REFRACTS: bool;
}

/// A path arrives at a surface. Everything else about it is found by those who ask: a variant does not pay for what it does not
/// want to know.
pub(super) struct Arrival<'a, C: Colour> {
    /// The shape.
    pub shape: &'a Shape,
    /// What it is made of.
    pub material: &'a Material,
    /// The side that the path sees.
    pub side: Side,
    /// Which wavelengths the path carries.
    pub wavelengths: &'a C::Wavelengths,
    /// How often it has been scattered before.
    pub depth: u32,
    /// The paths that arrive, and which of them this is.
    pub segments: &'a Segments<C>,
    /// Its index among those.
    pub index: usize,
    /// Where its chunk arrives.
    pub points: &'a SurfaceLanes<CHUNK>,
    /// Its lane in that chunk.
    pub lane: usize,
}

impl<C: Colour> Arrival<'_, C> {
    /// The point that was hit.
    #[inline]
    pub fn point(&self) -> SurfacePoint {
        self.points.get(self.lane)
    }

    /// The same in the terms of the intersection layer.
    #[inline]
    pub fn hit(&self) -> HitCoordinates {
        self.segments.hit(self.index)
    }

    /// The unit direction in which the path came, in world space.
    #[inline]
    pub fn direction(&self) -> Vec3 {
        self.segments.rays.direction(self.index).into()
    }

    /// Where it stands in its sequence of random numbers.
    #[inline]
    pub fn sequence(&self) -> SequencePoint {
        self.segments.point[self.index]
    }

    /// What refraction has done to it, in a variant that [refracts](Variant::REFRACTS).
    #[inline]
    pub fn refraction(&self) -> Refraction {
        self.segments.refraction[self.index]
    }
}

/// How a surface scatters light at one vertex. Directions are unit vectors in world space.
pub(super) trait Scattering<S: SpectrumArithmetic>:
    Copy + Debug + Send + Sync + 'static
{
    /// That of the surface at which a path arrives; `None` where it is black.
    fn at<C: Colour<Spectrum = S>>(arrival: &Arrival<C>, sampler: &mut Sampler) -> Option<Self>;

    /// The share of the arriving light that is scattered, in [0, 1].
    fn albedo(&self) -> S;

    /// What refraction has done to the path that arrives.
    fn refraction(&self) -> Refraction;

    /// See [`Bsdf::shininess`](crate::scene::Bsdf::shininess).
    fn shininess(&self) -> f32;

    /// Whether next-event estimation can find light here: not where all lobes are discrete.
    fn has_smooth_lobe(&self) -> bool;

    /// Evaluates at most [`CHUNK`] vertices, each with the shading normal of the side that was hit and an incident direction.
    fn evaluate(
        vertices: &[Self],
        normals: &VectorLanes<CHUNK>,
        directions: &VectorLanes<CHUNK>,
        values: &mut BsdfValues<S>,
    );

    /// Draws an incident direction for each of at most [`CHUNK`] vertices from uniform numbers in [0, 1); the third only where the
    /// variant [chooses lobes](Variant::CHOOSES_LOBES).
    fn sample<'a>(
        vertices: impl Iterator<Item = &'a Self>,
        normals: &VectorLanes<CHUNK>,
        numbers: &[[f32; CHUNK]; 3],
        samples: &mut BsdfSamples<S>,
    );
}
