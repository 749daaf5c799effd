//! The middle of a few numbers.

/// The median of `values`, which are not empty and have no NaN among them.
pub fn median(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.into_iter().collect();
    values.sort_by(f64::total_cmp);
    let (lower, upper) = ((values.len() - 1) / 2, values.len() / 2);
    0.5 * (values[lower] + values[upper])
}
