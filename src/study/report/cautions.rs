//! What to keep in mind when believing an answer.

use super::answer::in_brackets;
use super::numbers::{counted, shown_percent, significant};
use crate::study::results::{Results, StudyBudget, StudyKind};

/// The largest deviation of the budgets that passes without a word.
const TOLERATED_DEVIATION: f64 = 0.01;

/// The largest relative variance of a reference that passes without a word: 22 % of a pixel's value.
const TOLERATED_VARIANCE: f64 = 0.05;

/// One sentence for each thing that weakens what was found.
pub fn cautions(results: &Results) -> Vec<String> {
    let mut cautions = Vec::new();
    let conditions = &results.conditions;
    if conditions.repetitions < 2 {
        cautions.push(
            "There was one repetition only, so no interval is known. With --repeat 2 or more there are intervals."
                .to_owned(),
        );
    }
    if results.reference.variance.is_none() {
        cautions.push(
            "The error of the reference is not known and not subtracted: all errors include it, which makes ratios look \
             closer to 1 than they are."
                .to_owned(),
        );
    }
    if let Some(variance) = results.reference.relative_variance
        && variance > TOLERATED_VARIANCE
    {
        cautions.push(format!(
            "The reference is rough: its own relative error is {} % in a typical pixel. Relative errors are divided by its \
             values, so they mean little. Give it more with --reference-time.",
            significant(variance.sqrt() * 100.0, 2)
        ));
    }
    if let (StudyBudget::Seconds(_), Some(deviation)) =
        (conditions.budget, conditions.budget_deviation)
        && deviation > TOLERATED_DEVIATION
    {
        cautions.push(format!(
            "The competitors' times differ by up to {} % from the planned one.",
            significant(deviation * 100.0, 2)
        ));
    }
    for competitor in &results.competitors {
        let dropped: u64 = competitor.dropped_samples.iter().sum();
        if dropped > 0 {
            cautions.push(format!(
                "{} dropped {} that were not finite or negative.",
                competitor.name,
                counted(dropped, "sample")
            ));
        }
        // An accuracy study shows bias as a result.
        if results.kind == StudyKind::Compare
            && let Some(snapshot) = competitor.snapshots.last()
            && let Some((low, high)) = snapshot.errors.bias.bounds
            && (low > 0.0 || high < 0.0)
        {
            let bias = shown_percent(&snapshot.errors.bias);
            cautions.push(format!(
                "The image of {} is {} off in its mean{}: an error that more time may not remove. One in twenty intervals \
                 excludes 0 by chance.",
                competitor.name,
                bias.value,
                in_brackets(bias.range.map(|range| range + " %"))
            ));
        }
    }
    cautions
}
