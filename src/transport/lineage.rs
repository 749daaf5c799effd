//! Who descends from whom, and what each brought back: what a batch observes while the render learns.

use super::batch::{CameraPaths, Segments};
use crate::learning::{Bin, Observation, Observations, PixelObservation};
use crate::room::{make_room, resize};
use crate::spectrum::{Colour, SpectrumArithmetic};

/// How a segment left its vertex.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Birth {
    /// The segment that led to the vertex: its index in the generation before.
    pub parent: u32,
    /// The [address](crate::learning::Knowledge::address) of the vertex.
    pub address: u32,
    /// The direction that it took, if it is one of those that are learned.
    pub bin: Option<Bin>,
    /// What light at the camera is multiplied by to be the radiance that came along the segment.
    pub per_radiance: f32,
    /// What it is multiplied by to be the value of an [`Observation`].
    pub per_value: f32,
}

/// All segments of a batch that were scattered equally often.
#[derive(Default)]
pub(super) struct Generation {
    births: Vec<Birth>,
    /// The mean over wavelengths of what each brought to the camera.
    light: Vec<f32>,
    /// Rays that were traced for each: itself, and shadow rays from its end.
    rays: Vec<f32>,
}

impl Generation {
    /// Segment number `segment` brought `light` to the camera.
    #[inline(always)]
    pub fn add<S: SpectrumArithmetic>(&mut self, segment: usize, light: S) {
        self.light[segment] += light.mean();
    }

    /// A shadow ray was traced from the end of segment number `segment`.
    #[inline(always)]
    pub fn count_shadow_ray(&mut self, segment: usize) {
        self.rays[segment] += 1.0;
    }
}

/// The generations of a batch, and what was observed in all batches of a tile.
#[derive(Default)]
pub(super) struct Lineage {
    generations: Vec<Generation>,
    /// How many of them are in use.
    depth: usize,
    /// What was observed; pixels are numbered within the tile.
    pub observed: Observations,
}

impl Lineage {
    /// A new batch begins.
    pub fn restart(&mut self) {
        self.depth = 0;
    }

    /// The generation of `segments` begins.
    pub fn begin<C: Colour>(&mut self, segments: &Segments<C>) {
        if self.depth == self.generations.len() {
            self.generations.push(Generation::default());
        }
        let generation = &mut self.generations[self.depth];
        self.depth += 1;
        generation.births.clone_from(&segments.births);
        make_room(&mut generation.light, segments.len());
        generation.light.resize(segments.len(), 0.0);
        make_room(&mut generation.rays, segments.len());
        generation.rays.resize(segments.len(), 1.0);
    }

    /// The generation that began last.
    pub fn youngest(&mut self) -> Option<&mut Generation> {
        self.generations[..self.depth].last_mut()
    }

    /// All light has arrived: every segment passes on to its parent what it and its descendants brought.
    ///
    /// A first generation has no parents: its births name the camera paths.
    pub fn conclude<C: Colour>(&mut self, paths: &CameraPaths<C>) {
        for depth in (1..self.depth).rev() {
            let (elders, youngest) = self.generations.split_at_mut(depth);
            let (elders, youngest) = (&mut elders[depth - 1], &youngest[0]);
            let brought = youngest
                .births
                .iter()
                .zip(&youngest.light)
                .zip(&youngest.rays);
            for ((birth, &light), &rays) in brought {
                self.observed.segments.push(Observation {
                    address: birth.address,
                    bin: birth.bin,
                    radiance: light * birth.per_radiance,
                    value: light * birth.per_value,
                    cost: rays,
                });
                elders.light[birth.parent as usize] += light;
                elders.rays[birth.parent as usize] += rays;
            }
        }
        let pixels = &mut self.observed.pixels;
        let first_of_batch = pixels.len();
        pixels.extend(paths.pixels.clone().map(|pixel| PixelObservation {
            pixel,
            ..PixelObservation::default()
        }));
        let pixels = &mut pixels[first_of_batch..];
        if let Some(first) = self.generations[..self.depth].first() {
            let brought = first.births.iter().zip(&first.light).zip(&first.rays);
            for ((birth, &light), &rays) in brought {
                let pixel = &mut pixels[(birth.parent / paths.samples) as usize];
                pixel.paths += 1;
                pixel.radiance += light;
                pixel.square += light * light;
                pixel.rays += rays;
            }
        }
    }
}

/// The births of camera paths: each names its own.
pub(super) fn first_births(births: &mut Vec<Birth>, paths: usize) {
    resize(births, paths);
    for (path, birth) in (0..).zip(births) {
        *birth = Birth {
            parent: path,
            ..Birth::default()
        };
    }
}
