//! One batch from the camera to its end.

use std::sync::Arc;
use std::time::Instant;

use super::accelerator::Accelerator;
use super::batch::{CameraPaths, Particles, Segments, ShadowRays, Vertices};
use super::recorded_rays::RecordedRays;
use super::settings::{DirectLight, TransportSettings};
use super::statistics::TraceStatistics;
use super::{camera, direct, emission, hidden_emitters, intersect, scatter, walk_stage};
use crate::embree::{Coherence, Version};
use crate::film::{Accumulator, FilmTile, FilterSampler, PixelStatistics, TilePixels};
use crate::sampling::{Sampler, SamplerKind, StreamKey};
use crate::scene::{CameraView, Emitter, LightChoice, Scene};
use crate::spectrum::{Colour, SpectrumArithmetic};
use crate::walk::{Offspring, Scope, Strategy};

/// After so many bounces a batch is cut off and the cut is reported: only light that never dies gets here.
const MAX_BOUNCES: u32 = 1 << 16;

/// A scene ready to be traced, shared by all threads.
pub struct Engine {
    pub(super) scene: Arc<Scene>,
    pub(super) accelerator: Accelerator,
    pub(super) settings: TransportSettings,
    pub(super) strategy: Box<dyn Strategy>,
    pub(super) camera: CameraView,
    pub(super) filter: FilterSampler,
    /// How next-event estimation chooses among the emitters.
    pub(super) light_choice: LightChoice,
    /// Which emitter surrounds the scene; looked up once, for rays that leave the scene ask for it.
    pub(super) surroundings: Option<usize>,
}

/// One batch: some samples of every pixel of a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileJob {
    /// The random numbers of the batch.
    pub key: StreamKey,
    /// Samples per pixel of all batches of the tile before this one.
    pub first_sample: u64,
    /// Camera paths per pixel, positive.
    pub samples: u32,
}

impl Engine {
    /// An engine for `scene`, whose shapes `accelerator` holds.
    pub fn new(
        scene: Arc<Scene>,
        accelerator: Accelerator,
        settings: TransportSettings,
        strategy: Box<dyn Strategy>,
    ) -> Self {
        Self {
            camera: scene.camera.view(scene.film.size),
            filter: FilterSampler::new(&scene.film),
            surroundings: scene.emitters.iter().position(Emitter::surrounds),
            light_choice: LightChoice::new(&scene.emitters, &scene.shapes),
            scene,
            accelerator,
            settings,
            strategy,
        }
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The strategy.
    pub fn strategy(&self) -> &dyn Strategy {
        &*self.strategy
    }

    /// The version of the intersection layer's library.
    pub fn embree_version(&self) -> Version {
        self.accelerator.scene().device().version()
    }
}

/// The memory of one thread: it traces batch after batch.
pub struct Tracer<C: Colour> {
    paths: CameraPaths<C>,
    segments: Segments<C>,
    vertices: Vertices<C>,
    shadow: ShadowRays<C>,
    particles: Particles,
    offspring: Offspring,
    statistics: TraceStatistics,
    /// Where rays are recorded, while they are.
    pub(super) recorded: Option<RecordedRays>,
}

impl<C: Colour> Default for Tracer<C> {
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

/// A tracer of whichever colour.
pub trait TraceBatches: Send {
    /// Traces a batch and adds its samples to the pixels of `tile`. The result depends on nothing but the engine, the
    /// job and the tile.
    fn trace(&mut self, engine: &Engine, job: &TileJob, tile: &mut FilmTile);

    /// What was counted since the last call.
    fn take_statistics(&mut self) -> TraceStatistics;
}

impl<C: Colour> TraceBatches for Tracer<C> {
    fn trace(&mut self, engine: &Engine, job: &TileJob, tile: &mut FilmTile) {
        let start = Instant::now();
        let mut sampler = Sampler::new(engine.settings.sampler, job.key);
        camera::start(
            engine,
            job,
            tile,
            &mut sampler,
            &mut self.paths,
            &mut self.segments,
        );
        self.follow(engine, job, &mut sampler);
        self.expose(engine, job, tile);
        self.statistics.camera_paths += self.paths.radiance.len() as u64;
        self.statistics.total_time += start.elapsed();
    }

    fn take_statistics(&mut self) -> TraceStatistics {
        std::mem::take(&mut self.statistics)
    }
}

impl<C: Colour> Tracer<C> {
    /// Moves the batch from vertex to vertex until no particle is left.
    fn follow(&mut self, engine: &Engine, job: &TileJob, sampler: &mut Sampler) {
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
                if let Some(recorded) = &mut self.recorded {
                    recorded.shadows.push(self.shadow.rays.clone());
                }
                intersect::occluded(&engine.accelerator, &mut self.shadow, &mut self.statistics);
                direct::add_unoccluded(&self.shadow, &mut self.paths);
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
            scatter::scatter(
                engine,
                &self.vertices,
                self.offspring.children(),
                depth,
                sampler,
                &mut self.segments,
            );
        }
    }

    /// Adds the finished camera paths to their pixels.
    fn expose(&mut self, engine: &Engine, job: &TileJob, tile: &mut FilmTile) {
        match &mut tile.pixels {
            TilePixels::Single(pixels) => self.expose_pixels(engine, job, pixels),
            TilePixels::Double(pixels) => self.expose_pixels(engine, job, pixels),
            TilePixels::Compensated(pixels) => self.expose_pixels(engine, job, pixels),
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
        let radiance = self.paths.radiance[path];
        let dropped = &mut self.statistics.dropped;
        let components = radiance.components();
        if components.iter().any(|value| value.is_nan()) {
            dropped.nan += 1;
        } else if !radiance.is_finite() {
            dropped.infinite += 1;
        } else if components.iter().any(|&value| value < 0.0) {
            dropped.negative += 1;
        } else {
            let weight = f64::from(self.paths.filter_weight[path]);
            return C::to_rgb(radiance, &self.paths.wavelengths[path])
                .map(|v| f64::from(v) * weight);
        }
        [0.0; 3]
    }
}
