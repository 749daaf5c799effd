//! What all threads watch while a render goes on: the clock, the stop flag and the counts.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use super::{Budget, Ended, Observer, Progress, RenderState, StopFlag};
use crate::embree::flush_denormals_to_zero;
use crate::film::FilmTile;
use crate::transport::{Engine, PathCounts, TileJob, TraceBatches, TraceStatistics};

/// How often an observer hears of the progress.
const OBSERVATION_INTERVAL: Duration = Duration::from_millis(100);

/// Watches over one advance of a render.
pub(super) struct Watch<'a> {
    until: Budget,
    pixels: usize,
    stop: &'a StopFlag,
    observer: &'a dyn Observer,
    /// Time of all advances before.
    before: Duration,
    start: Instant,
    /// Of this advance and all before.
    statistics: Mutex<TraceStatistics>,
    /// Nanoseconds that the latest batch took per camera path.
    path_cost: AtomicU64,
    /// When the observer was last told, in nanoseconds since the start.
    last_observation: AtomicU64,
    ended: Mutex<Option<Ended>>,
}

impl<'a> Watch<'a> {
    /// Starts the clock of an advance of `state`.
    pub fn new(
        state: &RenderState,
        until: Budget,
        stop: &'a StopFlag,
        observer: &'a dyn Observer,
    ) -> Self {
        let statistics = state.statistics;
        let traced = statistics.stages.total().as_nanos() as u64;
        Self {
            until,
            pixels: state.film.size().pixels(),
            stop,
            observer,
            before: state.duration,
            start: Instant::now(),
            statistics: Mutex::new(statistics),
            path_cost: AtomicU64::new(traced / statistics.camera_paths.max(1)),
            last_observation: AtomicU64::new(0),
            ended: Mutex::default(),
        }
    }

    /// Why no more batches are started, once that is so.
    pub fn ended(&self) -> Option<Ended> {
        *unpoisoned(&self.ended)
    }

    /// What was counted in this advance and all before.
    pub fn statistics(&self) -> TraceStatistics {
        *unpoisoned(&self.statistics)
    }

    /// Time of this advance and all before.
    pub fn elapsed(&self) -> Duration {
        self.before + self.start.elapsed()
    }

    /// Whether so many more camera paths of every pixel of `tile` should be traced. Once they should not, nothing more should be.
    pub fn allows(&self, tile: &FilmTile, counts: PathCounts<'_>) -> bool {
        !self.should_stop(counts.of_pixels(0..tile.pixels.count()))
    }

    /// Traces a tile's samples of a pass.
    pub fn trace(
        &self,
        engine: &Engine,
        job: &TileJob,
        tile: &mut FilmTile,
        tracer: &mut dyn TraceBatches,
    ) {
        let counted = self.time(engine, job, tile, tracer);
        self.count(counted);
    }

    /// Traces samples that do not become part of the image: their rays and their time count, their camera paths do not. Returns how many rays there were.
    pub fn trace_aside(
        &self,
        engine: &Engine,
        job: &TileJob,
        tile: &mut FilmTile,
        tracer: &mut dyn TraceBatches,
    ) -> u64 {
        let counted = TraceStatistics {
            camera_paths: 0,
            ..self.time(engine, job, tile, tracer)
        };
        self.count(counted);
        counted.all_rays()
    }

    fn time(
        &self,
        engine: &Engine,
        job: &TileJob,
        tile: &mut FilmTile,
        tracer: &mut dyn TraceBatches,
    ) -> TraceStatistics {
        let paths = job.counts.of_pixels(0..tile.pixels.count());
        let _flushed = flush_denormals_to_zero();
        let start = Instant::now();
        tracer.trace(engine, job, tile);
        self.path_cost
            .store(start.elapsed().as_nanos() as u64 / paths, Ordering::Relaxed);
        tracer.take_statistics()
    }

    fn count(&self, counted: TraceStatistics) {
        let total = {
            let mut total = unpoisoned(&self.statistics);
            *total += counted;
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
            *ended = match self.until {
                _ if self.stop.is_raised() => Some(Ended::Interrupted),
                Budget::Time(limit) if self.elapsed() + expected / 2 >= limit => {
                    Some(Ended::OutOfTime)
                }
                Budget::Rays(limit) if self.statistics().all_rays() >= limit.get() => {
                    Some(Ended::OutOfRays)
                }
                Budget::Time(_) | Budget::Rays(_) | Budget::SamplesPerPixel(_) => None,
            };
        }
        ended.is_some()
    }

    fn observe(&self, total: &TraceStatistics) {
        let (now, last) = (
            self.start.elapsed().as_nanos() as u64,
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
        let elapsed = self.elapsed();
        let samples_per_pixel = total.camera_paths as f64 / self.pixels as f64;
        let share = match self.until {
            Budget::SamplesPerPixel(samples) => samples_per_pixel / f64::from(samples.get()),
            Budget::Time(limit) => {
                elapsed.as_secs_f64() / limit.as_secs_f64().max(f64::MIN_POSITIVE)
            }
            Budget::Rays(limit) => total.all_rays() as f64 / limit.get() as f64,
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
pub(super) fn unpoisoned<T: ?Sized>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
