//! Intervals of numbers whose distribution is known, and courses whose slope is.

use super::*;
use crate::sampling::{RandomStream, StreamKey};

#[test]
fn one_repetition_has_no_bounds_and_none_no_estimate() {
    for interval in [Interval::of_mean(&[2.0]), Interval::of_positive(&[2.0])] {
        assert_eq!((interval.estimate, interval.bounds), (2.0, None));
        assert!(!interval.holds(2.0));
    }
    assert_eq!(Interval::of_ratio(&[2.0], &[4.0]).estimate, 0.5);
    assert_eq!(Interval::of_ratio(&[2.0], &[4.0]).bounds, None);
    for interval in [
        Interval::of_mean(&[]),
        Interval::of_positive(&[1.0, f64::NAN]),
        Interval::of_ratio(&[], &[]),
        Interval::of_ratio(&[1.0, -2.0], &[1.0, 1.0]),
    ] {
        assert!(interval.estimate.is_nan() && interval.bounds.is_none());
    }
}

#[test]
fn equal_values_leave_no_doubt() {
    assert_eq!(Interval::of_mean(&[0.25; 4]).bounds, Some((0.25, 0.25)));
    let ratio = Interval::of_ratio(&[3.0; 4], &[2.0; 4]);
    assert_eq!((ratio.estimate, ratio.bounds), (1.5, Some((1.5, 1.5))));
}

#[test]
fn what_slows_both_down_does_not_blur_their_ratio() {
    let drift = [1.0, 3.0, 2.0, 1.5, 2.5];
    let drifting = |noise: [f64; 5]| -> Vec<f64> {
        let pairs = drift.iter().zip(noise);
        pairs.map(|(drift, noise)| drift * noise).collect()
    };
    let slow = drifting([2.04, 1.98, 2.0, 2.02, 1.96]);
    let fast = drifting([0.99, 1.0, 1.01, 1.01, 1.0]);
    let ratio = Interval::of_ratio(&slow, &fast);
    let (low, high) = ratio.bounds.unwrap();
    assert!(
        1.9 < low && low < 2.0 && 2.0 < high && high < 2.1,
        "{ratio:?}"
    );
}

#[test]
fn two_values_have_a_wide_interval_and_many_that_of_the_normal() {
    // Student's t has 12.7 for two values.
    let (low, high) = Interval::of_mean(&[-1.0, 1.0]).bounds.unwrap();
    assert!(high > 8.0 && high < 20.0 && low == -high, "{high}");
    let many: Vec<f64> = (0..1000).map(|i| f64::from(i % 2)).collect();
    let (low, high) = Interval::of_mean(&many).bounds.unwrap();
    let want = 2.0 * 1.96 * 0.5 / 1000_f64.sqrt();
    assert!(((high - low) / want - 1.0).abs() < 0.05);
}

#[test]
fn positive_measures_have_positive_intervals_and_others_fall_back() {
    let wide = Interval::of_positive(&[1.0, 3.0, 2.0]);
    let (low, high) = wide.bounds.unwrap();
    assert!(low > 0.0 && (wide.estimate / low - high / wide.estimate).abs() < 1e-9);
    let mixed = [1.0, -0.5, 0.25];
    assert_eq!(Interval::of_positive(&mixed), Interval::of_mean(&mixed));
    let firefly = [1.0, 1.0, 1.0, 1.0, 1e6];
    let (low, high) = Interval::of_positive(&firefly).bounds.unwrap();
    assert!(low < high && high.is_finite());
}

#[test]
fn intervals_are_the_same_every_time_and_scale_with_their_values() {
    let values = [1.0, 1.5, 1.25, 0.75];
    assert_eq!(
        Interval::of_positive(&values),
        Interval::of_positive(&values)
    );
    let (low, high) = Interval::of_positive(&values).bounds.unwrap();
    let scaled = Interval::of_positive(&values.map(|v| 1e-9 * v))
        .bounds
        .unwrap();
    assert!((scaled.0 / low / 1e-9 - 1.0).abs() < 1e-9);
    assert!((scaled.1 / high / 1e-9 - 1.0).abs() < 1e-9);
}

