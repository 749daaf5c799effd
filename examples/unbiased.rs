//! Is a strategy unbiased? Renders a scene by the guided particle filter with many seeds, and compares every pixel, and the
//! image, with a long render by plain roulette.
//!
//!     cargo run --release --example unbiased [SCENE.xml [SEEDS [SAMPLES]]]
//!
//! The reference has four times the samples of all seeds together. Both errors are in the deviations, which are in standard errors.

use std::error::Error;
use std::num::NonZeroU32;
use std::sync::Arc;

use cohort::sampling::SamplerKind;
use cohort::{
    Budget, ColourMode, LoadOptions, Render, Scene, Settings, StopFlag, StrategyKind,
    StrategyOptions,
};

/// The image is so many pixels wide and high.
const SIDE: i64 = 48;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let scene = arguments.next();
    let scene = scene.unwrap_or_else(|| "scenes/cornell-knot.xml".into());
    let seeds: u32 = arguments.next().map_or(Ok(256), |text| text.parse())?;
    let samples: u32 = arguments.next().map_or(Ok(32), |text| text.parse())?;

    let options = LoadOptions {
        models: std::env::var_os("COHORT_MODELS").map(Into::into),
        ..LoadOptions::default()
    };
    let mut scene = Scene::load(scene, &options)?;
    scene.film = scene.film.resized(SIDE, SIDE)?;
    let scene = Arc::new(scene);
    let settings = |strategy: StrategyKind, samples: u32| -> Result<Settings, Box<dyn Error>> {
        let samples = NonZeroU32::new(samples).ok_or("there must be samples and seeds")?;
        Ok(Settings {
            strategy: strategy.build(&StrategyOptions::default())?,
            budget: Budget::SamplesPerPixel(samples),
            colour: ColourMode::Rgb,
            ..Settings::default()
        })
    };
    let filter = Settings {
        sampler: SamplerKind::ArrayQmc,
        guiding: true,
        ..settings(StrategyKind::ParticleFilter, samples)?
    };
    let plain = settings(StrategyKind::Roulette, 4 * seeds * samples)?;

    let render = Render::new(scene.clone(), filter)?;
    let mut image = Moments::default();
    let mut pixels = Vec::new();
    for seed in 1..=u64::from(seeds) {
        let mut state = render.start(seed);
        let until = Budget::SamplesPerPixel(NonZeroU32::MAX);
        let ended = render.advance(&mut state, until, &StopFlag::new(), &());
        let film = state.into_outcome(ended).film.image();
        let values = film.pixels().as_flattened();
        pixels.resize(values.len(), Moments::default());
        for (moments, &value) in pixels.iter_mut().zip(values) {
            moments.add(f64::from(value));
        }
        image.add(film.mean().iter().sum::<f64>() / 3.0);
    }
    let outcome = Render::new(scene, plain)?.run(&StopFlag::new(), &());
    let reference = outcome.film.image();
    let variance = outcome.film.variance().ok_or("too few samples")?;

    let mut beyond = [0; 3];
    let values = reference.pixels().as_flattened().iter();
    for ((moments, &value), &variance) in pixels
        .iter()
        .zip(values)
        .zip(variance.pixels().as_flattened())
    {
        let error = moments.variance_of_mean() + f64::from(variance);
        let deviation = (moments.mean() - f64::from(value)).abs() / error.sqrt();
        for (count, limit) in beyond.iter_mut().zip([2.0, 3.0, 4.0]) {
            *count += u32::from(deviation > limit);
        }
    }
    let count = pixels.len() as f64;
    // The channels of a pixel have their noise in common: as if it were all.
    let channels = variance.mean().map(f64::sqrt).iter().sum::<f64>() / 3.0;
    let error = (image.variance_of_mean() + channels * channels * 3.0 / count).sqrt();
    let truth = reference.mean().iter().sum::<f64>() / 3.0;
    println!(
        "image: {:+.4} %, {:+.2} standard errors",
        100.0 * (image.mean() / truth - 1.0),
        (image.mean() - truth) / error
    );
    for ((limit, beyond), chance) in [2, 3, 4]
        .iter()
        .zip(beyond)
        .zip([0.0455, 0.0027, 0.0000633])
    {
        println!(
            "beyond {limit} standard errors: {beyond} of {count} channels of pixels (by chance, of normal noise: {:.1})",
            chance * count
        );
    }
    Ok(())
}

/// A running mean and variance (Welford 1962).
#[derive(Clone, Copy, Default)]
struct Moments {
    count: f64,
    mean: f64,
    squares: f64,
}

impl Moments {
    fn add(&mut self, value: f64) {
        self.count += 1.0;
        let distance = value - self.mean;
        self.mean += distance / self.count;
        self.squares += distance * (value - self.mean);
    }

    fn mean(self) -> f64 {
        self.mean
    }

    fn variance_of_mean(self) -> f64 {
        self.squares / (self.count - 1.0) / self.count
    }
}
