//! A logarithmic axis of a plot, with ticks at round numbers however short it is.

use std::ops::Range;

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};

/// A logarithmic axis for positive values.
#[derive(Clone, Debug, PartialEq)]
pub struct LogAxis(Range<f64>);

impl LogAxis {
    /// The axis that shows all of these positive values, with a little room.
    pub fn around(values: impl Iterator<Item = f64>) -> Self {
        let logs = values.filter(|value| *value > 0.0 && value.is_finite());
        let (low, high) = logs
            .map(f64::log10)
            .fold((f64::MAX, f64::MIN), |(low, high), log| {
                (low.min(log), high.max(log))
            });
        if low > high {
            return Self(0.1..1.0);
        }
        let room = ((high - low) * 0.04).max(0.02);
        Self(10_f64.powf(low - room)..10_f64.powf(high + room))
    }

    /// Round numbers on the axis: 1, 2, 5 and more where there are few powers of ten.
    fn ticks(&self) -> Vec<f64> {
        let (start, end) = (self.0.start.log10(), self.0.end.log10());
        let mantissas: &[f64] = match end - start {
            ..0.7 => &[1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0],
            ..1.6 => &[1.0, 2.0, 3.0, 5.0],
            ..3.0 => &[1.0, 2.0, 5.0],
            _ => &[1.0],
        };
        let powers = start.floor() as i32..=end.ceil() as i32;
        let all = powers.flat_map(|power| {
            let power = 10_f64.powi(power);
            mantissas.iter().map(move |mantissa| mantissa * power)
        });
        all.filter(|tick| self.0.contains(tick)).collect()
    }
}

impl Ranged for LogAxis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    /// What is not positive or lies below the axis is drawn at its lower end.
    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let value = value.max(self.0.start);
        let share = (value / self.0.start).log10() / (self.0.end / self.0.start).log10();
        limit.0 + (share * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _hint: Hint) -> Vec<f64> {
        self.ticks()
    }

    fn range(&self) -> Range<f64> {
        self.0.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_at_least_two() {
        let two_decades = LogAxis::around([0.011, 1.9].into_iter());
        assert_eq!(two_decades.ticks().len(), 7);
        let short = LogAxis::around([1.2, 2.4].into_iter());
        assert_eq!(short.ticks(), [1.5, 2.0]);
        assert_eq!(short.map(&-1.0, (10, 110)), 10);
    }
}
