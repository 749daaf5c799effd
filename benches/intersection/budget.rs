//! How much time the benchmark takes at each [`Effort`].

use std::time::Duration;

use criterion::Criterion;

use crate::effort::Effort;

/// A harness that does not take longer than this. With `--quick` criterion stops after the first round, which is
/// longer than its measuring time.
pub fn harness(effort: Effort) -> Criterion {
    let nothing = Duration::from_nanos(1);
    Criterion::default()
        .without_plots()
        .warm_up_time(Duration::from_millis(1))
        .measurement_time(effort.choose(nothing, nothing, Duration::from_millis(20)))
        .sample_size(10)
        .nresamples(1001)
}

/// Stretches of rays in each set; pairs of them are needed for a ratio.
pub fn stretches(effort: Effort) -> usize {
    effort.choose(1, 4, 16)
}

/// How long a ratio may be measured until it is sure.
pub fn comparing(effort: Effort) -> Duration {
    let quick = Duration::from_millis(5);
    effort.choose(Duration::ZERO, quick, Duration::from_millis(500))
}

/// How often each acceleration structure is built.
pub fn builds(effort: Effort) -> usize {
    effort.choose(1, 1, 3)
}
