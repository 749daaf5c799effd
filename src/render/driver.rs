//! Passes over tiles, until the budget is used up or somebody asks to stop.

use std::num::{NonZeroU32, NonZeroUsize};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use thiserror::Error;

use super::allocation::Allocation;
use super::trial::Trial;
use super::watch::{Watch, unpoisoned};
use super::{Budget, Ended, Observer, Outcome, RenderState, Schedule, Settings, StopFlag, memory};
use crate::embree::EmbreeError;
use crate::film::Film;
use crate::learning::{Experience, Gathering, Knowledge, Reliance};
use crate::sampling::StreamKey;
use crate::scene::{Emitter, Scene};
use crate::transport::{
    Accelerator, AcceleratorOptions, DirectLight, Engine, PathCounts, TileJob, TraceBatches,
    TransportSettings,
};
use crate::walk::FixedDepth;

/// The most threads that a render takes: more are a mistake.
pub const MAX_THREADS: usize = 1024;

/// Why a render cannot start.
#[derive(Debug, Error)]
pub enum RenderError {
    /// The intersection layer refused the scene.
    #[error("the acceleration structure could not be built: {0}")]
    Accelerator(#[from] EmbreeError),
    /// The threads could not be started.
    #[error("the rendering threads could not be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// More threads than make sense.
    #[error("{0} threads are too many; there can be from 1 to {MAX_THREADS}")]
    TooManyThreads(NonZeroUsize),
    /// An image that does not fit into memory.
    #[error(
        "an image of {width} x {height} pixels needs {needed:.1} GiB of memory, and {available:.1} GiB are free; make it smaller or render it in crop windows"
    )]
    OutOfMemory {
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// GiB that the film and its files need.
        needed: f64,
        /// GiB that the system can give.
        available: f64,
    },
    /// Paths that never end.
    #[error(
        "the strategy `{}` never ends a path, so it needs a maximal depth (`--max-depth` or `max_depth` of the integrator)",
        FixedDepth::NAME
    )]
    EndlessPaths,
    /// Lights that can only be found by next-event estimation, which is off.
    #[error(
        "the scene has a light without extent (`point`, `spot` or `directional`), which paths cannot hit: it needs next-event estimation (`--direct next-event`)"
    )]
    UnreachableLight,
}

/// A render that is ready to run: its acceleration structure is built.
pub struct Render {
    engine: Engine,
    settings: Settings,
    pool: rayon::ThreadPool,
    /// One for each thread of the pool.
    tracers: Vec<Mutex<Box<dyn TraceBatches>>>,
    build_time: Duration,
}

impl Render {
    /// Prepares to render `scene`.
    ///
    /// # Errors
    /// Settings that do not fit the scene, and an acceleration structure that cannot be built.
    pub fn new(scene: Arc<Scene>, mut settings: Settings) -> Result<Self, RenderError> {
        let max_depth = settings
            .max_depth
            .map(NonZeroU32::get)
            .or(scene.integrator.max_depth);
        if max_depth.is_none() && settings.strategy.name() == FixedDepth::NAME {
            return Err(RenderError::EndlessPaths);
        }
        if settings.threads.get() > MAX_THREADS {
            return Err(RenderError::TooManyThreads(settings.threads));
        }
        memory::check(scene.film.crop.size, scene.integrator.moments.is_some())?;
        let has_delta_light = scene.emitters.iter().any(Emitter::is_delta);
        if has_delta_light && settings.direct_light == DirectLight::Off {
            return Err(RenderError::UnreachableLight);
        }
        let start = Instant::now();
        let accelerator = Accelerator::new(
            &scene,
            AcceleratorOptions {
                threads: settings.threads,
                quality: settings.build_quality,
                robust: settings.robust,
            },
        )?;
        let build_time = start.elapsed();
        let transport = TransportSettings {
            max_depth,
            direct_light: if scene.integrator.samples.emitters == 0 {
                DirectLight::Off
            } else {
                settings.direct_light
            },
            samples: scene.integrator.samples,
            sampler: settings.sampler,
            guiding: settings.guiding,
            hide_emitters: scene.integrator.hide_emitters,
        };
        let strategy = std::mem::replace(&mut settings.strategy, Box::new(FixedDepth));
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(settings.threads.get())
            .thread_name(|index| format!("render {index}"))
            .build()?;
        let engine = Engine::new(scene, accelerator, transport, strategy);
        let tracers = (0..settings.threads.get())
            .map(|_| Mutex::new(settings.colour.tracer()))
            .collect();
        Ok(Self {
            engine,
            settings,
            pool,
            tracers,
            build_time,
        })
    }

