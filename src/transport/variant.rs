//! Variants of the engine: it is compiled once for scenes whose surfaces are all matte, and once for all others, so that
//! nobody pays for what a scene does not call for.

use std::fmt::Debug;
use std::ops::Range;

use glam::Vec3;

use super::batch::{CameraPaths, Segments};
use super::engine::Engine;
use super::surface::SurfaceChunk;
use crate::lanes::{CHUNK, KeptLanes, VectorLanes};
use crate::sampling::{Sampler, SequencePoint};
use crate::scene::{
    BsdfSamples, BsdfValues, Material, Refraction, Shape, Side, SurfaceParameters, SurfacePoint,
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

    /// Whether surfaces may stand in instances.
    const INSTANCES: bool;
}

/// Whether segments carry points of sequences: where particles keep theirs, and where one may draw its material before it has a rank.
pub(super) fn carries_points<V: Variant>(sampler: &Sampler) -> bool {
    sampler.carries_points() || V::CHOOSES_LOBES && sampler.has_sequences()
}

/// A chunk of paths that arrive somewhere. What is known of each is found by those who ask: a variant does not pay for what it
/// does not want to know.
pub(super) struct Arrivals<'a, C: Colour> {
    /// The scene, and what was prepared for it.
    pub engine: &'a Engine,
    /// The camera paths that they descend from.
    pub paths: &'a CameraPaths<C>,
    /// The paths that arrive, of which the chunk is a part.
    pub segments: &'a Segments<C>,
    /// Which of the segments these are, at most [`CHUNK`].
    pub chunk: Range<usize>,
    /// What they have hit.
    pub surfaces: &'a SurfaceChunk<'a>,
    /// Between the direction to where each comes from and the shading normal.
    pub cosines: &'a [f32; CHUNK],
}

/// One path that arrives at a surface, on one of its sides.
pub(super) struct Arrival<'a, C: Colour> {
    /// The shape.
    pub shape: &'a Shape,
    /// What it is made of.
    pub material: &'a Material,
    /// The side that the path sees.
    pub side: Side,
    all: &'a Arrivals<'a, C>,
    lane: usize,
}

impl<C: Colour> Arrivals<'_, C> {
    /// The one in a lane, if it arrives at a surface.
    #[inline(always)]
    pub fn at_surface(&self, lane: usize) -> Option<Arrival<'_, C>> {
        let shape = self.engine.shape(self.segments, self.chunk.start + lane)?;
        Some(Arrival {
            shape,
            material: &self.engine.scene.materials[shape.material.index()],
            side: Side::seen_with(self.cosines[lane])?,
            all: self,
            lane,
        })
    }

    /// The diffuse reflectance of the side that the one in a lane sees, if that is all that it does and it is the same at every point; not where it is black.
    #[inline(always)]
    pub fn reflectance(&self, lane: usize) -> Option<C::Spectrum> {
        let number = self.surfaces.entries[lane].reflectance(self.cosines[lane])?;
        let table = &self.engine.shapes.reflectances;
        Some(if table.is_prepared::<C>() {
            table.prepared(&self.paths.reflectances, self.path(lane), number)
        } else {
            C::evaluate(table.curve(number), self.wavelengths(lane))
        })
    }

    /// What refraction has done to the one in a lane, in a variant that [refracts](Variant::REFRACTS).
    #[inline(always)]
    pub fn refraction(&self, lane: usize) -> Refraction {
        self.segments.refraction[self.chunk.start + lane]
    }

    /// The camera path from which the one in a lane descends.
    #[inline(always)]
    pub fn path(&self, lane: usize) -> usize {
        self.segments.path[self.chunk.start + lane] as usize
    }

    /// Which wavelengths the path in a lane carries.
    #[inline(always)]
    pub fn wavelengths(&self, lane: usize) -> &C::Wavelengths {
        &self.paths.wavelengths[self.path(lane)]
    }
}

