//! How much work a benchmark does.

/// Told by the arguments of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// Does everything once and small, and keeps no numbers: `cargo test --benches`, `cargo bench -- --test`.
    Test,
    /// Under a minute, for a first look: `cargo bench -- --quick`.
    Quick,
    /// What tables are made of: `cargo bench`.
    Full,
}

impl Effort {
    /// As criterion reads the arguments: cargo gives `--bench` to benchmarks that are to measure.
    pub fn from_arguments() -> Self {
        let given = |name| std::env::args().any(|argument| argument == name);
        if given("--test") || !given("--bench") {
            Self::Test
        } else if given("--quick") {
            Self::Quick
        } else {
            Self::Full
        }
    }

    /// One of three, by effort.
    pub fn choose<T>(self, test: T, quick: T, full: T) -> T {
        match self {
            Self::Test => test,
            Self::Quick => quick,
            Self::Full => full,
        }
    }
}
