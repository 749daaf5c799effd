//! Where the engine's time goes: nanoseconds per camera path and stage, RGB and spectral, on one thread.
//!
//!     cargo bench --bench stages [-- --quick]
//!
//! `docs/benchmarks.md` says what is measured.

#[path = "../common/cases.rs"]
mod cases;
#[path = "../common/effort.rs"]
mod effort;
#[path = "../common/median.rs"]
mod median;
#[path = "../common/table.rs"]
mod table;

use std::error::Error;
use std::num::NonZeroUsize;

use cohort::StopFlag;
use cohort::transport::{Stage, TraceStatistics};

use cases::Case;
use effort::Effort;
use median::median;
use table::Table;

fn main() -> Result<(), Box<dyn Error>> {
    let effort = Effort::from_arguments();
    let labels = ["scene", "colour", "strategy"];
    let sums = ["total", "% intersect", "rays", "vertices"];
    let stages = Stage::ALL.map(Stage::name);
    let mut table = Table::new(labels.into_iter().chain(stages).chain(sums));
    for case in Case::all(effort)? {
        println!("{}", case.labels().join(", "));
        let render = case.render(NonZeroUsize::MIN)?;
        let runs: Vec<_> = (0..effort.choose(1, 3, 9))
            .map(|_| render.run(&StopFlag::new(), &()).statistics)
            .collect();
        table.push(row(&case, &runs));
    }
    if effort == Effort::Test {
        return Ok(());
    }
    println!("\nNanoseconds per camera path (medians):");
    table.publish("stages")
}

/// The medians over `runs`.
fn row(case: &Case, runs: &[TraceStatistics]) -> Vec<String> {
    let of = |number: &dyn Fn(&TraceStatistics) -> f64| median(runs.iter().map(number));
    let per_path = |run: &TraceStatistics, amount: f64| amount / run.camera_paths as f64;
    let mut row = case.labels().to_vec();
    row.extend(Stage::ALL.map(|stage| {
        let nanoseconds = of(&|run| per_path(run, 1e9 * run.stages.of(stage).as_secs_f64()));
        format!("{nanoseconds:.0}")
    }));
    let total = of(&|run| per_path(run, 1e9 * run.stages.total().as_secs_f64()));
    let share =
        of(&|run| run.stages.of(Stage::Intersect).as_secs_f64() / run.stages.total().as_secs_f64());
    row.extend([
        format!("{total:.0}"),
        format!("{:.1}", 100.0 * share),
        format!("{:.2}", of(&|run| per_path(run, run.all_rays() as f64))),
        format!("{:.2}", of(&|run| per_path(run, run.vertices as f64))),
    ]);
    row
}
