//! Passes over tiles, until the budget is used up or somebody asks to stop.

use std::num::{NonZeroU32, NonZeroUsize};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use rayon::prelude::*;
use thiserror::Error;

use super::{Budget, ColourMode, Observer, Progress, Schedule, Settings, StopFlag, memory};
use crate::embree::{EmbreeError, flush_denormals_to_zero};
use crate::film::{Film, FilmTile};
use crate::sampling::StreamKey;
use crate::scene::{Emitter, Scene};
use crate::spectrum::{Colour, Rgb, Spectral};
use crate::transport::{
    Accelerator, AcceleratorOptions, DirectLight, Engine, TileJob, TraceStatistics, Tracer,
    TransportSettings,
};
use crate::walk::FixedDepth;

/// How often an observer hears of the progress.
const OBSERVATION_INTERVAL: Duration = Duration::from_millis(100);

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
        "the scene has a point light, which paths cannot hit: it needs next-event estimation (`--direct next-event`)"
    )]
    UnreachableLight,
}

/// Why a render ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// Every pixel has its samples.
    Complete,
    /// The time is used up.
    OutOfTime,
    /// Somebody asked to stop.
    Interrupted,
}

impl Ended {
    /// The name in metadata.
    pub fn name(self) -> &'static str {
        match self {
            Self::Complete => "complete",
            Self::OutOfTime => "out of time",
            Self::Interrupted => "interrupted",
        }
    }
}

/// What a render made.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The image and what is known of its noise.
    pub film: Film,
    /// What was counted.
    pub statistics: TraceStatistics,
    /// Wall-clock time of tracing.
    pub duration: Duration,
    /// Why it ended.
    pub ended: Ended,
}

/// A render that is ready to run: its acceleration structure is built.
pub struct Render {
    engine: Engine,
    settings: Settings,
    pool: rayon::ThreadPool,
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
        memory::check(scene.film.crop.size)?;
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
            direct_light: settings.direct_light,
            hide_emitters: scene.integrator.hide_emitters,
        };
        let strategy = std::mem::replace(&mut settings.strategy, Box::new(FixedDepth));
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(settings.threads.get())
            .thread_name(|index| format!("render {index}"))
            .build()?;
        let engine = Engine::new(scene, accelerator, transport, strategy);
        Ok(Self {
            engine,
            settings,
            pool,
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

    /// Takes another seed for the next run: the same image with other noise, without building anything again.
    pub fn reseed(&mut self, seed: u64) {
        self.settings.seed = seed;
    }

    /// How long the acceleration structure took to build.
    pub fn build_time(&self) -> Duration {
        self.build_time
    }

    /// Renders until the budget is used up or `stop` is raised.
    ///
    /// With a budget of samples the film depends on the scene, the settings and the seed alone, not on the number of
    /// threads; with a budget of time each pixel does, given its number of samples.
    pub fn run(&self, stop: &StopFlag, observer: &dyn Observer) -> Outcome {
        match self.settings.colour {
            ColourMode::Spectral => self.run_in::<Spectral<4>>(stop, observer),
            ColourMode::Rgb => self.run_in::<Rgb>(stop, observer),
        }
    }

    fn run_in<C: Colour>(&self, stop: &StopFlag, observer: &dyn Observer) -> Outcome {
        let mut film = Film::new(self.engine.scene().film.crop.size);
        let watch = Watch::new(self.settings.budget, film.size().pixels(), stop, observer);
        let schedule = Schedule::new(self.settings.budget);
        let tracers: Vec<Mutex<Tracer<C>>> = (0..self.settings.threads.get())
            .map(|_| Mutex::default())
            .collect();
        let seed = self.settings.seed;
        self.pool.install(|| {
            for (pass, samples) in (0..).map_while(|pass| Some((pass, schedule.samples(pass)?))) {
                // Passes follow each other, so that every pixel adds up its passes in the same order.
                film.tiles_mut()
                    .par_iter_mut()
                    .with_max_len(1)
                    .enumerate()
                    .for_each(|(index, tile)| {
                        let tracer = &tracers[rayon::current_thread_index().unwrap_or(0)];
                        let key = StreamKey {
                            seed,
                            tile: index as u32,
                            pass,
                        };
                        let job = TileJob { key, samples };
                        watch.trace(&self.engine, &job, tile, &mut unpoisoned(tracer));
                    });
                if watch.ended().is_some() {
                    break;
                }
            }
        });
        Outcome {
            statistics: *unpoisoned(&watch.statistics),
            duration: watch.start.elapsed(),
            ended: watch.ended().unwrap_or(Ended::Complete),
            film,
        }
    }
}

/// What all threads watch while a render runs: the clock, the stop flag and the counts.
struct Watch<'a> {
    budget: Budget,
    pixels: usize,
    stop: &'a StopFlag,
    observer: &'a dyn Observer,
    start: Instant,
    statistics: Mutex<TraceStatistics>,
    /// Nanoseconds that the latest batch took per camera path.
    path_cost: AtomicU64,
    /// When the observer was last told, in nanoseconds since the start.
    last_observation: AtomicU64,
    ended: Mutex<Option<Ended>>,
}

