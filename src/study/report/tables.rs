//! The report's tables, from which both the page and the Markdown are made.

use super::numbers::{duration, shown_percent, significant};
use super::table::{Cell, Table};
use crate::study::results::{
    Competitor, ErrorIntervals, Finding, Pair, Results, Snapshot, StudyKind,
};

/// All tables, in the order of the report.
pub fn tables(results: &Results) -> Vec<Table> {
    let mut tables = Vec::new();
    if results.kind == StudyKind::Accuracy {
        tables.push(verdicts(results));
    }
    tables.extend([
        ratios(results),
        measures(results),
        regions(results),
        efficiencies(results),
        convergence(results),
        settings(results),
    ]);
    tables.retain(|table| !table.rows.is_empty());
    tables
}

/// The pairs worth a row: all of a comparison; of an accuracy study those with its baseline.
fn pairs(results: &Results) -> impl Iterator<Item = &Pair> {
    let baseline = results
        .competitors
        .first()
        .map(|competitor| &competitor.name);
    results
        .pairs
        .iter()
        .filter(move |pair| results.kind == StudyKind::Compare || Some(&pair.first) == baseline)
}

fn ratios(results: &Results) -> Table {
    let rows = pairs(results).map(|pair| {
        let finding = match (pair.finding, pair.relative_efficiency.bounds) {
            (_, None) => "no interval: no difference shown".to_owned(),
            (Finding::NoDifferenceShown, _) => "no difference shown".to_owned(),
            (Finding::SecondBetter, _) => format!("{} is better", pair.second),
            (Finding::FirstBetter, _) => format!("{} is better", pair.first),
        };
        vec![
            format!("{} against {}", pair.second, pair.first).into(),
            (&pair.relative_efficiency).into(),
            finding.into(),
            (&pair.efficiency).into(),
            (&pair.reflected_efficiency).into(),
        ]
    });
    Table {
        title: "Ratios of efficiency".to_owned(),
        note: "How many times as efficient the one is as the other, at the whole budget. The ratio by relative MSE leads; \
               by plain MSE the few pixels that see a light directly can outweigh all others."
            .to_owned(),
        columns: ["Pair", "By relative MSE", "Finding", "By plain MSE", "By relative MSE, reflected light only"]
            .map(str::to_owned)
            .to_vec(),
        rows: rows.collect(),
    }
}

fn verdicts(results: &Results) -> Table {
    let rows = results.competitors.iter().filter_map(|competitor| {
        let verdict = competitor.verdict.as_ref()?;
        let mut bias = Cell::from(shown_percent(&verdict.bias));
        if verdict.biased {
            bias.value += " (biased)";
        }
        let default = if verdict.is_default { "default" } else { "" };
        Some(vec![
            verdict.axis.clone().into(),
            Cell {
                value: verdict.value.clone(),
                detail: default.to_owned(),
            },
            (&verdict.time_per_sample).into(),
            (&verdict.error_at_equal_time).into(),
            bias,
            verdict.text.clone().into(),
        ])
    });
    let baseline = results
        .competitors
        .first()
        .map_or("", |competitor| &competitor.name);
    Table {
        title: "What settings cost and buy".to_owned(),
        note: format!(
            "Relative to {baseline}, which is 1: below 1, time per sample is saved, and error at equal time is lower. \
             Bias is of the mean luminance against the reference."
        ),
        columns: [
            "Setting",
            "Value",
            "Time per sample",
            "Error at equal time",
            "Bias",
            "Verdict",
        ]
        .map(str::to_owned)
        .to_vec(),
        rows: rows.collect(),
    }
}

/// Rows of those competitors that have been measured, at the whole budget.
fn at_the_end<'a>(
    results: &'a Results,
    row: impl Fn(&'a Competitor, &'a Snapshot) -> Vec<Cell>,
) -> Vec<Vec<Cell>> {
    let rows = results.competitors.iter().filter_map(|competitor| {
        let snapshot = competitor.snapshots.last()?;
        let mut cells = vec![competitor.name.clone().into()];
        cells.extend(row(competitor, snapshot));
        Some(cells)
    });
    rows.collect()
}

