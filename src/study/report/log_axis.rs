//! A logarithmic axis of a plot, with ticks at round numbers however short it is.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};

/// Steps within a power of ten, from many to few.
const STEPS: [&[f64]; 4] = [
    &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0],
    &[1.0, 2.0, 3.0, 5.0],
    &[1.0, 2.0, 5.0],
    &[1.0],
];

/// A logarithmic axis for positive values.
#[derive(Clone, Debug, PartialEq)]
pub struct LogAxis {
    range: Range<f64>,
    ticks: Vec<f64>,
}

impl LogAxis {
    /// The axis that shows all of these positive values, with a little room and at most so many ticks.
    pub fn around(values: impl Iterator<Item = f64>, most_ticks: usize) -> Self {
        let logs = values.filter(|value| *value > 0.0 && value.is_finite());
        let (low, high) = logs
            .map(f64::log10)
            .fold((f64::MAX, f64::MIN), |(low, high), log| {
                (low.min(log), high.max(log))
            });
        let (low, high) = if low > high { (-1.0, 0.0) } else { (low, high) };
        let room = ((high - low) * 0.04).max(0.02);
        let range = 10_f64.powf(low - room)..10_f64.powf(high + room);
        let powers = (low - room).floor() as i32..=(high + room).ceil() as i32;
        let ticks = |steps: &[f64]| -> Vec<f64> {
            let powers = powers.clone().map(|power| 10_f64.powi(power));
            let all = powers.flat_map(|power| steps.iter().map(move |step| step * power));
            all.filter(|tick| range.contains(tick)).collect()
        };
        let few_enough = STEPS
            .iter()
            .map(|steps| ticks(steps))
            .find(|ticks| ticks.len() <= most_ticks);
        let ticks = few_enough.unwrap_or_else(|| {
            let powers = ticks(&[1.0]);
            let step = powers.len().div_ceil(most_ticks.max(1));
            powers.into_iter().step_by(step).collect()
        });
        Self { range, ticks }
    }
}

impl Ranged for LogAxis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    /// What is not positive or lies below the axis is drawn at its lower end.
    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let value = value.max(self.range.start);
        let share =
            (value / self.range.start).log10() / (self.range.end / self.range.start).log10();
        limit.0 + (share * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _hint: Hint) -> Vec<f64> {
        self.ticks.clone()
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_few_enough() {
        let axis = LogAxis::around([0.011, 1.9].into_iter(), 8);
        let ticks = axis.ticks.iter().map(|tick| format!("{tick:.2}"));
        let ticks: Vec<String> = ticks.collect();
        assert_eq!(ticks.join(" "), "0.01 0.02 0.05 0.10 0.20 0.50 1.00 2.00");
        let short = LogAxis::around([1.2, 2.4].into_iter(), 8);
        assert_eq!(short.ticks, [1.5, 2.0]);
        let long = LogAxis::around([1e-9, 1e9].into_iter(), 5);
        assert!(long.ticks.len() <= 5);
        assert_eq!(short.map(&-1.0, (10, 110)), 10);
        assert!(LogAxis::around([].into_iter(), 8).range.contains(&0.5));
    }
}
