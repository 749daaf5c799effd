//! How numbers grow with size.

/// The slope of the line closest to the points (x, y) by least squares.
fn slope(points: impl Iterator<Item = (f64, f64)> + Clone) -> f64 {
    let count = points.clone().count() as f64;
    let mean = |of: fn((f64, f64)) -> f64| points.clone().map(of).sum::<f64>() / count;
    let (x_mean, y_mean) = (mean(|(x, _)| x), mean(|(_, y)| y));
    let (mut covariance, mut variance) = (0.0, 0.0);
    for (x, y) in points {
        covariance += (x - x_mean) * (y - y_mean);
        variance += (x - x_mean) * (x - x_mean);
    }
    covariance / variance
}

/// What is added to the value per factor 10 in size, where `points` are (size, value).
pub fn added_per_factor_10(points: &[(f64, f64)]) -> f64 {
    slope(points.iter().map(|&(size, value)| (size.log10(), value)))
}

/// The exponent of the power law closest to `points` of (size, value): 1 is linear growth, 0 is none.
pub fn exponent(points: &[(f64, f64)]) -> f64 {
    slope(points.iter().map(|&(size, value)| (size.ln(), value.ln())))
}
