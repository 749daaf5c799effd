//! Path states as structures of arrays. Buffers are kept between batches: after the first, nothing is allocated.

use std::ops::Range;

use super::lineage::Birth;
use super::path_counts::PathCounts;
use super::variant::{Scattering, Variant};
use crate::embree::{Hits, Rays};
use crate::film::FilmTile;
use crate::lanes::{CHUNK, VectorColumn};
use crate::learning::{Knowledge, LightObservation, LobeClass};
use crate::room::{gather, make_room, resize};
use crate::sampling::{PixelSequences, Ranks, Sampler, SequencePoint, SolidAnglePdf};
use crate::scene::{HitCoordinates, Receiver, Refraction};
use crate::spectrum::Colour;

/// The camera paths of a batch: what all particles that descend from one have in common. Paths of one pixel stand side
/// by side.
pub(super) struct CameraPaths<C: Colour> {
    /// Which pixels of the tile they belong to.
    pub pixels: Range<u32>,
    /// The pixel to which each belongs: its number among those of the batch.
    pub pixel: Vec<u32>,
    /// Of each pixel, the first path of the next one.
    pub ends: Vec<u32>,
    /// The sequences of each of those. Empty where random numbers are independent.
    pub sequences: Vec<PixelSequences>,
    /// How bright each of those is, as far as that was learned.
    pub brightness: Vec<f32>,
    /// The wavelengths that the path carries.
    pub wavelengths: Vec<C::Wavelengths>,
    /// How they were chosen.
    pub wavelength_draw: Vec<C::WavelengthDraw>,
    /// What has arrived so far at the camera.
    pub radiance: Vec<C::Spectrum>,
    /// The colours of the [`EmissionTable`](super::emission_table::EmissionTable) on the path: all of one path side by side. Empty
    /// where it does not prepare them.
    pub emission: Vec<C::Spectrum>,
    /// The reflectances of the [`ShapeTable`](super::shape_table::ShapeTable) likewise.
    pub reflectances: Vec<C::Spectrum>,
    /// The radiance in linear sRGB, once all has arrived.
    pub colour: Vec<[f32; 3]>,
    /// The reconstruction filter's weight of the sample.
    pub filter_weight: Vec<f32>,
}

/// Rays on their way to the next vertex.
pub(super) struct Segments<C: Colour> {
    /// How often the paths have been scattered before.
    pub depth: u32,
    /// The camera path that each descends from; those of a pixel stand side by side.
    pub path: Vec<u32>,
    /// Throughput, with the bsdf of the vertex that it left and the compensation for all decisions so far.
    pub throughput: Vec<C::Spectrum>,
    /// Where the particle stands in its sequence of random numbers. Empty where those are independent, and where nobody asks before there are ranks.
    pub point: Vec<SequencePoint>,
    /// What refraction has done to it. Empty in variants that do not refract.
    pub refraction: Vec<Refraction>,
    /// The density with which its direction was drawn, times how many children were expected of the vertex that it left; infinite for camera rays, which
    /// no other technique can draw.
    pub direction_pdf: Vec<SolidAnglePdf>,
    /// The surface that each left, where next-event estimation chose its light by it; else empty.
    pub origins: Vec<Origin>,
    /// The rays themselves, in world space.
    pub rays: Rays,
    /// What they hit.
    pub hits: Hits,
    /// How they came to be. Empty but where the render learns.
    pub births: Vec<Birth>,
}

/// A surface that a ray has left.
#[derive(Clone, Copy)]
pub(super) struct Origin {
    /// As next-event estimation saw it.
    pub receiver: Receiver,
    /// What was learned there (see [`Knowledge::insight`]); of nothing where nothing is learned.
    pub insight: u32,
}

/// Surface points that scatter light.
pub(super) struct Vertices<C: Colour, V: Variant> {
    /// How often the paths have been scattered before.
    pub depth: u32,
    /// The camera path that each descends from; those of a pixel stand side by side.
    pub path: Vec<u32>,
    /// Throughput on arrival.
    pub throughput: Vec<C::Spectrum>,
    /// Where the particle stands in its sequence of random numbers. Empty where those are independent.
    pub point: Vec<SequencePoint>,
    /// Position in world space.
    pub position: VectorColumn,
    /// Unit geometric normal in world space, on either side. Empty where all surfaces are shaded as they are: see
    /// [`Self::geometric_normals`].
    pub geometric_normal: VectorColumn,
    /// Unit shading normal of the side that was hit, in world space.
    pub normal: VectorColumn,
    /// By how much rays start off the surface at the least, in scene units (see [`Instance::clearance`](crate::scene::Instance::clearance)).
    /// Empty where the scene has no instances.
    pub clearance: Vec<f32>,
    /// Where observations go (see [`Knowledge::addresses`]). Empty where nothing is learned.
    pub address: Vec<u32>,
    /// Where the lobes of the surface point. Empty where no counts are learned, and where no surface has lobes.
    pub lobe: Vec<Option<LobeClass>>,
    /// What was learned there (see [`Knowledge::insight`]). Empty where nothing is learned.
    pub insight: Vec<u32>,
    /// The segment that led here. Empty but where the render learns.
    pub segment: Vec<u32>,
    /// How that side scatters light at the path's wavelengths.
    pub bsdf: Vec<V::Scattering<C::Spectrum>>,
}