    /// The engine, with the scene and the strategy.
    pub fn engine(&self) -> &Engine {
        &self.engine
    }

    /// The settings; the strategy is the engine's.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Whether guiding or the strategy asks for what can be learned.
    fn learns(&self) -> bool {
        self.settings.guiding || self.engine.strategy().learns()
    }

    /// What is to be tried of what it learns, if anything is.
    fn trial(&self) -> Option<Trial> {
        let size = self.engine.scene().film.crop.size;
        let counts = self.engine.strategy().learns();
        let is_wanted = self.settings.trial && self.learns();
        is_wanted.then(|| Trial::new(Film::tile_count(size), counts, self.settings.guiding))
    }

    /// Whether the scene asks for the second moments of its samples.
    fn asks_for_moments(&self) -> bool {
        self.engine.scene().integrator.moments.is_some()
    }

    /// How long the acceleration structure took to build.
    pub fn build_time(&self) -> Duration {
        self.build_time
    }

    /// Renders until the budget is used up or `stop` is raised.
    ///
    /// With a budget of samples the film depends on the scene, the settings and the seed alone, not on the number of
    /// threads; with other budgets each pixel does, given its number of samples.
    pub fn run(&self, stop: &StopFlag, observer: &dyn Observer) -> Outcome {
        let mut state = self.start(self.settings.seed);
        let ended = self.advance(&mut state, self.settings.budget, stop, observer);
        state.into_outcome(ended)
    }

    /// A render that has not traced anything, with this seed of all random streams instead of that of the settings.
    pub fn start(&self, seed: u64) -> RenderState {
        let size = self.engine.scene().film.crop.size;
        let film = Film::new(size, self.settings.film_sums);
        let film = if self.asks_for_moments() {
            film.with_second_moments()
        } else {
            film
        };
        let knowledge = self
            .learns()
            .then(|| Knowledge::nothing(self.engine.bounds(), size));
        let allocation = self.settings.adaptive.then(|| Allocation::new(&film));
        RenderState::new(film, knowledge, self.schedule().lessons(), allocation, seed)
    }

    /// The passes of a render that begins with the budget of the settings.
    fn schedule(&self) -> Schedule {
        let Settings {
            budget, sampler, ..
        } = self.settings;
        let pixels = self.engine.scene().film.crop.size.pixels();
        Schedule::new(budget, sampler, self.learns(), pixels)
    }

    /// Whether [`advance`](Self::advance) can go on from `state`, which may come from a file: whether its image has the
    /// size and the sums of this render's, and whether both learn and adapt. That scene and settings are the same is for the caller to know.
    pub fn fits(&self, state: &RenderState) -> bool {
        let size = self.engine.scene().film.crop.size;
        let (sums, moments) = (self.settings.film_sums, self.asks_for_moments());
        state.film.is_like_new(size, sums, moments)
            && state.pass.done.len() == state.film.tiles().len()
            && state.knowledge.is_some() == self.learns()
            && state.allocation.is_some() == self.settings.adaptive
            && (state.allocation.iter()).all(|allocation| allocation.fits(&state.film))
    }

