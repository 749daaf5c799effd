//! Errors over time: how steeply they fall, and when they reach a given one.

use super::Interval;
use crate::study::results::TimeToError;

/// Where one repetition stood at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoursePoint {
    /// Seconds since it began, above 0.
    pub seconds: f64,
    /// The error by then.
    pub error: f64,
}

/// The slope of log error over log seconds, least squares by repetition, with its interval over repetitions.
///
/// The variance of a mean of independent samples falls as one over their number, which is a slope of -1. Points without
/// a positive error are left out; `None` where a repetition has fewer than two others, or all at the same time.
pub fn slope(repetitions: &[Vec<CoursePoint>]) -> Option<Interval> {
    let slopes: Option<Vec<f64>> = repetitions.iter().map(|course| slope_of(course)).collect();
    slopes
        .filter(|slopes| !slopes.is_empty())
        .map(|slopes| Interval::of_mean(&slopes))
}

/// The seconds in which `target` is reached, by repetition, with their interval.
///
/// It is the time from which on the error stays at or below the target, on straight lines between the logarithms of the
/// points. A repetition that begins below or ends above it is continued by the mean slope of all repetitions; the
/// result is marked as extrapolated where those are more than half. The seconds are `None` where a repetition has no
/// such time: there is no slope, or errors do not fall.
pub fn time_to_reach(repetitions: &[Vec<CoursePoint>], target: f64) -> TimeToError {
    let fall = slope(repetitions)
        .map(|slope| slope.estimate)
        .filter(|slope| *slope < 0.0);
    let crossings: Option<Vec<Crossing>> = repetitions
        .iter()
        .map(|course| crossing(course, target, fall))
        .collect();
    let crossings = crossings.unwrap_or_default();
    let seconds: Vec<f64> = crossings.iter().map(|crossing| crossing.seconds).collect();
    let outside = crossings.iter().filter(|crossing| crossing.outside).count();
    TimeToError {
        relative_mse: target,
        seconds: (!seconds.is_empty()).then(|| Interval::of_positive(&seconds)),
        extrapolated: 2 * outside > crossings.len(),
    }
}

struct Crossing {
    seconds: f64,
    /// Whether it lies outside of the points.
    outside: bool,
}

fn slope_of(course: &[CoursePoint]) -> Option<f64> {
    let points = logarithms(course);
    let n = points.len() as f64;
    let mean_x = points.iter().map(|[x, _]| x).sum::<f64>() / n;
    let mean_y = points.iter().map(|[_, y]| y).sum::<f64>() / n;
    let (mut xx, mut xy) = (0.0, 0.0);
    for [x, y] in points {
        xx += (x - mean_x).powi(2);
        xy += (x - mean_x) * (y - mean_y);
    }
    // Also false without points, where it is not a number.
    (xx > 0.0).then(|| xy / xx)
}

fn crossing(course: &[CoursePoint], target: f64, fall: Option<f64>) -> Option<Crossing> {
    let points = logarithms(course);
    let goal = target.ln();
    let beyond = |[x, y]: [f64; 2]| {
        fall.filter(|_| goal.is_finite()).map(|fall| Crossing {
            seconds: (x + (goal - y) / fall).exp(),
            outside: true,
        })
    };
    let last = *points.last()?;
    let Some(above) = points.iter().rposition(|[_, y]| *y > goal) else {
        // The first point's own error is no extrapolation.
        return if points[0][1] == goal {
            Some(Crossing {
                seconds: points[0][0].exp(),
                outside: false,
            })
        } else {
            beyond(points[0])
        };
    };
    let Some(&[x1, y1]) = points.get(above + 1) else {
        return beyond(last);
    };
    let [x0, y0] = points[above];
    Some(Crossing {
        seconds: (x0 + (x1 - x0) * (goal - y0) / (y1 - y0)).exp(),
        outside: false,
    })
}

/// Log seconds and log error of the points that have them.
fn logarithms(course: &[CoursePoint]) -> Vec<[f64; 2]> {
    let logarithms = course
        .iter()
        .map(|point| [point.seconds.ln(), point.error.ln()]);
    logarithms
        .filter(|[x, y]| x.is_finite() && y.is_finite())
        .collect()
}
