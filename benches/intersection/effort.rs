//! How much is measured: criterion's `--quick`, its test mode, or everything.

use std::time::Duration;

use criterion::Criterion;

/// How much time the benchmark may take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// `--test`, or `cargo test --benches`: everything runs once, on the built-in scene.
    Test,
    /// `--quick`.
    Quick,
    /// Neither.
    Full,
}

impl Effort {
    /// Reads the arguments as criterion does, which parses them itself: without `--bench`, which `cargo bench` adds,
    /// it only tests.
    pub fn from_arguments() -> Self {
        let has = |flag| std::env::args().any(|argument| argument == flag);
        if has("--test") || !has("--bench") {
            Self::Test
        } else if has("--quick") {
            Self::Quick
        } else {
            Self::Full
        }
    }

    /// A harness that does not take longer than this. With `--quick` criterion stops after the first round, which is
    /// longer than its measuring time.
    pub fn criterion(self) -> Criterion {
        let measuring = match self {
            Self::Test | Self::Quick => Duration::from_nanos(1),
            Self::Full => Duration::from_millis(20),
        };
        Criterion::default()
            .without_plots()
            .warm_up_time(Duration::from_millis(1))
            .measurement_time(measuring)
            .sample_size(10)
            .nresamples(1001)
    }

    /// Stretches of rays in each set; pairs of them are needed for a ratio.
    pub fn stretches(self) -> usize {
        match self {
            Self::Test => 1,
            Self::Quick => 4,
            Self::Full => 16,
        }
    }

    /// How long a ratio may be measured until it is sure.
    pub fn comparing(self) -> Duration {
        match self {
            Self::Test => Duration::ZERO,
            Self::Quick => Duration::from_millis(5),
            Self::Full => Duration::from_millis(500),
        }
    }

    /// How often each acceleration structure is built.
    pub fn builds(self) -> usize {
        match self {
            Self::Test | Self::Quick => 1,
            Self::Full => 3,
        }
    }
}
