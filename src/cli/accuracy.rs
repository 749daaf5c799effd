//! `cohort accuracy`

use std::error::Error;
use std::process::ExitCode;

use clap::Args;
use cohort::study::results::StudyKind;
use cohort::study::{Axis, EntrySettings, StrategySpec, accuracy};

use super::study_args::StudyArgs;

/// Measure what each accuracy setting costs in time and buys in error
///
/// Every value of every setting renders for the same time as the default, taking turns with it, several times over.
/// The report says of each "costs x % time, buys y % error", and how biased it is.
#[derive(Args)]
pub struct AccuracyArgs {
    /// Settings to vary [default: all]: robust, build-quality, wavelengths, sums, max-depth, direct, threshold,
    /// termination, n-max, population, sampler
    #[arg(long, value_name = "A,B,…", value_delimiter = ',')]
    settings: Vec<Axis>,

    /// The strategy that is the default here
    #[arg(long, value_name = "NAME", default_value = "roulette")]
    strategy: StrategySpec,

    #[command(flatten)]
    study: StudyArgs,
}

/// Runs the subcommand.
pub fn run(arguments: &AccuracyArgs) -> Result<ExitCode, Box<dyn Error>> {
    arguments.study.run(StudyKind::Accuracy, |base| {
        let base = EntrySettings {
            strategy: arguments.strategy.strategy,
            options: arguments.strategy.options,
            sampler: arguments.strategy.sampler.unwrap_or(base.sampler),
            guiding: arguments.strategy.guiding.unwrap_or(base.guiding),
            adaptive: arguments.strategy.adaptive.unwrap_or(base.adaptive),
            trial: arguments.strategy.trial.unwrap_or(base.trial),
            ..base
        };
        let axes = if arguments.settings.is_empty() {
            &Axis::ALL[..]
        } else {
            &arguments.settings
        };
        accuracy::competitors(&base, axes)
    })
}
