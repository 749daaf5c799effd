//! The command-line program `cohort`.

mod cli;

fn main() -> std::process::ExitCode {
    cli::run()
}
