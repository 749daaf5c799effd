//! Whole renders: paths and rays per second and the share of time inside Embree, on one and on two threads, and by the
//! size of batches; and the building of acceleration structures.
//!
//!     cargo bench --bench render [-- --quick]
//!
//! `docs/benchmarks.md` says what is measured.

mod batches;
mod building;
#[path = "../common/cases.rs"]
mod cases;
#[path = "../common/effort.rs"]
mod effort;
#[path = "../common/median.rs"]
mod median;
#[path = "../common/rates.rs"]
mod rates;
#[path = "../common/table.rs"]
mod table;
#[path = "../common/turns.rs"]
mod turns;

use std::error::Error;
use std::num::NonZeroUsize;
use std::time::Duration;

use cases::Case;
use effort::Effort;
use median::median;
use rates::{Rates, median_ratio};
use table::Table;

const ONE: NonZeroUsize = NonZeroUsize::MIN;
const TWO: NonZeroUsize = ONE.saturating_add(1);

const BUILDING_COLUMNS: [&str; 4] = ["scene", "1 thread, ms", "2 threads, ms", "ratio"];

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
    let mut building = Table::new(BUILDING_COLUMNS);
    let mut built = None;
    for case in Case::all(effort)? {
        if built != Some(case.name) {
            built = Some(case.name);
            building.push(building_row(&case, effort)?);
        }
        println!("{}", case.labels().join(", "));
        let renders = [case.render(ONE)?, case.render(TWO)?];
        let [one, two] = turns::in_turns(&renders, effort);
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
    building.publish("building")?;
    table.publish("render")
}

/// The medians of building the acceleration structure of a case's scene, and how many times as fast two threads are.
fn building_row(case: &Case, effort: Effort) -> Result<Vec<String>, Box<dyn Error>> {
    let [one, two] = building::in_turns(&case.scene, [ONE, TWO], effort)?;
    let seconds = |time: &Duration| time.as_secs_f64();
    let milliseconds = |times: &[Duration]| 1e3 * median(times.iter().map(seconds));
    let ratios = one
        .iter()
        .zip(&two)
        .map(|(one, two)| seconds(one) / seconds(two));
    Ok(vec![
        case.name.to_owned(),
        format!("{:.1}", milliseconds(&one)),
        format!("{:.1}", milliseconds(&two)),
        format!("{:.2}", median(ratios)),
    ])
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
