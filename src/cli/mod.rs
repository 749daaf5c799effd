//! The command line: one file per subcommand, no rendering logic.

mod accuracy;
mod compare;
mod explain;
mod interrupt;
mod models;
mod output;
mod parse;
mod render;
mod report;
mod scene_args;
mod strategy_args;
mod study_args;
mod study_bar;

use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

/// An unbiased spectral path tracer that resamples whole cohorts of light paths together
#[derive(Parser)]
#[command(name = "cohort", arg_required_else_help = true)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Render(Box<render::RenderArgs>),
    Compare(Box<compare::CompareArgs>),
    Accuracy(Box<accuracy::AccuracyArgs>),
    Explain(explain::ExplainArgs),
    Models(models::ModelsArgs),
}

/// Runs the program. The exit code is 0 on success, 1 after an error, 2 for wrong arguments, and 130 for a render that
/// was interrupted (its image so far is written).
pub fn run() -> ExitCode {
    let matches = Arguments::command().version(version()).get_matches();
    let arguments = match Arguments::from_arg_matches(&matches) {
        Ok(arguments) => arguments,
        Err(error) => error.exit(),
    };
    let result = match arguments.command {
        Command::Render(arguments) => render::run(*arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Accuracy(arguments) => accuracy::run(&arguments),
        Command::Explain(arguments) => explain::run(&arguments).map(|()| ExitCode::SUCCESS),
        Command::Models(arguments) => models::run(arguments)
            .map(|()| ExitCode::SUCCESS)
            .map_err(Into::into),
    };
    result.unwrap_or_else(|error| {
        report::tell(error);
        ExitCode::FAILURE
    })
}

/// The program's version and that of the intersection library it runs on.
fn version() -> String {
    let embree = match cohort::embree::version() {
        Ok(version) => format!("Embree {version}"),
        Err(error) => format!("Embree not usable: {error}"),
    };
    format!("{} ({embree})", env!("CARGO_PKG_VERSION"))
}
