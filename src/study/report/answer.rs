//! The answer in sentences, with which every report opens.

use super::cautions::cautions;
use super::numbers::{listed, shown, significant};
use crate::study::results::{Competitor, Finding, Pair, Results, StudyKind};
use crate::study::statistics::Interval;

/// What the study says, in plain sentences.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answer {
    /// One sentence for all.
    pub headline: String,
    /// One sentence for each pair or setting.
    pub findings: Vec<String>,
    /// What to keep in mind when believing them.
    pub cautions: Vec<String>,
}

impl Answer {
    /// Puts into words what was found.
    pub fn of(results: &Results) -> Self {
        let (headline, findings) = match results.kind {
            StudyKind::Compare => (
                comparison_headline(results),
                results.pairs.iter().map(pair_sentence).collect(),
            ),
            StudyKind::Accuracy => (accuracy_headline(results), verdict_sentences(results)),
        };
        Self {
            headline,
            findings,
            cautions: cautions(results),
        }
    }
}

/// What one pair says, in the direction in which it says it.
pub fn pair_sentence(pair: &Pair) -> String {
    let (first, second) = (&pair.first, &pair.second);
    let ratio = &pair.relative_efficiency;
    let Some((low, high)) = ratio.bounds else {
        return format!(
            "No difference can be shown between {first} and {second}: a single repetition leaves no interval \
             (ratio {}).",
            significant(ratio.estimate, 3)
        );
    };
    let times = shown(&inverse(ratio));
    let value = times.value;
    match pair.finding {
        Finding::NoDifferenceShown => {
            let ratio = shown(ratio);
            format!(
                "No difference shown between {first} and {second} (ratio {}, 95 % interval {}).",
                ratio.value,
                ratio.range.unwrap_or_default()
            )
        }
        Finding::SecondBetter => format!(
            "{second} reaches the same error as {first} in {value} of the time{}.",
            in_brackets(times.range)
        ),
        Finding::FirstBetter if low > 0.0 => format!(
            "{second} is slower than {first}: it needs {value} times the time for the same error{}.",
            in_brackets(times.range)
        ),
        Finding::FirstBetter => format!(
            "{second} is slower than {first}: it needs {value} times the time for the same error (95 % interval from \
             {} upwards).",
            significant(1.0 / high, 3)
        ),
    }
}

/// The interval of 1 / x, for x above 0.
fn inverse(ratio: &Interval) -> Interval {
    Interval {
        estimate: 1.0 / ratio.estimate,
        bounds: ratio.bounds.map(|(low, high)| (1.0 / high, 1.0 / low)),
    }
}

/// An interval after what it belongs to.
pub fn in_brackets(range: Option<String>) -> String {
    range.map_or_else(String::new, |range| format!(" (95 % interval {range})"))
}

fn comparison_headline(results: &Results) -> String {
    let names: Vec<&str> = names(&results.competitors).collect();
    let beats = |winner: &str, loser: &str| {
        results.pairs.iter().any(|pair| match pair.finding {
            Finding::SecondBetter => pair.second == winner && pair.first == loser,
            Finding::FirstBetter => pair.first == winner && pair.second == loser,
            Finding::NoDifferenceShown => false,
        })
    };
    if results.pairs.is_empty() {
        return match names.as_slice() {
            [] => "Nothing was measured.".to_owned(),
            names => format!("{} ran alone: there is nothing to compare.", listed(names)),
        };
    }
    if results
        .pairs
        .iter()
        .all(|pair| pair.relative_efficiency.bounds.is_none())
    {
        return "No difference can be shown from a single repetition.".to_owned();
    }
    let leaders: Vec<&str> = names
        .iter()
        .copied()
        .filter(|name| !names.iter().any(|other| beats(other, name)))
        .collect();
    match leaders.as_slice() {
        all if all.len() == names.len() => {
            format!("No difference is shown between {}.", listed(all))
        }
        [leader] => {
            let unbeaten: Vec<&str> = names
                .iter()
                .copied()
                .filter(|name| name != leader && !beats(leader, name))
                .collect();
            match unbeaten.as_slice() {
                [] => format!("{leader} reaches the same error soonest."),
                rest => format!(
                    "{leader} leads, though no difference is shown between it and {}.",
                    listed(rest)
                ),
            }
        }
        leaders => format!(
            "{} lead; no difference is shown between them.",
            listed(leaders)
        ),
    }
}