/// Rays that ask whether light arrives.
pub(super) struct ShadowRays<C: Colour> {
    /// The camera path that each contributes to.
    pub path: Vec<u32>,
    /// The segment at whose end each starts. Empty but where the render learns.
    pub segment: Vec<u32>,
    /// The number of each among the looks. Empty but where it learns, and chooses lights by what it knows.
    pub look: Vec<u32>,
    /// What was looked at, and what it brings if nothing is in the way. Empty likewise.
    pub looks: Vec<LightObservation>,
    /// What it contributes if nothing is in the way.
    pub contribution: Vec<C::Spectrum>,
    /// The rays themselves, in world space.
    pub rays: Rays,
}

/// What the strategy is shown of the vertices, one entry each.
#[derive(Default)]
pub(super) struct Particles {
    pub importance: Vec<f32>,
    pub albedo: Vec<f32>,
    /// Throughput times albedo, as a mean over wavelengths.
    pub reflected: Vec<f32>,
    pub shininess: Vec<f32>,
    pub group: Vec<u32>,
}

impl<C: Colour> CameraPaths<C> {
    pub fn new() -> Self {
        Self {
            pixels: 0..0,
            pixel: Vec::new(),
            ends: Vec::new(),
            sequences: Vec::new(),
            brightness: Vec::new(),
            wavelengths: Vec::new(),
            wavelength_draw: Vec::new(),
            radiance: Vec::new(),
            emission: Vec::new(),
            reflectances: Vec::new(),
            colour: Vec::new(),
            filter_weight: Vec::new(),
        }
    }

    /// Empties the paths and makes room for those that each of the `pixels` gets; returns how many that are.
    pub fn restart(&mut self, pixels: Range<u32>, counts: PathCounts<'_>) -> usize {
        let range = pixels.start as usize..pixels.end as usize;
        let count = counts.of_pixels(range.clone()) as usize;
        self.pixels = pixels;
        make_room(&mut self.pixel, count);
        make_room(&mut self.ends, range.len());
        for (number, index) in (0..).zip(range) {
            let end = self.pixel.len() + counts.of_pixel(index) as usize;
            self.pixel.resize(end, number);
            self.ends.push(end as u32);
        }
        make_room(&mut self.wavelengths, count);
        make_room(&mut self.wavelength_draw, count);
        make_room(&mut self.radiance, count);
        make_room(&mut self.filter_weight, count);
        count
    }

    /// Finds out which sequences the pixels have, which are those of `tile`: they go on from the samples that it has.
    pub fn find_sequences(&mut self, sampler: &Sampler, tile: &FilmTile) {
        make_room(&mut self.sequences, self.pixels.len());
        if sampler.has_sequences() {
            let sequences = self.pixels.clone().map(|pixel| {
                let before = tile.pixels.get(pixel as usize).samples;
                sampler.sequences(pixel, before)
            });
            self.sequences.extend(sequences);
        }
    }

    /// Finds out how bright the pixels are, which are those of `tile` on a film of so many columns.
    pub fn find_brightness(&mut self, knowledge: &Knowledge, tile: &FilmTile, width: u32) {
        make_room(&mut self.brightness, self.pixels.len());
        let brightness = |pixel: u32| {
            let (x, y) = tile.position(pixel as usize);
            knowledge.pixels().brightness(y * width + x)
        };
        self.brightness.extend(self.pixels.clone().map(brightness));
    }

    /// The point of the next of the particles that are numbered by `ranks`, which descends from a path.
    #[inline(always)]
    pub fn rank(&self, path: u32, ranks: &mut Ranks) -> SequencePoint {
        ranks.next(path, &self.pixel, &self.ends, &self.sequences)
    }

    /// How many paths belong to pixel number `pixel` of the batch.
    #[inline(always)]
    pub fn count(&self, pixel: usize) -> u32 {
        let first = pixel.checked_sub(1).map_or(0, |before| self.ends[before]);
        self.ends[pixel] - first
    }

    /// The pixel to which a path belongs: its number among those of the batch.
    #[inline(always)]
    pub fn pixel(&self, path: u32) -> u32 {
        self.pixel[path as usize]
    }
}

impl<C: Colour> Segments<C> {
    pub fn new() -> Self {
        Self {
            depth: 0,
            path: Vec::new(),
            throughput: Vec::new(),
            point: Vec::new(),
            refraction: Vec::new(),
            direction_pdf: Vec::new(),
            origins: Vec::new(),
            rays: Rays::default(),
            hits: Hits::default(),
            births: Vec::new(),
        }
    }

    pub fn len(&self) -> usize {
        self.path.len()
    }

    /// Empties the states and makes room for `count` rays of paths that have been scattered `depth` times before, which the caller sets one by one.
    pub fn restart(&mut self, depth: u32, count: usize) {
        self.depth = depth;
        make_room(&mut self.path, count);
        make_room(&mut self.throughput, count);
        make_room(&mut self.point, count);
        make_room(&mut self.refraction, count);
        make_room(&mut self.direction_pdf, count);
        self.origins.clear();
        self.births.clear();
        self.rays.resize(count);
    }

