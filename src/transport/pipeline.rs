//! One batch from the camera to its end.

use super::batch::{CameraPaths, Particles, Segments, ShadowRays, Vertices};
use super::engine::{Engine, TileJob};
use super::recorded_rays::RecordedRays;
use super::settings::DirectLight;
use super::stages::{Stage, Stopwatch};
use super::statistics::TraceStatistics;
use super::variant::Variant;
use super::{camera, direct, emission, hidden_emitters, intersect, scatter, walk_stage};
use crate::embree::Coherence;
use crate::film::{Accumulator, FilmTile, PixelStatistics, SecondMoments, TilePixels};
use crate::sampling::{Sampler, SamplerKind};
use crate::spectrum::{Colour, SpectrumArithmetic, xyz_from_srgb};
use crate::walk::{Offspring, Scope};

/// After so many bounces a batch is cut off and the cut is reported: only light that never dies gets here.
const MAX_BOUNCES: u32 = 1 << 16;

/// The stages in a row, and the memory of one thread: it traces batch after batch.
pub(super) struct Pipeline<C: Colour, V: Variant> {
    paths: CameraPaths<C>,
    segments: Segments<C>,
    vertices: Vertices<C, V>,
    shadow: ShadowRays<C>,
    particles: Particles,
    offspring: Offspring,
    /// What was counted so far.
    pub statistics: TraceStatistics,
    /// Where rays are recorded, while they are.
    pub recorded: Option<RecordedRays>,
}

impl<C: Colour, V: Variant> Default for Pipeline<C, V> {
    fn default() -> Self {
        Self {
            paths: CameraPaths::new(),
            segments: Segments::new(),
            vertices: Vertices::new(),
            shadow: ShadowRays::new(),
            particles: Particles::default(),
            offspring: Offspring::default(),
            statistics: TraceStatistics::default(),
            recorded: None,
        }
    }
}

impl<C: Colour, V: Variant> Pipeline<C, V> {
    /// Traces a batch and adds its samples to the pixels of `tile`.
    pub fn trace(&mut self, engine: &Engine, job: &TileJob, tile: &mut FilmTile) {
        let mut stopwatch = Stopwatch::start();
        let mut sampler = Sampler::new(engine.settings.sampler, job.key);
        camera::start::<C, V>(
            engine,
            job,
            tile,
            &mut sampler,
            &mut self.paths,
            &mut self.segments,
        );
        stopwatch.lap(Stage::Camera, &mut self.statistics.stages);
        self.follow(engine, job, &mut sampler, &mut stopwatch);
        self.expose(engine, job, tile);
        stopwatch.lap(Stage::Splat, &mut self.statistics.stages);
        self.statistics.camera_paths += self.paths.radiance.len() as u64;
    }

    /// Moves the batch from vertex to vertex until no particle is left.
    fn follow(
        &mut self,
        engine: &Engine,
        job: &TileJob,
        sampler: &mut Sampler,
        stopwatch: &mut Stopwatch,
    ) {
        let max_depth = engine.settings.max_depth.unwrap_or(u32::MAX);
        let next_event = engine.settings.direct_light == DirectLight::NextEvent
            && !engine.scene.emitters.is_empty();
        for depth in 0..max_depth {
            if self.segments.len() == 0 {
                return;
            }
            if depth == MAX_BOUNCES {
                self.statistics.dropped.endless += 1;
                return;
            }
            let camera_rays = depth == 0;
            let coherence = if camera_rays {
                Coherence::Coherent
            } else {
                Coherence::Incoherent
            };
            if let Some(recorded) = &mut self.recorded {
                recorded.segments.push(self.segments.rays.clone());
            }
            intersect::nearest(
                &engine.accelerator,
                coherence,
                &mut self.segments,
                &mut self.statistics,
            );
            if camera_rays && engine.settings.hide_emitters {
                hidden_emitters::look_through(engine, &mut self.segments, &mut self.statistics);
            }
            stopwatch.lap(Stage::Intersect, &mut self.statistics.stages);
            let scatters = depth + 1 < max_depth;
            emission::arrive(
                engine,
                &mut self.paths,
                &self.segments,
                &mut self.vertices,
                sampler,
                depth,
                scatters,
            );
            stopwatch.lap(Stage::Emission, &mut self.statistics.stages);
            self.statistics.vertices += self.vertices.len() as u64;
            self.statistics.deepest = self.statistics.deepest.max(depth + 1);
            if next_event {
                direct::sample_lights(
                    engine,
                    &self.paths,
                    &self.vertices,
                    depth,
                    sampler,
                    &mut self.shadow,
                );
                stopwatch.lap(Stage::Direct, &mut self.statistics.stages);
                if let Some(recorded) = &mut self.recorded {
                    recorded.shadows.push(self.shadow.rays.clone());
                }
                intersect::occluded(&engine.accelerator, &mut self.shadow, &mut self.statistics);
                stopwatch.lap(Stage::Intersect, &mut self.statistics.stages);
                direct::add_unoccluded(&self.shadow, &mut self.paths);
                stopwatch.lap(Stage::Direct, &mut self.statistics.stages);
            }
            self.statistics.walk += walk_stage::decide(
                engine.strategy(),
                &self.vertices,
                job.samples,
                depth,
                &mut self.particles,
                sampler,
                &mut self.offspring,
            );
            if engine.settings.samples.directions != 1 {
                self.offspring
                    .split_each(engine.settings.samples.directions);
            }
            stopwatch.lap(Stage::Walk, &mut self.statistics.stages);
            scatter::scatter(
                engine,
                &self.vertices,
                self.offspring.children(),
                depth,
                sampler,
                &mut self.segments,
            );
            stopwatch.lap(Stage::Scatter, &mut self.statistics.stages);
        }
    }