impl<C: Colour> Arrival<'_, C> {
    /// Its index among the segments.
    #[inline(always)]
    fn index(&self) -> usize {
        self.all.chunk.start + self.lane
    }

    /// Which wavelengths the path carries.
    #[inline(always)]
    pub fn wavelengths(&self) -> &C::Wavelengths {
        self.all.wavelengths(self.lane)
    }

    /// How often it has been scattered before.
    #[inline]
    pub fn depth(&self) -> u32 {
        self.all.segments.depth
    }

    /// The point that was hit.
    #[inline]
    pub fn point(&self) -> SurfacePoint {
        self.all.surfaces.points.get(self.lane)
    }

    /// Where it lies on its shape.
    #[inline]
    pub fn parameters(&self) -> SurfaceParameters<'_> {
        let (geometry, hit) = (&self.shape.geometry, self.all.segments.hit(self.index()));
        match self.all.engine.instance(self.all.segments, self.index()) {
            Some(instance) => instance.parameters(geometry, &hit),
            None => geometry.parameters(&hit, &self.point()),
        }
    }

    /// The unit direction in which the path came, in world space.
    #[inline]
    pub fn direction(&self) -> Vec3 {
        self.all.segments.rays.direction(self.index()).into()
    }

    /// Where it stands in its sequence of random numbers; nowhere without sequences.
    #[inline]
    pub fn sequence(&self) -> SequencePoint {
        let points = &self.all.segments.point;
        points.get(self.index()).copied().unwrap_or_default()
    }

    /// What refraction has done to it, in a variant that [refracts](Variant::REFRACTS).
    #[inline]
    pub fn refraction(&self) -> Refraction {
        self.all.refraction(self.lane)
    }
}

/// What a surface makes of what was learned when it draws the directions of children.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Guiding {
    /// The probability with which the surface draws from the whole square, by the cosine: there the warped square takes its place.
    pub diffuse: f32,
    /// The part of a [`GuidedShare`](crate::learning::GuidedShare) with which the other lobes make room for the warped square: the broader they are, the
    /// larger; 0 where they are discrete.
    pub reach: f32,
}

impl Guiding {
    /// That of a surface that is diffuse and nothing else.
    pub const MATTE: Self = Self {
        diffuse: 1.0,
        reach: 0.0,
    };
}

/// How a surface scatters light at one vertex. Directions are unit vectors in world space.
pub(super) trait Scattering<S: SpectrumArithmetic>:
    Copy + Debug + Send + Sync + 'static
{
    /// Finds out what all vertices of a path have in common, as camera paths start.
    #[inline(always)]
    fn prepare<C: Colour<Spectrum = S>>(_engine: &Engine, _paths: &mut CameraPaths<C>) {}

    /// Appends those of the surfaces at which paths arrive to `vertices`, but for black ones, and returns their lanes.
    fn arrive<C: Colour<Spectrum = S>>(
        arrivals: &Arrivals<C>,
        sampler: &mut Sampler,
        vertices: &mut Vec<Self>,
    ) -> KeptLanes;

    /// The share of the arriving light that is scattered, in [0, 1].
    fn albedo(&self) -> S;

    /// What refraction has done to the path that arrives.
    fn refraction(&self) -> Refraction;

    /// See [`Bsdf::shininess`](crate::scene::Bsdf::shininess).
    fn shininess(&self) -> f32;

    /// The unit direction (world space) in which a mirror would send on the path, if what the surface does with it depends on where it comes from.
    fn lobe(&self) -> Option<Vec3>;

    /// Whether next-event estimation can find light here: not where all lobes are discrete.
    fn has_smooth_lobe(&self) -> bool;

    /// Whether light that arrives below the shading normal's horizon can be scattered to where the path comes from.
    fn scatters_below(&self) -> bool;

    /// What is made of what was learned when the directions of children are drawn.
    fn guiding(&self) -> Guiding;

    /// Makes sample number `lane` one in `direction`, where `normal` is the unit shading normal of the side that was hit: with the bsdf times cosine as its
    /// weight, and the density with which the surface itself would have drawn the direction.
    fn look(&self, lane: usize, direction: Vec3, normal: Vec3, samples: &mut BsdfSamples<S>);

    /// Evaluates at most [`CHUNK`] vertices, each with the shading normal of the side that was hit and an incident direction.
    fn evaluate(
        vertices: &[Self],
        normals: &VectorLanes<CHUNK>,
        directions: &VectorLanes<CHUNK>,
        values: &mut BsdfValues<S>,
    );

    /// Draws an incident direction for each of at most [`CHUNK`] vertices from uniform numbers in [0, 1), the third only where the
    /// variant [chooses lobes](Variant::CHOOSES_LOBES); diffuse lobes draw from the points `diffuse` of the square instead.
    fn sample<'a>(
        vertices: impl Iterator<Item = &'a Self> + Clone,
        normals: &VectorLanes<CHUNK>,
        numbers: &[[f32; CHUNK]; 3],
        diffuse: &[[f32; CHUNK]; 2],
        samples: &mut BsdfSamples<S>,
    );
}
