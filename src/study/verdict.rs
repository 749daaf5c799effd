//! What a setting costs and what it buys.

use super::assemble::{Column, Course};
use super::plan::Variation;
use super::results::Verdict;
use super::statistics::{Interval, products};

/// Holds the competitor with a setting varied against the baseline; `bias` is the competitor's.
///
/// Time per sample compares seconds per camera path. The error at equal time is the square root of
/// relMSE x seconds: what would be left if both had used the same time.
pub(super) fn verdict(
    variation: &Variation,
    baseline: &Course,
    varied: &Course,
    bias: Interval,
) -> Verdict {
    let per_sample = |column: &Column| -> Vec<f64> {
        let pairs = column.seconds.iter().zip(&column.camera_paths);
        pairs.map(|(seconds, paths)| seconds / paths).collect()
    };
    let work = |column: &Column| {
        let errors: Vec<f64> = column
            .errors
            .iter()
            .map(|errors| errors.relative_mse)
            .collect();
        products(&errors, &column.seconds)
    };
    let (before, after) = (baseline.last(), varied.last());
    let time_per_sample = Interval::of_ratio(&per_sample(after), &per_sample(before));
    let error_at_equal_time = Interval::of_ratio(&work(after), &work(before)).square_root();
    let biased = bias.bounds.is_some() && !bias.holds(0.0);
    Verdict {
        axis: variation.axis.to_owned(),
        value: variation.value.clone(),
        is_default: variation.is_default,
        text: in_words(&time_per_sample, &error_at_equal_time, &bias, biased),
        time_per_sample,
        error_at_equal_time,
        bias,
        biased,
    }
}

/// "costs 12 % time, buys 5 % error", with what is not shown said so.
fn in_words(time: &Interval, error: &Interval, bias: &Interval, biased: bool) -> String {
    let time = match change(time) {
        None => "no difference in time per sample shown".to_owned(),
        Some(share) if share > 0.0 => format!("costs {:.1} % time per sample", share),
        Some(share) => format!("saves {:.1} % time per sample", -share),
    };
    let error = match change(error) {
        None => "no difference in error at equal time shown".to_owned(),
        Some(share) if share > 0.0 => format!("loses {:.1} % error at equal time", share),
        Some(share) => format!("buys {:.1} % error at equal time", -share),
    };
    let bias = if biased {
        format!("; biased by {:+.2} % of the mean", 100.0 * bias.estimate)
    } else {
        String::new()
    };
    format!("{time}, {error}{bias}")
}

/// By how many per cent a ratio is away from 1, if its interval shows that it is.
fn change(ratio: &Interval) -> Option<f64> {
    let is_shown = ratio.bounds.is_some() && !ratio.holds(1.0);
    is_shown.then_some(100.0 * (ratio.estimate - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn interval(estimate: f64, low: f64, high: f64) -> Interval {
        Interval {
            estimate,
            bounds: Some((low, high)),
        }
    }

    #[test]
    fn verdicts_say_what_is_shown_and_no_more() {
        let none = interval(0.0, -0.01, 0.01);
        let said = in_words(
            &interval(1.2, 1.1, 1.3),
            &interval(0.9, 0.8, 0.95),
            &none,
            false,
        );
        assert_eq!(
            said,
            "costs 20.0 % time per sample, buys 10.0 % error at equal time"
        );
        let said = in_words(
            &interval(1.02, 0.9, 1.1),
            &interval(1.5, 1.4, 1.6),
            &interval(-0.05, -0.06, -0.04),
            true,
        );
        assert_eq!(
            said,
            "no difference in time per sample shown, loses 50.0 % error at equal time; biased by -5.00 % of the mean"
        );
    }
}