    /// Makes room for the surfaces that `count` rays leave.
    pub fn remember_origins(&mut self, count: usize) {
        make_room(&mut self.origins, count);
    }

    /// Becomes those of `source` in another order: number `order[i]` in place i.
    pub fn gather(&mut self, source: &Self, order: &[u32]) {
        self.depth = source.depth;
        gather(&mut self.path, &source.path, order);
        gather(&mut self.throughput, &source.throughput, order);
        gather(&mut self.point, &source.point, order);
        gather(&mut self.refraction, &source.refraction, order);
        gather(&mut self.direction_pdf, &source.direction_pdf, order);
        gather(&mut self.origins, &source.origins, order);
        self.rays.gather_traced(&source.rays, order);
        self.hits.gather(&source.hits, order);
        gather(&mut self.births, &source.births, order);
    }

    /// Where a ray met its shape, if it met one.
    #[inline]
    pub fn hit(&self, index: usize) -> HitCoordinates {
        let [u, v] = self.hits.uv(index);
        HitCoordinates {
            primitive: self.hits.primitive_id(index),
            u,
            v,
            normal: self.hits.normal(index).into(),
        }
    }
}

impl<C: Colour, V: Variant> Vertices<C, V> {
    pub fn new() -> Self {
        Self {
            depth: 0,
            path: Vec::new(),
            throughput: Vec::new(),
            point: Vec::new(),
            position: VectorColumn::default(),
            geometric_normal: VectorColumn::default(),
            normal: VectorColumn::default(),
            clearance: Vec::new(),
            address: Vec::new(),
            lobe: Vec::new(),
            insight: Vec::new(),
            segment: Vec::new(),
            bsdf: Vec::new(),
        }
    }

    pub fn len(&self) -> usize {
        self.path.len()
    }

    /// Unit geometric normals in world space, on either side.
    #[inline(always)]
    pub fn geometric_normals(&self) -> &VectorColumn {
        if self.geometric_normal.is_empty() {
            &self.normal
        } else {
            &self.geometric_normal
        }
    }

    /// A vertex as next-event estimation sees it.
    #[inline(always)]
    pub fn receiver(&self, i: usize) -> Receiver {
        Receiver {
            position: self.position.get(i),
            normal: self.normal.get(i),
            scatters_below: self.bsdf[i].scatters_below(),
        }
    }

    /// A vertex as a surface that rays leave.
    #[inline(always)]
    pub fn origin(&self, i: usize) -> Origin {
        Origin {
            receiver: self.receiver(i),
            insight: self.insight.get(i).copied().unwrap_or_default(),
        }
    }

    /// Where the lobes of a vertex's surface point, if it has any and counts are learned.
    #[inline(always)]
    pub fn lobe(&self, i: usize) -> Option<LobeClass> {
        self.lobe.get(i).copied().flatten()
    }

    /// The clearances of a chunk of vertices, put into `lanes`; `None` where the scene has no instances.
    #[inline(always)]
    pub fn clearances<'l>(
        &self,
        chunk: impl Iterator<Item = usize>,
        lanes: &'l mut [f32; CHUNK],
    ) -> Option<&'l [f32; CHUNK]> {
        if !V::INSTANCES || self.clearance.is_empty() {
            return None;
        }
        for (lane, i) in lanes.iter_mut().zip(chunk) {
            *lane = self.clearance[i];
        }
        Some(lanes)
    }

    /// Empties the vertices and makes room for `count` of paths that have been scattered `depth` times before.
    pub fn restart(&mut self, depth: u32, count: usize) {
        self.depth = depth;
        make_room(&mut self.path, count);
        make_room(&mut self.throughput, count);
        make_room(&mut self.point, count);
        self.position.restart(count);
        self.geometric_normal.restart(count);
        self.normal.restart(count);
        if V::INSTANCES {
            self.clearance.clear();
        }
        self.address.clear();
        self.lobe.clear();
        self.insight.clear();
        self.segment.clear();
        make_room(&mut self.bsdf, count);
    }
}

impl<C: Colour> ShadowRays<C> {
    pub fn new() -> Self {
        Self {
            path: Vec::new(),
            segment: Vec::new(),
            look: Vec::new(),
            looks: Vec::new(),
            contribution: Vec::new(),
            rays: Rays::default(),
        }
    }

    /// Empties the states and makes room for `count` rays, which the caller sets one by one.
    pub fn restart(&mut self, count: usize) {
        make_room(&mut self.path, count);
        self.segment.clear();
        self.look.clear();
        self.looks.clear();
        make_room(&mut self.contribution, count);
        self.rays.resize(count);
    }
}

impl Particles {
    /// Makes the columns as long as there are particles; what they hold is unspecified.
    pub fn resize(&mut self, count: usize) {
        resize(&mut self.importance, count);
        resize(&mut self.albedo, count);
        resize(&mut self.reflected, count);
        resize(&mut self.shininess, count);
        resize(&mut self.group, count);
    }
}
