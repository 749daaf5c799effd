//! The engine on one thread, with batches of different sizes in turns.
//!
//! A batch is a tile of 16 x 16 pixels with some samples of each; the driver takes 16 of them. Here the engine is given
//! others. All sizes trace as many paths through the same pixels.

use std::time::Instant;

use cohort::film::{Film, TILE_SIDE};
use cohort::learning::Reliance;
use cohort::sampling::StreamKey;
use cohort::scene::ImageSize;
use cohort::spectrum::{Rgb, Spectral};
use cohort::transport::{Engine, PathCounts, TileJob, TraceBatches, Tracer};
use cohort::{ColourMode, FilmSums, WavelengthCount};

use super::effort::Effort;
use super::rates::Rates;

/// The camera paths of the driver's batches, as a power of two: what the others are compared with.
pub const DRIVER_EXPONENT: u32 = 12;

const PIXEL_EXPONENT: u32 = 2 * TILE_SIDE.ilog2();

/// One size of batches.
pub struct BatchSize {
    /// Camera paths of a batch, as a power of two.
    pub exponent: u32,
    /// One run a round.
    pub runs: Vec<Rates>,
    tracer: Box<dyn TraceBatches>,
}

/// Traces the same number of paths with batches of every size, round by round.
pub fn in_turns(engine: &Engine, colour: ColourMode, effort: Effort) -> Vec<BatchSize> {
    let exponents: &[u32] = effort.choose(
        &[8, DRIVER_EXPONENT],
        &[8, DRIVER_EXPONENT, 16],
        &[8, 10, DRIVER_EXPONENT, 14, 16, 18],
    );
    let tiles_per_axis = effort.choose(1, 1, 2);
    let mut sizes: Vec<_> = exponents
        .iter()
        .map(|&exponent| BatchSize {
            exponent,
            runs: Vec::new(),
            tracer: tracer(colour),
        })
        .collect();
    let largest = exponents.iter().max().copied().unwrap_or_default();
    for _ in 0..effort.choose(1, 1, 3) {
        for size in &mut sizes {
            let run = size.run(engine, tiles_per_axis, 1 << (largest - size.exponent));
            size.runs.push(run);
        }
    }
    sizes
}

impl BatchSize {
    /// Traces `passes` batches of each of some tiles.
    fn run(&mut self, engine: &Engine, tiles_per_axis: u32, passes: u32) -> Rates {
        let samples = 1 << (self.exponent - PIXEL_EXPONENT);
        let size = engine.scene().film.crop.size;
        let mut film = Film::new(size, FilmSums::default());
        let chosen = spread_tiles(size, tiles_per_axis);
        let start = Instant::now();
        for pass in 0..passes {
            for &index in &chosen {
                let key = StreamKey {
                    seed: 1,
                    tile: index as u32,
                    pass,
                };
                let tile = &mut film.tiles_mut()[index];
                let job = TileJob {
                    key,
                    counts: PathCounts::Even(samples),
                    weight: f64::from(samples),
                    knowledge: None,
                    learns: false,
                    reliance: Reliance::ALL,
                };
                self.tracer.trace(engine, &job, tile);
            }
        }
        let elapsed = start.elapsed();
        Rates::new(&self.tracer.take_statistics(), elapsed)
    }
}

/// The indices of `per_axis` x `per_axis` tiles that are spread evenly over an image.
fn spread_tiles(size: ImageSize, per_axis: u32) -> Vec<usize> {
    let [columns, rows] = [size.width, size.height].map(|side| side.div_ceil(TILE_SIDE));
    let middle = |k, count| (2 * k + 1) * count / (2 * per_axis);
    (0..per_axis)
        .flat_map(|j| (0..per_axis).map(move |i| (i, j)))
        .map(|(i, j)| (middle(j, rows) * columns + middle(i, columns)) as usize)
        .collect()
}

fn tracer(colour: ColourMode) -> Box<dyn TraceBatches> {
    match colour {
        ColourMode::Rgb => Box::<Tracer<Rgb>>::default(),
        ColourMode::Spectral(WavelengthCount::One) => Box::<Tracer<Spectral<1>>>::default(),
        ColourMode::Spectral(WavelengthCount::Four) => Box::<Tracer<Spectral<4>>>::default(),
        ColourMode::Spectral(WavelengthCount::Eight) => Box::<Tracer<Spectral<8>>>::default(),
    }
}