/// The head of a column and what stands below it.
type Measure = (&'static str, fn(&ErrorIntervals) -> Cell);

/// A table from the heads of its columns and the measures below them.
fn of_measures(results: &Results, title: &str, note: &str, measures: &[Measure]) -> Table {
    let heads = std::iter::once("Competitor").chain(measures.iter().map(|measure| measure.0));
    Table {
        title: title.to_owned(),
        note: note.to_owned(),
        columns: heads.map(str::to_owned).collect(),
        rows: at_the_end(results, |_, snapshot| {
            let cells = measures.iter().map(|measure| measure.1(&snapshot.errors));
            cells.collect()
        }),
    }
}

fn measures(results: &Results) -> Table {
    let mut measures: Vec<Measure> = vec![
        ("Relative MSE", |errors| (&errors.relative_mse).into()),
        ("MSE", |errors| (&errors.mse).into()),
        ("RMSE", |errors| (&errors.rmse).into()),
        ("Bias", |errors| shown_percent(&errors.bias).into()),
        ("Variance", |errors| {
            Cell::or_dash(errors.variance.as_ref().map(|variance| &variance.all))
        }),
    ];
    let has_flip = |competitor: &Competitor| {
        let snapshot = competitor.snapshots.last();
        snapshot.is_some_and(|snapshot| snapshot.errors.flip.is_some())
    };
    if results.competitors.iter().any(has_flip) {
        measures.push(("FLIP", |errors| Cell::or_dash(errors.flip.as_ref())));
    }
    let note = "At the whole budget, with 95 % intervals over the repetitions.";
    of_measures(results, "Errors", note, &measures)
}

fn regions(results: &Results) -> Table {
    let note = "The same apart for pixels that see a light directly and for all others, each the mean over its own pixels.";
    of_measures(
        results,
        "Errors by region",
        note,
        &[
            ("Relative MSE of reflected light", |errors| {
                (&errors.reflected_relative_mse).into()
            }),
            ("Relative MSE of lights seen directly", |errors| {
                (&errors.lit_relative_mse).into()
            }),
            ("MSE of reflected light", |errors| {
                (&errors.reflected_mse).into()
            }),
            ("MSE of lights seen directly", |errors| {
                (&errors.lit_mse).into()
            }),
            ("Variance of reflected light", |errors| {
                Cell::or_dash(errors.variance.as_ref().map(|variance| &variance.reflected))
            }),
            ("Variance of lights seen directly", |errors| {
                Cell::or_dash(errors.variance.as_ref().map(|variance| &variance.lit))
            }),
        ],
    )
}

fn efficiencies(results: &Results) -> Table {
    let mut table = of_measures(
        results,
        "Work and efficiency",
        "At the whole budget, in the mean of the repetitions. Efficiencies are larger where the same error costs less.",
        &[
            ("1 / (relative MSE × s)", |errors| {
                (&errors.relative_efficiency).into()
            }),
            ("1 / (MSE × s)", |errors| (&errors.efficiency).into()),
            ("1 / (relative MSE × rays)", |errors| {
                Cell::or_dash(errors.ray_efficiency.as_ref())
            }),
        ],
    );
    let pixels = f64::from(results.scene.width) * f64::from(results.scene.height);
    let work = at_the_end(results, |competitor, snapshot| {
        let dropped: u64 = competitor.dropped_samples.iter().sum();
        vec![
            duration(snapshot.seconds).into(),
            significant(snapshot.camera_paths / pixels.max(1.0), 3).into(),
            snapshot
                .rays
                .map_or_else(|| "–".to_owned(), |rays| significant(rays, 3))
                .into(),
            dropped.to_string().into(),
        ]
    });
    let heads = ["Time", "Paths per pixel", "Rays", "Samples dropped"];
    table.columns.splice(1..1, heads.map(str::to_owned));
    for (row, work) in table.rows.iter_mut().zip(work) {
        row.splice(1..1, work.into_iter().skip(1));
    }
    table
}

fn convergence(results: &Results) -> Table {
    let rows = results.competitors.iter().map(|competitor| {
        let target = &competitor.time_to_error;
        let mut seconds = Cell::or_dash(target.seconds.as_ref());
        if target.extrapolated && target.seconds.is_some() {
            seconds.value += " (extrapolated)";
        }
        vec![
            competitor.name.clone().into(),
            Cell::or_dash(competitor.slope.as_ref()),
            significant(target.relative_mse, 3).into(),
            seconds,
        ]
    });
    Table {
        title: "Convergence".to_owned(),
        note: "The slope of log relative MSE over log seconds is −1 for independent samples. Times marked as extrapolated \
               lie outside of what was measured and are taken from the slope."
            .to_owned(),
        columns: ["Competitor", "Slope", "Target relative MSE", "Seconds to the target"]
            .map(str::to_owned)
            .to_vec(),
        rows: rows.collect(),
    }
}

fn settings(results: &Results) -> Table {
    let rows = results.competitors.iter().map(|competitor| {
        let settings = competitor
            .settings
            .iter()
            .map(|(name, value)| format!("{name} = {value}"));
        let settings: Vec<String> = settings.collect();
        vec![competitor.name.clone().into(), settings.join(", ").into()]
    });
    Table {
        title: "Settings".to_owned(),
        note: String::new(),
        columns: ["Competitor", "Settings"].map(str::to_owned).to_vec(),
        rows: rows.collect(),
    }
}