    /// Adds the finished camera paths to their pixels.
    fn expose(&mut self, engine: &Engine, job: &TileJob, tile: &mut FilmTile) {
        match &mut tile.pixels {
            TilePixels::Single(pixels) => self.expose_pixels(engine, job, pixels),
            TilePixels::Double(pixels) => self.expose_pixels(engine, job, pixels),
            TilePixels::Compensated(pixels) => self.expose_pixels(engine, job, pixels),
        }
        if let Some(moments) = &mut tile.second_moments {
            self.expose_moments(job, moments);
        }
    }

    /// Adds the squares of the finished camera paths to their pixels.
    fn expose_moments(&self, job: &TileJob, moments: &mut SecondMoments) {
        for path in 0..self.paths.radiance.len() {
            if let Ok(radiance) = finished(self.paths.radiance[path]) {
                let rgb = C::to_rgb(radiance, &self.paths.wavelengths[path]).map(f64::from);
                let weight = f64::from(self.paths.filter_weight[path]);
                moments.add(path / job.samples as usize, xyz_from_srgb(rgb), weight);
            }
        }
    }

    fn expose_pixels<A: Accumulator>(
        &mut self,
        engine: &Engine,
        job: &TileJob,
        pixels: &mut [PixelStatistics<A>],
    ) {
        let samples = job.samples as usize;
        // Paths of one population, or of one sequence, are not independent of each other: together they are one unit.
        let joint = matches!(engine.strategy.scope(), Scope::Pixel | Scope::Tile)
            || engine.settings.sampler != SamplerKind::Independent;
        for (index, pixel) in pixels.iter_mut().enumerate() {
            let mut sum = [A::default(); 3];
            for path in index * samples..(index + 1) * samples {
                let rgb = self.sample(path);
                if joint {
                    for (sum, value) in sum.iter_mut().zip(rgb) {
                        sum.add(value);
                    }
                } else {
                    pixel.add_unit(1, rgb);
                }
            }
            if joint {
                pixel.add_unit(job.samples, sum.map(A::total));
            }
        }
    }

    /// The colour of a finished camera path; black, and counted, where it is no radiance.
    fn sample(&mut self, path: usize) -> [f64; 3] {
        let dropped = &mut self.statistics.dropped;
        match finished(self.paths.radiance[path]) {
            Ok(radiance) => {
                let weight = f64::from(self.paths.filter_weight[path]);
                return C::to_rgb(radiance, &self.paths.wavelengths[path])
                    .map(|v| f64::from(v) * weight);
            }
            Err(NoRadiance::Nan) => dropped.nan += 1,
            Err(NoRadiance::Infinite) => dropped.infinite += 1,
            Err(NoRadiance::Negative) => dropped.negative += 1,
        }
        [0.0; 3]
    }
}

/// Why a path's sum is no radiance.
enum NoRadiance {
    Nan,
    Infinite,
    Negative,
}

/// The radiance of a finished camera path, if it is one.
fn finished<S: SpectrumArithmetic>(radiance: S) -> Result<S, NoRadiance> {
    let components = radiance.components();
    if components.iter().any(|value| value.is_nan()) {
        Err(NoRadiance::Nan)
    } else if !radiance.is_finite() {
        Err(NoRadiance::Infinite)
    } else if components.iter().any(|&value| value < 0.0) {
        Err(NoRadiance::Negative)
    } else {
        Ok(radiance)
    }
}
