//! Which of two strategies gives less noise for the same time? Renders the built-in scene by both, for the same time,
//! and prints their relative variance and how much of it a second takes away.
//!
//!     cargo run --release --example compare_strategies

use std::error::Error;
use std::sync::Arc;
use std::time::Duration;

use cohort::{
    Budget, LoadOptions, Outcome, Render, Scene, Settings, StopFlag, StrategyKind, StrategyOptions,
};

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Arc::new(Scene::built_in(&LoadOptions {
        definitions: vec![("res".into(), "64".into())],
        ..LoadOptions::default()
    })?);
    println!("strategy              samples  relative variance  efficiency");
    for kind in [StrategyKind::Roulette, StrategyKind::ParticleFilter] {
        let settings = Settings {
            strategy: kind.build(&StrategyOptions::default())?,
            budget: Budget::Time(Duration::from_secs(2)),
            ..Settings::default()
        };
        let outcome = Render::new(scene.clone(), settings)?.run(&StopFlag::new(), &());
        let variance = relative_variance(&outcome).ok_or("too few samples to know the noise")?;
        // Variance falls with one over the time: their product is what the strategy itself is worth.
        let efficiency = 1.0 / (variance * outcome.duration.as_secs_f64());
        let samples = outcome.statistics.camera_paths / outcome.film.size().pixels() as u64;
        println!(
            "{:20}  {samples:7}  {variance:17.2e}  {efficiency:10.3e}",
            kind.name()
        );
    }
    Ok(())
}

/// The variance of a pixel's mean relative to the square of the image's mean, on average over pixels and channels;
/// `None` while some pixel does not know its variance.
fn relative_variance(outcome: &Outcome) -> Option<f64> {
    let variance = outcome.film.variance()?.mean();
    let mean = outcome.film.image().mean();
    Some(variance.iter().sum::<f64>() / mean.iter().map(|mean| mean * mean).sum::<f64>())
}
