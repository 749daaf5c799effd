//! Tracers: who renders batches, in whichever variant of the engine the scene calls for.

use super::engine::{Engine, TileJob};
use super::general::General;
use super::matte::Matte;
use super::pipeline::Pipeline;
use super::recorded_rays::RecordedRays;
use super::statistics::TraceStatistics;
use crate::film::FilmTile;
use crate::learning::Observations;
use crate::spectrum::Colour;

/// One thread's tracer: it traces batch after batch.
pub struct Tracer<C: Colour> {
    /// The pipeline that was used last.
    pipeline: AnyPipeline<C>,
}

enum AnyPipeline<C: Colour> {
    Matte(Box<Pipeline<C, Matte>>),
    General(Box<Pipeline<C, General>>),
}

/// Does the same with whichever pipeline there is.
macro_rules! dispatch {
    ($any:expr, $pipeline:ident => $call:expr) => {
        match $any {
            AnyPipeline::Matte($pipeline) => $call,
            AnyPipeline::General($pipeline) => $call,
        }
    };
}

impl<C: Colour> Default for Tracer<C> {
    fn default() -> Self {
        Self {
            pipeline: AnyPipeline::Matte(Box::default()),
        }
    }
}

/// A tracer of whichever colour.
pub trait TraceBatches: Send {
    /// Traces a batch and adds its samples to the pixels of `tile`. The result depends on nothing but the engine, the
    /// job and the tile.
    fn trace(&mut self, engine: &Engine, job: &TileJob<'_>, tile: &mut FilmTile);

    /// What was observed since the last call, of jobs to be [learned from](TileJob::learns); pixels are numbered within the tile.
    fn take_observations(&mut self) -> Observations;

    /// What was counted since the last call.
    fn take_statistics(&mut self) -> TraceStatistics;
}

impl<C: Colour> TraceBatches for Tracer<C> {
    fn trace(&mut self, engine: &Engine, job: &TileJob<'_>, tile: &mut FilmTile) {
        self.prepare(engine);
        dispatch!(&mut self.pipeline, pipeline => pipeline.trace(engine, job, tile));
    }

    fn take_observations(&mut self) -> Observations {
        dispatch!(&mut self.pipeline, pipeline => std::mem::take(&mut pipeline.lineage.observed))
    }

    fn take_statistics(&mut self) -> TraceStatistics {
        dispatch!(&mut self.pipeline, pipeline => std::mem::take(&mut pipeline.statistics))
    }
}

impl<C: Colour> Tracer<C> {
    /// Traces a batch as [`TraceBatches::trace`] does, and returns its rays.
    pub fn record(
        &mut self,
        engine: &Engine,
        job: &TileJob<'_>,
        tile: &mut FilmTile,
    ) -> RecordedRays {
        self.prepare(engine);
        dispatch!(&mut self.pipeline, pipeline => {
            pipeline.recorded = Some(RecordedRays::default());
            pipeline.trace(engine, job, tile);
            pipeline.recorded.take().unwrap_or_default()
        })
    }

    /// Takes the pipeline that `engine` calls for.
    fn prepare(&mut self, engine: &Engine) {
        let counted = match (&mut self.pipeline, engine.is_matte) {
            (AnyPipeline::Matte(_), true) | (AnyPipeline::General(_), false) => return,
            (AnyPipeline::Matte(old), false) => old.statistics,
            (AnyPipeline::General(old), true) => old.statistics,
        };
        self.pipeline = if engine.is_matte {
            AnyPipeline::Matte(Box::default())
        } else {
            AnyPipeline::General(Box::default())
        };
        dispatch!(&mut self.pipeline, pipeline => pipeline.statistics = counted);
    }
}
