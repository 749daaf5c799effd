//! How fast rays of real renders are traced, by every call of the intersection layer and by the same call in plain C.
//!
//!     cargo bench --bench intersection                 # some minutes
//!     cargo bench --bench intersection -- --quick      # less than a minute
//!     cargo bench --bench intersection -- lucy/high    # only benchmarks whose name has this in it
//!
//! `docs/benchmarks.md` says what is measured. Everything runs in one thread.

mod budget;
mod builds;
mod calls;
mod duel;
#[path = "../common/effort.rs"]
mod effort;
mod outcome;
mod ray_sets;
mod scenes;
mod tables;

use std::cell::OnceCell;
use std::error::Error;

use cohort::embree::{Coherence, flush_denormals_to_zero};
use criterion::{BenchmarkId, Criterion, SamplingMode, Throughput};

use builds::{Build, Variant};
use calls::{Call, Query};
use duel::Duel;
use effort::Effort;
use outcome::{Outcome, Row};
use ray_sets::{RaySet, STRETCH};
use scenes::Subject;

fn main() -> Result<(), Box<dyn Error>> {
    let effort = Effort::from_arguments();
    let mut criterion = budget::harness(effort).configure_from_args();
    let _flushed = flush_denormals_to_zero();
    let mut outcome = Outcome::default();
    for subject in scenes::subjects(effort)? {
        let ray_sets = ray_sets::record(&subject.scene, budget::stretches(effort))?;
        for variant in Variant::ALL {
            race(
                &mut criterion,
                effort,
                &subject,
                variant,
                &ray_sets,
                &mut outcome,
            );
        }
    }
    criterion.final_summary();
    if effort != Effort::Test {
        tables::publish(&outcome)?;
    }
    Ok(())
}

/// Measures all calls with all rays of a scene in one way to build it.
fn race(
    criterion: &mut Criterion,
    effort: Effort,
    subject: &Subject,
    variant: Variant,
    ray_sets: &[RaySet],
    outcome: &mut Outcome,
) {
    // Only built if a benchmark that was asked for needs it.
    let build = OnceCell::<Build>::new();
    let mut group = criterion.benchmark_group(format!("{}/{}", subject.name, variant.name()));
    group.sampling_mode(SamplingMode::Flat);
    for set in ray_sets {
        group.throughput(Throughput::Elements((set.stretches.len() * STRETCH) as u64));
        let calls: &[Call] = match set.query {
            Query::Nearest => &calls::NEAREST,
            Query::Occluded => &calls::OCCLUDED,
        };
        for call in calls {
            for coherence in [Coherence::Coherent, Coherence::Incoherent] {
                let id = BenchmarkId::new(set.name, format!("{} {coherence:?}", call.name));
                let mut duel = None;
                group.bench_function(id, |bencher| {
                    let build = build
                        .get_or_init(|| Build::measure(subject, variant, budget::builds(effort)));
                    let scene = build.accelerator.scene();
                    let duel = duel.get_or_insert_with(|| Duel::new(call, set));
                    bencher.iter_custom(|rounds| duel.run(scene, coherence, rounds as usize));
                });
                if let (Some(mut duel), Some(build)) = (duel, build.get()) {
                    duel.compare(
                        build.accelerator.scene(),
                        coherence,
                        budget::comparing(effort),
                    );
                    outcome.rows.push(Row {
                        scene: subject.name,
                        variant,
                        rays: set.name,
                        call: call.name,
                        coherence,
                        speed: duel.speed(),
                    });
                }
            }
        }
    }
    group.finish();
    if let Some(build) = build.into_inner() {
        outcome.builds.push(build.report);
    }
}