impl<'a> Watch<'a> {
    fn new(budget: Budget, pixels: usize, stop: &'a StopFlag, observer: &'a dyn Observer) -> Self {
        Self {
            budget,
            pixels,
            stop,
            observer,
            start: Instant::now(),
            statistics: Mutex::default(),
            path_cost: AtomicU64::new(0),
            last_observation: AtomicU64::new(0),
            ended: Mutex::default(),
        }
    }

    fn ended(&self) -> Option<Ended> {
        *unpoisoned(&self.ended)
    }

    /// Traces a batch, unless it is time to stop.
    fn trace<C: Colour>(
        &self,
        engine: &Engine,
        job: &TileJob,
        tile: &mut FilmTile,
        tracer: &mut Tracer<C>,
    ) {
        let paths = tile.pixels.len() as u64 * u64::from(job.samples);
        if self.should_stop(paths) {
            return;
        }
        let _flushed = flush_denormals_to_zero();
        let start = Instant::now();
        tracer.trace(engine, job, tile);
        self.path_cost
            .store(start.elapsed().as_nanos() as u64 / paths, Ordering::Relaxed);
        let total = {
            let mut total = unpoisoned(&self.statistics);
            *total += tracer.take_statistics();
            *total
        };
        self.observe(&total);
    }

    /// Whether a batch of so many camera paths should not be started any more. A batch that would end after the
    /// deadline is started only if the greater part of it lies before.
    fn should_stop(&self, paths: u64) -> bool {
        let mut ended = unpoisoned(&self.ended);
        if ended.is_none() {
            let expected =
                Duration::from_nanos(self.path_cost.load(Ordering::Relaxed).saturating_mul(paths));
            *ended = match self.budget {
                _ if self.stop.is_raised() => Some(Ended::Interrupted),
                Budget::Time(limit) if self.start.elapsed() + expected / 2 >= limit => {
                    Some(Ended::OutOfTime)
                }
                Budget::Time(_) | Budget::SamplesPerPixel(_) => None,
            };
        }
        ended.is_some()
    }

    fn observe(&self, total: &TraceStatistics) {
        let elapsed = self.start.elapsed();
        let (now, last) = (
            elapsed.as_nanos() as u64,
            self.last_observation.load(Ordering::Relaxed),
        );
        let due = now.saturating_sub(last) >= OBSERVATION_INTERVAL.as_nanos() as u64;
        // Of several threads that find it due, the one that sets the time tells the observer.
        if !due
            || self
                .last_observation
                .compare_exchange(last, now, Ordering::Relaxed, Ordering::Relaxed)
                .is_err()
        {
            return;
        }
        let samples_per_pixel = total.camera_paths as f64 / self.pixels as f64;
        let share = match self.budget {
            Budget::SamplesPerPixel(samples) => samples_per_pixel / f64::from(samples.get()),
            Budget::Time(limit) => {
                elapsed.as_secs_f64() / limit.as_secs_f64().max(f64::MIN_POSITIVE)
            }
        };
        self.observer.progress(&Progress {
            share: share.clamp(0.0, 1.0),
            elapsed,
            camera_paths: total.camera_paths,
            rays: total.all_rays(),
            samples_per_pixel,
        });
    }
}

/// A panic in one batch ends the render anyway; until then what the lock holds is still the best there is.
fn unpoisoned<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
