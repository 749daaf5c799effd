//! Competitors held against each other.

use super::measures::Repetitions;
use super::results::{Errors, Finding, Pair};
use super::statistics::{Interval, products};

/// A competitor at the end of its budget.
#[derive(Clone, Copy, Debug)]
pub struct Contender<'a> {
    /// Its name.
    pub name: &'a str,
    /// What its repetitions reached.
    pub repetitions: Repetitions<'a>,
}

/// Every pair of competitors, the earlier one first.
pub fn pairs(contenders: &[Contender]) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for (index, first) in contenders.iter().enumerate() {
        for second in &contenders[index + 1..] {
            pairs.push(pair(first, second));
        }
    }
    pairs
}

impl Finding {
    /// What the interval of a ratio of efficiencies says, where above 1 the second is better.
    pub fn of(ratio: &Interval) -> Self {
        match ratio.bounds {
            Some((low, _)) if low > 1.0 => Self::SecondBetter,
            Some((_, high)) if high < 1.0 => Self::FirstBetter,
            _ => Self::NoDifferenceShown,
        }
    }
}

fn pair(first: &Contender, second: &Contender) -> Pair {
    let ratio = |error: fn(&Errors) -> f64| {
        let work = |of: &Repetitions| products(&of.column(error), of.seconds);
        Interval::of_ratio(&work(&first.repetitions), &work(&second.repetitions))
    };
    let relative_efficiency = ratio(|e| e.relative_mse);
    Pair {
        first: first.name.to_owned(),
        second: second.name.to_owned(),
        relative_efficiency,
        efficiency: ratio(|e| e.mse),
        reflected_efficiency: ratio(|e| e.reflected.relative_mse),
        finding: Finding::of(&relative_efficiency),
    }
}
