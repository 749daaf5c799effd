//! Under which conditions a study was made, and what its measures mean.

use super::numbers::{duration, significant};
use crate::study::results::{Conditions, Results, StudyBudget};

/// Conditions, reference and machine: name and value.
pub fn facts(results: &Results) -> Vec<(String, String)> {
    let (conditions, reference, machine) =
        (&results.conditions, &results.reference, &results.machine);
    let mut facts = Vec::new();
    let mut fact = |name: &str, value: String| facts.push((name.to_owned(), value));
    fact(
        "Scene",
        format!(
            "{}, {} × {} pixels, {} % of which see a light directly",
            results.scene.name,
            results.scene.width,
            results.scene.height,
            significant(results.scene.lit_share * 100.0, 2)
        ),
    );
    fact("Budget", budget(results));
    fact("Threads", conditions.threads.to_string());
    fact("Repetitions", conditions.repetitions.to_string());
    fact("Seed", conditions.seed.to_string());
    fact("Colour", conditions.colour.clone());
    if let Some(slice) = conditions.slice {
        let slice = in_unit(conditions, slice);
        fact(
            "Turns",
            format!("competitors change after {slice} at the latest"),
        );
    }
    if let Some(deviation) = conditions.budget_deviation {
        fact(
            "Largest deviation of a competitor's time",
            format!("{} % of the planned one", significant(deviation * 100.0, 2)),
        );
    }
    fact("Reference", reference.source.clone());
    if let Some(strategy) = &reference.strategy {
        fact("Strategy of the reference", strategy.clone());
    }
    if let Some(seconds) = reference.seconds {
        fact("Time of the reference", duration(seconds));
    }
    if let Some(samples) = reference.samples_per_pixel {
        fact("Paths per pixel of the reference", significant(samples, 4));
    }
    fact(
        "Error of the reference",
        match (reference.relative_variance, reference.variance) {
            (Some(relative), Some(plain)) => format!(
                "known and subtracted: relative MSE {}, MSE {}",
                significant(relative, 3),
                significant(plain, 3)
            ),
            (None, Some(plain)) => format!("known and subtracted: MSE {}", significant(plain, 3)),
            (_, None) => "not known: all errors include it".to_owned(),
        },
    );
    if let Some(error) = reference.mean_error {
        fact(
            "Standard error of the reference's mean",
            format!("{} %", significant(error * 100.0, 2)),
        );
    }
    fact(
        "Processor",
        format!(
            "{} ({} in use at most)",
            machine.processor, machine.processors
        ),
    );
    fact("System", machine.system.clone());
    fact("Date", machine.date.clone());
    for (program, version) in &machine.versions {
        fact(program, version.clone());
    }
    facts
}

/// What each competitor could use.
pub fn budget(results: &Results) -> String {
    let amount = match results.conditions.budget {
        StudyBudget::Seconds(seconds) => seconds,
        StudyBudget::SamplesPerPixel(samples) => f64::from(samples),
        StudyBudget::Rays(rays) => rays as f64,
    };
    let amount = in_unit(&results.conditions, amount);
    format!("{amount} for each competitor and repetition")
}

/// An amount of the budget, with its unit.
fn in_unit(conditions: &Conditions, amount: f64) -> String {
    match conditions.budget {
        StudyBudget::Seconds(_) => duration(amount),
        StudyBudget::SamplesPerPixel(_) => format!("{amount} camera paths per pixel"),
        StudyBudget::Rays(_) => format!("{} rays", significant(amount, 3)),
    }
}

/// What the measures mean: name and definition.
pub const DEFINITIONS: [(&str, &str); 8] = [
    (
        "MSE",
        "mean over pixels and channels of (x − r)² − v, in linear sRGB: x is the image, r the reference, v the \
      reference's own variance where it is known. Subtracting v makes it unbiased for the error against the truth; it can \
      then be negative where there is hardly any error.",
    ),
    (
        "Relative MSE",
        "mean of ((x − r)² − v) / (m² + e): m is the mean of the pixel's three channels in the reference, and \
      e = (0.01 M)² keeps black pixels from counting without limit, M being the mean of the whole reference.",
    ),
    ("RMSE", "square root of MSE."),
    (
        "Bias",
        "mean luminance of the image over that of the reference, minus 1.",
    ),
    (
        "Variance",
        "mean over pixels and channels of the variance between repetitions.",
    ),
    (
        "Efficiency",
        "1 / (error × seconds). With error falling as 1 / time, a ratio of 2 means the same error in half of the \
      time.",
    ),
    (
        "Lights seen directly",
        "pixels that see a light without reflection. All others are reflected light.",
    ),
    (
        "95 % interval",
        "range that holds the true value in 95 of 100 such studies, from the scatter of the repetitions. A \
      ratio whose interval holds 1 is reported as “no difference shown”.",
    ),
];
