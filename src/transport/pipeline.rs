//! One batch from the camera to its end.

use std::ops::Range;

use super::arrange::Arrangement;
use super::batch::{CameraPaths, Segments, ShadowRays, Vertices};
use super::engine::{Engine, TileJob};
use super::lineage::Lineage;
use super::path_counts::PathCounts;
use super::recorded_rays::RecordedRays;
use super::settings::DirectLight;
use super::stages::{Stage, Stopwatch};
use super::statistics::TraceStatistics;
use super::variant::Variant;
use super::walk_stage::Decision;
use super::{
    camera, direct, emission, hidden_emitters, intersect, remember, scatter, splat, walk_stage,
};
use crate::embree::Coherence;
use crate::film::FilmTile;
use crate::learning::Knowledge;
use crate::sampling::Sampler;
use crate::spectrum::Colour;
use crate::walk::Scope;

/// After so many bounces a batch is cut off and the cut is reported: only light that never dies gets here.
const MAX_BOUNCES: u32 = 1 << 16;

/// The most camera paths of a batch in which populations are sorted, or pixels have numbers of their own, but those of one pixel stay together: so many fit
/// the cache, and more do not make rays faster.
const BATCH: u32 = 4096;

/// The stages in a row, and the memory of one thread: it traces batch after batch.
pub(super) struct Pipeline<C: Colour, V: Variant> {
    paths: CameraPaths<C>,
    arrangement: Arrangement<C>,
    segments: Segments<C>,
    vertices: Vertices<C, V>,
    shadow: ShadowRays<C>,
    decision: Decision,
    /// What was observed.
    pub lineage: Lineage,
    /// What was counted so far.
    pub statistics: TraceStatistics,
    /// Where rays are recorded, while they are.
    pub recorded: Option<RecordedRays>,
}

impl<C: Colour, V: Variant> Default for Pipeline<C, V> {
    fn default() -> Self {
        Self {
            paths: CameraPaths::new(),
            arrangement: Arrangement::default(),
            segments: Segments::new(),
            vertices: Vertices::new(),
            shadow: ShadowRays::new(),
            decision: Decision::default(),
            lineage: Lineage::default(),
            statistics: TraceStatistics::default(),
            recorded: None,
        }
    }
}

impl<C: Colour, V: Variant> Pipeline<C, V> {
    /// Traces a tile's samples of a pass and adds them to its pixels, batch by batch.
    pub fn trace(&mut self, engine: &Engine, job: &TileJob<'_>, tile: &mut FilmTile) {
        let lessons = job.knowledge.map_or(0, Knowledge::lessons);
        let mut sampler = Sampler::new(engine.settings.sampler, job.key, lessons);
        let pixels = tile.pixels.count() as u32;
        // Where pixels have numbers of their own, a tile may have many times the paths of others.
        let is_population = engine.strategy.scope() == Scope::Tile;
        let is_uneven = matches!(job.counts, PathCounts::Each(_));
        let is_cut = engine.sorts() || (is_uneven && !is_population);
        let mut first = 0;
        while first < pixels {
            let next = if is_cut {
                end_of_batch(job.counts, first, pixels)
            } else {
                pixels
            };
            self.trace_pixels(engine, job, tile, first..next, &mut sampler);
            first = next;
        }
    }

    /// Traces one batch: that of some pixels of the tile.
    fn trace_pixels(
        &mut self,
        engine: &Engine,
        job: &TileJob<'_>,
        tile: &mut FilmTile,
        pixels: Range<u32>,
        sampler: &mut Sampler,
    ) {
        let mut stopwatch = Stopwatch::start();
        camera::start::<C, V>(
            engine,
            job,
            tile,
            pixels,
            sampler,
            &mut self.paths,
            &mut self.segments,
        );
        stopwatch.lap(Stage::Camera, &mut self.statistics.stages);
        if let Some(knowledge) = job.knowledge_for_counts(engine) {
            let width = engine.scene().film.crop.size.width;
            self.paths.find_brightness(knowledge, tile, width);
        }
        self.lineage.restart();
        self.follow(engine, job, sampler, &mut stopwatch);
        if job.learns {
            self.lineage.conclude(&self.paths);
            stopwatch.lap(Stage::Learn, &mut self.statistics.stages);
        }
        splat::expose(
            engine,
            job.weight,
            &mut self.paths,
            tile,
            &mut self.statistics.dropped,
        );
        stopwatch.lap(Stage::Splat, &mut self.statistics.stages);
        self.statistics.camera_paths += self.paths.radiance.len() as u64;
    }

