//! Numbers as people read them: as many digits as the interval carries.

use crate::study::statistics::Interval;

/// An estimate as text, with its interval where there is one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shown {
    /// The estimate.
    pub value: String,
    /// `lower to upper`, in the digits of the estimate.
    pub range: Option<String>,
}

/// An interval in the digits that it carries.
pub fn shown(interval: &Interval) -> Shown {
    let ends = interval
        .bounds
        .filter(|(low, high)| low.is_finite() && high.is_finite());
    let Some((low, high)) = ends.filter(|_| interval.estimate.is_finite()) else {
        return Shown {
            value: significant(interval.estimate, 3),
            range: None,
        };
    };
    let largest = interval.estimate.abs().max(low.abs()).max(high.abs());
    if largest == 0.0 {
        return Shown {
            value: "0".to_owned(),
            range: Some("0 to 0".to_owned()),
        };
    }
    let magnitude = magnitude_of(largest);
    let power = power_to_split_off(magnitude);
    let scale = 10_f64.powi(-power);
    // No more than five digits, however narrow the interval is.
    let finest = 4 - (magnitude - power);
    let half = (high - low) / 2.0 * scale;
    let decimals = if half > 0.0 {
        // One digit of the half width, or two if the first is small: else 0.96 to 1.14 would read 1.0 to 1.1.
        let first = magnitude_of(half);
        let is_small = half < 5.0 * 10_f64.powi(first);
        (i32::from(is_small) - first).min(finest)
    } else {
        finest
    };
    let decimals = decimals.max(0) as usize;
    let text = |value: f64| minus(format!("{:.decimals$}", value * scale));
    let (value, range) = (
        text(interval.estimate),
        format!("{} to {}", text(low), text(high)),
    );
    match power {
        0 => Shown {
            value,
            range: Some(range),
        },
        _ => Shown {
            value: value + &times_ten_to(power),
            range: Some(format!("({range}){}", times_ten_to(power))),
        },
    }
}

/// A share in per cent.
pub fn shown_percent(interval: &Interval) -> Shown {
    let mut shown = shown(&scaled(interval, 100.0));
    shown.value += " %";
    shown
}

/// The interval of the quantity times a positive `factor`.
pub fn scaled(interval: &Interval, factor: f64) -> Interval {
    Interval {
        estimate: interval.estimate * factor,
        bounds: interval
            .bounds
            .map(|(low, high)| (low * factor, high * factor)),
    }
}

/// A number with so many significant digits.
pub fn significant(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return "not known".to_owned();
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    // Rounding first, so that 9.999 counts as 10.
    let rounded: f64 = format!("{value:.*e}", digits.saturating_sub(1))
        .parse()
        .unwrap_or(value);
    let magnitude = magnitude_of(rounded);
    let power = power_to_split_off(magnitude);
    let decimals = (digits as i32 - 1 - (magnitude - power)).max(0) as usize;
    let text = minus(format!("{:.decimals$}", rounded * 10_f64.powi(-power)));
    match power {
        0 => text,
        _ => text + &times_ten_to(power),
    }
}

/// The same without zeros after the last other decimal, and 10⁷ instead of 1 × 10⁷.
pub fn short(value: f64, digits: usize) -> String {
    let text = significant(value, digits);
    let (mantissa, power) = text.split_at(text.find(" × ").unwrap_or(text.len()));
    let mantissa = match mantissa.contains('.') {
        true => mantissa.trim_end_matches('0').trim_end_matches('.'),
        false => mantissa,
    };
    match (mantissa, power.strip_prefix(" × ")) {
        ("1", Some(power)) => power.to_owned(),
        _ => format!("{mantissa}{power}"),
    }
}

/// Seconds in a unit that suits them.
pub fn duration(seconds: f64) -> String {
    if seconds < 120.0 {
        format!("{} s", short(seconds, 3))
    } else if seconds < 7200.0 {
        format!("{} min", short(seconds / 60.0, 3))
    } else {
        format!("{} h", short(seconds / 3600.0, 3))
    }
}

/// The names with commas, and "and" before the last.
pub fn listed(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [rest @ .., last] => format!("{} and {last}", rest.join(", ")),
    }
}

/// The number with the unit's singular or plural (an s).
pub fn counted(count: u64, unit: &str) -> String {
    match count {
        1 => format!("1 {unit}"),
        _ => format!("{count} {unit}s"),
    }
}

fn magnitude_of(value: f64) -> i32 {
    value.abs().log10().floor() as i32
}

/// The power of ten that is written apart; 0 for numbers that are read well as they are.
fn power_to_split_off(magnitude: i32) -> i32 {
    if (-3..6).contains(&magnitude) {
        0
    } else {
        magnitude
    }
}

fn times_ten_to(power: i32) -> String {
    let power = power.to_string();
    let superscript = power.chars().map(|digit| match digit {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        '9' => '⁹',
        _ => '⁰',
    });
    format!(" × 10{}", superscript.collect::<String>())
}

fn minus(text: String) -> String {
    // Not "−0.0" for what rounds to nothing.
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|digit| matches!(digit, '0' | '.')) => rest.to_owned(),
        Some(rest) => format!("−{rest}"),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(estimate: f64, low: f64, high: f64) -> String {
        let shown = shown(&Interval {
            estimate,
            bounds: Some((low, high)),
        });
        format!("{} [{}]", shown.value, shown.range.unwrap())
    }

    #[test]
    fn an_interval_decides_the_digits() {
        assert_eq!(text(0.6231, 0.5512, 0.7049), "0.62 [0.55 to 0.70]");
        assert_eq!(text(1.0, 0.99871, 1.00133), "1.0000 [0.9987 to 1.0013]");
        assert_eq!(text(-0.0004, -0.0121, 0.0113), "0.000 [−0.012 to 0.011]");
        assert_eq!(
            text(5.12e-5, 4.81e-5, 5.49e-5),
            "5.12 × 10⁻⁵ [(4.81 to 5.49) × 10⁻⁵]"
        );
        assert_eq!(text(123.0, 80.0, 190.0), "123 [80 to 190]");
        assert_eq!(text(2.0, 2.0, 2.0), "2.0000 [2.0000 to 2.0000]");
        assert_eq!(text(0.0, 0.0, 0.0), "0 [0 to 0]");
    }

    #[test]
    fn without_an_interval_three_digits() {
        assert_eq!(significant(1.0349, 3), "1.03");
        assert_eq!(significant(9.999, 3), "10.0");
        assert_eq!(significant(1.234e9, 3), "1.23 × 10⁹");
        assert_eq!(significant(-0.0051, 2), "−0.0051");
        assert_eq!(significant(f64::NAN, 3), "not known");
        assert_eq!(short(30.0, 3), "30");
        assert_eq!(short(1e7, 2), "10⁷");
        assert_eq!(short(2.5e-4, 2), "2.5 × 10⁻⁴");
        assert_eq!(duration(1800.0), "30 min");
        assert_eq!(duration(9000.0), "2.5 h");
    }
}
