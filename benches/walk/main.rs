//! Resampling alone: nanoseconds per particle of every strategy and way to draw, by the size of the population.
//!
//!     cargo bench --bench walk [-- --quick]
//!
//! `docs/benchmarks.md` says what is measured.

mod cases;
#[path = "../common/effort.rs"]
mod effort;
mod measure;
mod particles;
#[path = "../common/table.rs"]
mod table;

use std::error::Error;
use std::time::Duration;

use criterion::Criterion;

use cases::Case;
use effort::Effort;
use measure::{GROUP, measure};
use table::{Table, target_directory};

fn main() -> Result<(), Box<dyn Error>> {
    let effort = Effort::from_arguments();
    let exponents: &[u32] = effort.choose(&[0, 4, 8], &[0, 8, 16], &[0, 4, 8, 12, 16, 20]);
    let mut criterion = Criterion::default()
        .output_directory(&target_directory().join("criterion"))
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_secs(1))
        .sample_size(30)
        .nresamples(10_000)
        .configure_from_args();

    let names = ["strategy", "population", "counts", "children"].map(str::to_owned);
    let sizes = exponents.iter().map(|exponent| format!("2^{exponent}"));
    let mut table = Table::new(names.into_iter().chain(sizes));
    let mut group = criterion.benchmark_group(GROUP);
    for case in Case::all()? {
        let mut times = Vec::new();
        let mut children = 0.0;
        for exponent in exponents {
            let measured = measure(&mut group, &case, 1 << exponent, effort)?;
            times.push(measured.nanoseconds);
            children = measured.children;
        }
        if times.iter().all(Option::is_none) {
            continue;
        }
        let mut row = case.name().to_vec();
        row.push(format!("{children:.2}"));
        row.extend(times.iter().map(|time| match time {
            Some(nanoseconds) => format!("{nanoseconds:.2}"),
            None => String::new(),
        }));
        table.push(row);
    }
    group.finish();
    criterion.final_summary();
    if effort == Effort::Test {
        return Ok(());
    }
    println!("\nNanoseconds per particle by the size of the population (medians):");
    table.publish("walk")
}