#[test]
fn a_shared_error_widens_by_squares() {
    let values = [1.0, 1.5, 1.25, 0.75];
    let half = |shared| {
        let (low, high) = Interval::of_mean_with_error(&values, shared)
            .bounds
            .unwrap();
        (high - low) / 2.0
    };
    assert_eq!(
        Interval::of_mean(&values),
        Interval::of_mean_with_error(&values, 0.0)
    );
    // Where it is all there is, the interval is that of the normal distribution.
    assert!((half(100.0) / 196.0 - 1.0).abs() < 0.05, "{}", half(100.0));
    let only = Interval::of_mean_with_error(&[1.0; 3], 0.1).bounds.unwrap();
    assert!(((only.1 - 1.0) / 0.196 - 1.0).abs() < 0.05, "{only:?}");
    assert!(half(0.4) > half(0.0));
}

#[test]
fn reciprocals_and_roots_keep_the_order() {
    let interval = Interval {
        estimate: 4.0,
        bounds: Some((1.0, 16.0)),
    };
    assert_eq!(interval.reciprocal().bounds, Some((1.0 / 16.0, 1.0)));
    assert_eq!(interval.square_root().bounds, Some((1.0, 4.0)));
    let unsure = Interval {
        estimate: 4.0,
        bounds: Some((-1.0, 9.0)),
    };
    assert_eq!(unsure.reciprocal().bounds, None);
    assert_eq!(unsure.square_root().bounds, Some((0.0, 3.0)));
    assert!(
        Interval::of_mean(&[-1.0, -2.0])
            .reciprocal()
            .estimate
            .is_nan()
    );
}

#[test]
fn products_have_the_mean_of_the_product_of_means() {
    let products = products(&[1.0, 3.0], &[10.0, 20.0]);
    assert_eq!(products.iter().sum::<f64>() / 2.0, 2.0 * 15.0);
}

/// A repetition whose error is `scale` / seconds, with noise.
fn course(scale: f64, noise: f64, random: &mut RandomStream) -> Vec<CoursePoint> {
    let times = [1.0, 2.0, 4.0, 8.0, 16.0];
    let point = |seconds: f64| CoursePoint {
        seconds,
        error: scale / seconds * (noise * (random.uniform_f64() - 0.5)).exp(),
    };
    times.map(point).into()
}

fn courses(noise: f64) -> Vec<Vec<CoursePoint>> {
    let mut random = RandomStream::new(StreamKey {
        seed: 3,
        tile: 0,
        pass: 0,
    });
    (0..5).map(|_| course(8.0, noise, &mut random)).collect()
}

#[test]
fn variance_falls_with_a_slope_of_minus_one() {
    let exact = slope(&courses(0.0)).unwrap();
    assert!((exact.estimate + 1.0).abs() < 1e-12);
    let noisy = slope(&courses(0.3)).unwrap();
    assert!(noisy.holds(-1.0) && !noisy.holds(-0.5), "{noisy:?}");
    assert_eq!(slope(&[]), None);
    assert_eq!(
        slope(&[course(8.0, 0.0, &mut stream())[..1].to_vec()]),
        None
    );
}

fn stream() -> RandomStream {
    RandomStream::new(StreamKey {
        seed: 0,
        tile: 0,
        pass: 0,
    })
}

#[test]
fn time_to_an_error_is_interpolated_within_and_extrapolated_outside() {
    for (target, seconds, extrapolated) in [
        (8.0 / 3.0, 3.0, false),
        (0.5, 16.0, false),
        (8.0 / 64.0, 64.0, true),
        (80.0, 0.1, true),
    ] {
        let found = time_to_reach(&courses(0.0), target);
        let estimate = found.seconds.unwrap().estimate;
        assert!(
            (estimate / seconds - 1.0).abs() < 1e-9,
            "{target}: {estimate}"
        );
        assert_eq!(found.extrapolated, extrapolated, "{target}");
    }
    let noisy = time_to_reach(&courses(0.3), 1.0);
    assert!(noisy.seconds.unwrap().holds(8.0) && !noisy.extrapolated);
}

#[test]
fn errors_that_do_not_fall_are_never_reached() {
    let flat = |seconds| CoursePoint {
        seconds,
        error: 1.0,
    };
    let repetitions = vec![vec![flat(1.0), flat(2.0)]; 3];
    assert_eq!(time_to_reach(&repetitions, 0.1).seconds, None);
    assert_eq!(time_to_reach(&[], 0.1).seconds, None);
}
