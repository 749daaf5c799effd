//! One number: how long one strategy takes for one population.

use std::error::Error;
use std::fs::File;
use std::hint::black_box;
use std::io::BufReader;

use cohort::sampling::{RandomStream, StreamKey};
use cohort::walk::Offspring;
use criterion::{BenchmarkGroup, BenchmarkId, Throughput, measurement::WallTime};
use serde::Deserialize;

use super::cases::Case;
use super::effort::Effort;
use super::particles::Particles;
use super::table::target_directory;

/// Name of the group, and of criterion's folder.
pub const GROUP: &str = "walk";

/// The result of a measurement.
pub struct Measured {
    /// Median nanoseconds per particle; `None` where criterion did not measure.
    pub nanoseconds: Option<f64>,
    /// Mean number of children per particle.
    pub children: f64,
}

/// Resamples `count` particles again and again.
pub fn measure(
    group: &mut BenchmarkGroup<WallTime>,
    case: &Case,
    count: usize,
    effort: Effort,
) -> Result<Measured, Box<dyn Error>> {
    let particles = Particles::new(count, case);
    let population = particles.population();
    let mut random = RandomStream::new(StreamKey {
        seed: 1,
        tile: 0,
        pass: 0,
    });
    let mut offspring = Offspring::new();
    let (mut calls, mut children) = (0_u64, 0);
    let name = case.name().join(" ");
    group.throughput(Throughput::Elements(count as u64));
    group.bench_function(BenchmarkId::new(&name, count), |bencher| {
        bencher.iter(|| {
            let report =
                case.strategy
                    .resample(black_box(&population), &mut random, &mut offspring);
            calls += 1;
            children += offspring.children().len();
            report
        });
    });
    // A filter on the command line leaves benchmarks out; the file would be that of an earlier run.
    let measured = calls > 0 && effort != Effort::Test;
    Ok(Measured {
        nanoseconds: match measured {
            true => Some(median(&name, count)? / count as f64),
            false => None,
        },
        children: children as f64 / (calls as f64 * count as f64),
    })
}

/// What criterion has written about the benchmark that it just ran, in nanoseconds per call.
fn median(name: &str, count: usize) -> Result<f64, Box<dyn Error>> {
    #[derive(Deserialize)]
    struct Estimates {
        median: Estimate,
    }
    #[derive(Deserialize)]
    struct Estimate {
        point_estimate: f64,
    }
    let path = target_directory()
        .join("criterion")
        .join(GROUP)
        .join(name)
        .join(count.to_string())
        .join("new/estimates.json");
    let estimates: Estimates = serde_json::from_reader(BufReader::new(File::open(path)?))?;
    Ok(estimates.median.point_estimate)
}