fn names(competitors: &[Competitor]) -> impl Iterator<Item = &str> {
    competitors
        .iter()
        .map(|competitor| competitor.name.as_str())
}

fn accuracy_headline(results: &Results) -> String {
    let of_setting = |wanted: fn(&crate::study::results::Verdict) -> bool| -> Vec<&str> {
        let chosen = results.competitors.iter().filter(|competitor| {
            let verdict = competitor.verdict.as_ref();
            verdict.is_some_and(wanted)
        });
        chosen.map(|competitor| competitor.name.as_str()).collect()
    };
    let baseline = results
        .competitors
        .first()
        .map_or("the baseline", |competitor| &competitor.name);
    let better = of_setting(|verdict| {
        let error = verdict.error_at_equal_time.bounds;
        !verdict.biased && error.is_some_and(|(_, high)| high < 1.0)
    });
    let worse = of_setting(|verdict| {
        let error = verdict.error_at_equal_time.bounds;
        error.is_some_and(|(low, _)| low > 1.0)
    });
    let biased = of_setting(|verdict| verdict.biased);
    let mut sentence = match better.as_slice() {
        [] => format!("At equal time, no setting is shown to have less error than {baseline}"),
        better => format!(
            "At equal time, {} {} less error than {baseline}",
            listed(better),
            if better.len() == 1 { "has" } else { "have" }
        ),
    };
    if !worse.is_empty() {
        sentence += &format!(
            "; {} {} more",
            listed(&worse),
            if worse.len() == 1 { "has" } else { "have" }
        );
    }
    sentence += ".";
    if !biased.is_empty() {
        sentence += &format!(
            " {} {} a bias that no time removes.",
            listed(&biased),
            if biased.len() == 1 { "has" } else { "have" }
        );
    }
    sentence
}

fn verdict_sentences(results: &Results) -> Vec<String> {
    let verdicts = results.competitors.iter().filter_map(|competitor| {
        let verdict = competitor.verdict.as_ref()?;
        let default = if verdict.is_default { " (default)" } else { "" };
        Some(format!(
            "{} {}{default}: {}.",
            verdict.axis,
            verdict.value,
            verdict.text.trim_end_matches('.')
        ))
    });
    verdicts.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair(estimate: f64, bounds: Option<(f64, f64)>, finding: Finding) -> Pair {
        let ratio = Interval { estimate, bounds };
        Pair {
            first: "roulette".to_owned(),
            second: "particle-filter".to_owned(),
            relative_efficiency: ratio,
            efficiency: ratio,
            reflected_efficiency: ratio,
            finding,
        }
    }

    #[test]
    fn a_faster_second_needs_a_share_of_the_time() {
        let pair = pair(1.613, Some((1.43, 1.82)), Finding::SecondBetter);
        assert_eq!(
            pair_sentence(&pair),
            "particle-filter reaches the same error as roulette in 0.62 of the time (95 % interval 0.55 to 0.70)."
        );
    }

    #[test]
    fn a_slower_second_needs_a_multiple_of_the_time() {
        let slower = pair(0.5, Some((0.4, 0.625)), Finding::FirstBetter);
        assert_eq!(
            pair_sentence(&slower),
            "particle-filter is slower than roulette: it needs 2.00 times the time for the same error (95 % interval 1.60 \
             to 2.50)."
        );
        let unbounded = pair(0.5, Some((-0.1, 0.8)), Finding::FirstBetter);
        assert!(pair_sentence(&unbounded).ends_with("(95 % interval from 1.25 upwards)."));
    }

    #[test]
    fn an_interval_that_holds_1_shows_nothing_and_one_repetition_has_none() {
        let equal = pair(1.03, Some((0.94, 1.12)), Finding::NoDifferenceShown);
        assert_eq!(
            pair_sentence(&equal),
            "No difference shown between roulette and particle-filter (ratio 1.03, 95 % interval 0.94 to 1.12)."
        );
        // Whatever the finding pretends.
        let single = pair(3.0, None, Finding::SecondBetter);
        assert_eq!(
            pair_sentence(&single),
            "No difference can be shown between roulette and particle-filter: a single repetition leaves no interval \
             (ratio 3.00)."
        );
    }
}
