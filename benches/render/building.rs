//! Acceleration structures built by one thread and by two.

use std::num::NonZeroUsize;
use std::time::{Duration, Instant};

use cohort::embree::EmbreeError;
use cohort::transport::{Accelerator, AcceleratorOptions};
use cohort::{Scene, Settings};

use super::effort::Effort;

/// The times of each number of threads, one a round. Who begins alternates.
pub fn in_turns(
    scene: &Scene,
    threads: [NonZeroUsize; 2],
    effort: Effort,
) -> Result<[Vec<Duration>; 2], EmbreeError> {
    let mut times = [Vec::new(), Vec::new()];
    for round in 0..effort.choose(1, 3, 11) {
        for turn in 0..2 {
            let index = (round + turn) % 2;
            times[index].push(time(scene, threads[index])?);
        }
    }
    Ok(times)
}

/// How long the structure that renders use by default takes.
fn time(scene: &Scene, threads: NonZeroUsize) -> Result<Duration, EmbreeError> {
    let Settings {
        build_quality,
        robust,
        ..
    } = Settings::default();
    let options = AcceleratorOptions {
        threads,
        quality: build_quality,
        robust,
    };
    let start = Instant::now();
    let built = Accelerator::new(scene, options)?;
    let time = start.elapsed();
    drop(built);
    Ok(time)
}