    /// Goes on with a render until it has used up `until`, which is counted from its very start and over all pixels, or
    /// until `stop` is raised.
    ///
    /// The passes are those of the settings' budget; with a number of samples there they have an end, otherwise not.
    /// `until` only says how far to go: where it is time or rays, the render may pause within a pass, which the next
    /// advance goes on with; where it is a number of samples, the last pass is made as short as it needs.
    /// So a pixel depends on its number of samples alone, and not on where renders paused by time or rays.
    ///
    /// A batch that would end after the time of `until` is started only if the greater part of it lies before. As time
    /// is counted from the start, what one advance takes too long is taken from the next.
    ///
    /// # Panics
    /// If `state` does not [fit](Self::fits). One that [`start`](Self::start) made does.
    pub fn advance(
        &self,
        state: &mut RenderState,
        until: Budget,
        stop: &StopFlag,
        observer: &dyn Observer,
    ) -> Ended {
        assert!(self.fits(state), "the state is of another image");
        let watch = Watch::new(state, until, stop, observer);
        let schedule = self.schedule().with_lessons(state.lessons);
        let trial = self.trial();
        let ended = self.pool.install(|| {
            loop {
                let is_due = |trial: &&Trial| {
                    !state.pass.is_under_way()
                        && !schedule.teaches(state.pass.before)
                        && trial.is_due(state.pass.before, self.settings.budget)
                };
                if state.reliance.is_none()
                    && let Some(trial) = trial.as_ref().filter(is_due)
                {
                    trial.advance(&self.engine, state, &self.tracers, &watch);
                    if let Some(ended) = watch.ended() {
                        break ended;
                    }
                }
                let is_new = !state.pass.is_under_way();
                if !state.pass.plan(schedule, until) {
                    break Ended::Complete;
                }
                let teaches = schedule.teaches(state.pass.before);
                let learns = state.knowledge.is_some() && teaches;
                if let Some(allocation) = state.allocation.as_mut().filter(|_| is_new) {
                    let objective = self.engine.strategy().objective();
                    let before = (!learns).then_some(state.pass.before);
                    allocation.plan(&state.film, objective, before, state.pass.samples);
                }
                let samples = f64::from(state.pass.samples);
                let weight = schedule.weight(state.pass.before) * samples;
                self.trace_pass(state, learns, weight, &watch);
                if state.pass.finish() {
                    if let Some(allocation) = &mut state.allocation {
                        allocation.finish(weight, state.pass.samples);
                    }
                    if learns && let Some(knowledge) = &mut state.knowledge {
                        knowledge.learn();
                        if !schedule.teaches(state.pass.before) {
                            knowledge.conclude();
                        }
                    }
                }
                if let Some(ended) = watch.ended() {
                    break ended;
                }
            }
        });
        state.statistics = watch.statistics();
        state.duration = watch.elapsed();
        ended
    }

    /// Traces what is left of a pass, in which the samples of a pixel have this `weight` together. Passes follow each other, so that every pixel adds up its passes in the same
    /// order. Where the render `learns` from it, tiles are begun in their order, so that few wait for those before them.
    fn trace_pass(&self, state: &mut RenderState, learns: bool, weight: f64, watch: &Watch) {
        let pass = &mut state.pass;
        let first = pass.done.iter().position(|done| !done).unwrap_or(0);
        let experience = match &mut state.knowledge {
            Some(knowledge) if learns => knowledge.take_experience(),
            _ => Experience::default(),
        };
        let gathering = Mutex::new(Gathering::new(experience, first));
        let knowledge = state.knowledge.as_ref();
        let reliance = state.reliance.unwrap_or(Reliance::ALL);
        let film = state.film.size();
        let tiles = state.film.tiles_mut().iter_mut().zip(&mut pass.done);
        let missing = tiles.enumerate().filter(|(_, (_, done))| !**done);
        let missing = Mutex::new(missing.peekable());
        let allocation = state.allocation.as_ref();
        let counts = |tile: usize| match allocation {
            Some(allocation) => allocation.counts(tile, pass.samples),
            None => PathCounts::Even(pass.samples),
        };
        rayon::broadcast(|context| {
            let tracer = &mut **unpoisoned(&self.tracers[context.index()]);
            loop {
                let next = unpoisoned(&missing)
                    .next_if(|(index, (tile, _))| watch.allows(tile, counts(*index)));
                let Some((index, (tile, done))) = next else {
                    break;
                };
                let key = StreamKey {
                    seed: state.seed,
                    tile: index as u32,
                    pass: pass.index,
                };
                let job = TileJob {
                    key,
                    counts: counts(index),
                    weight,
                    knowledge,
                    learns,
                    reliance,
                };
                watch.trace(&self.engine, &job, tile, tracer);
                *done = true;
                if learns {
                    let mut observations = tracer.take_observations();
                    for pixel in &mut observations.pixels {
                        let (x, y) = tile.position(pixel.pixel as usize);
                        pixel.pixel = y * film.width + x;
                    }
                    unpoisoned(&gathering).add(index, observations);
                }
            }
        });
        if learns && let Some(knowledge) = &mut state.knowledge {
            let gathering = gathering
                .into_inner()
                .unwrap_or_else(PoisonError::into_inner);
            knowledge.give_back(gathering.into_experience());
        }
    }
}
