//! Whole renders: paths and rays per second and the share of time inside Embree, on one and on two threads, and by the
//! size of batches.
//!
//!     cargo bench --bench render [-- --quick]
//!
//! `docs/benchmarks.md` says what is measured.

mod batches;
#[path = "../common/cases.rs"]
mod cases;
#[path = "../common/effort.rs"]
mod effort;
#[path = "../common/median.rs"]
mod median;
mod rates;
#[path = "../common/table.rs"]
mod table;
mod threads;

use std::error::Error;
use std::num::NonZeroUsize;

use cases::Case;
use effort::Effort;
use rates::{Rates, median_ratio};
use table::Table;

const ONE: NonZeroUsize = NonZeroUsize::MIN;
const TWO: NonZeroUsize = ONE.saturating_add(1);

const COLUMNS: [&str; 10] = [
    "scene",
    "colour",
    "strategy",
    "threads",
    "paths a batch",
    "Mpaths/s",
    "Mrays/s",
    "% in Embree",
    "ratio",
    "to",
];

fn main() -> Result<(), Box<dyn Error>> {
    let effort = Effort::from_arguments();
    let mut table = Table::new(COLUMNS);
    for case in Case::all(effort)? {
        println!("{}", case.labels().join(", "));
        let renders = [case.render(ONE)?, case.render(TWO)?];
        let [one, two] = threads::in_turns(&renders, effort);
        let driver = batches::DRIVER_EXPONENT;
        table.push(row(&case, ONE, driver, &one, None));
        let speedup = (median_ratio(&two, &one), "1 thread".to_owned());
        table.push(row(&case, TWO, driver, &two, Some(speedup)));

        let sizes = batches::in_turns(renders[0].engine(), case.colour, effort);
        let base = sizes.iter().find(|size| size.exponent == driver);
        for size in &sizes {
            let gain = base.map(|base| {
                let ratio = median_ratio(&size.runs, &base.runs);
                (ratio, format!("2^{driver} paths"))
            });
            table.push(row(&case, ONE, size.exponent, &size.runs, gain));
        }
    }
    if effort == Effort::Test {
        return Ok(());
    }
    table.publish("render")
}

/// The medians of `runs`, and a ratio with what it is to.
fn row(
    case: &Case,
    threads: NonZeroUsize,
    exponent: u32,
    runs: &[Rates],
    ratio: Option<(f64, String)>,
) -> Vec<String> {
    let rates = Rates::median(runs);
    let (ratio, to) = match ratio {
        Some((ratio, to)) => (format!("{ratio:.3}"), to),
        None => Default::default(),
    };
    let mut row = case.labels().to_vec();
    row.extend([
        threads.to_string(),
        format!("2^{exponent}"),
        format!("{:.3}", rates.paths / 1e6),
        format!("{:.2}", rates.rays / 1e6),
        format!("{:.1}", 100.0 * rates.embree_share),
        ratio,
        to,
    ]);
    row
}