    /// Moves the batch from vertex to vertex until no particle is left.
    fn follow(
        &mut self,
        engine: &Engine,
        job: &TileJob<'_>,
        sampler: &mut Sampler,
        stopwatch: &mut Stopwatch,
    ) {
        let max_depth = engine.settings.max_depth.unwrap_or(u32::MAX);
        let next_event = engine.settings.direct_light == DirectLight::NextEvent
            && !engine.scene.emitters.is_empty();
        let guide = job.knowledge_for_guiding(engine);
        let memory = job.knowledge_for_counts(engine);
        let remembers = job.learns || guide.is_some() || memory.is_some();
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
            if engine.sorts() {
                self.arrangement.arrange(&self.paths, &mut self.segments);
                stopwatch.lap(Stage::Arrange, &mut self.statistics.stages);
            }
            if job.learns {
                self.lineage.begin(&self.segments);
            }
            emission::arrive(
                engine,
                &mut self.paths,
                &self.segments,
                &mut self.vertices,
                sampler,
                job.learns.then(|| self.lineage.youngest()).flatten(),
                guide,
            );
            if depth == 0 && job.learns && sampler.has_sequences() {
                self.lineage.set_seen_aside();
            }
            if let Some(knowledge) = job.knowledge.filter(|_| remembers) {
                remember::remember(knowledge, memory.is_some(), &mut self.vertices);
            }
            stopwatch.lap(Stage::Emission, &mut self.statistics.stages);
            self.statistics.vertices += self.vertices.len() as u64;
            self.statistics.deepest = self.statistics.deepest.max(depth + 1);
            self.statistics.walk += walk_stage::decide(
                engine.strategy(),
                memory,
                &self.paths,
                &self.vertices,
                depth,
                sampler,
                &mut self.decision,
            );
            if engine.settings.samples.directions != 1 {
                let offspring = &mut self.decision.offspring;
                offspring.split_each(engine.settings.samples.directions);
            }
            stopwatch.lap(Stage::Walk, &mut self.statistics.stages);
            if next_event {
                direct::sample_lights(
                    engine,
                    &self.paths,
                    &self.vertices,
                    self.decision.offspring.expected_counts(),
                    sampler,
                    guide,
                    &mut self.shadow,
                );
                stopwatch.lap(Stage::Direct, &mut self.statistics.stages);
                if let Some(recorded) = &mut self.recorded {
                    recorded.shadows.push(self.shadow.rays.clone());
                }
                intersect::occluded(&engine.accelerator, &mut self.shadow, &mut self.statistics);
                stopwatch.lap(Stage::Intersect, &mut self.statistics.stages);
                direct::add_unoccluded(
                    &self.shadow,
                    &mut self.paths,
                    job.learns.then_some(&mut self.lineage),
                );
                stopwatch.lap(Stage::Direct, &mut self.statistics.stages);
            }
            scatter::scatter(
                engine,
                &self.paths,
                &self.vertices,
                self.decision.offspring.children(),
                sampler,
                guide,
                &mut self.segments,
            );
            stopwatch.lap(Stage::Scatter, &mut self.statistics.stages);
        }
    }
}

/// The end of the batch that begins with pixel `first` of so many `pixels`: with the next one it would have more than [`BATCH`] camera paths.
fn end_of_batch(counts: PathCounts<'_>, first: u32, pixels: u32) -> u32 {
    let mut paths = 0;
    let fits = |&pixel: &u32| {
        paths += counts.of_pixel(pixel as usize);
        pixel == first || paths <= BATCH
    };
    first + (first..pixels).take_while(fits).count() as u32
}
