//! `cohort compare`

use std::error::Error;
use std::process::ExitCode;

use clap::Args;
use cohort::study::results::StudyKind;
use cohort::study::{EntrySettings, How, Planned, StrategySpec, peer::PeerName};

use super::study_args::StudyArgs;

/// Compare strategies, and other renderers, at an equal budget
///
/// All render for the same time on the same threads, taking turns, several times over; their errors against a
/// reference become a report: one HTML page, tables, and all images. Ctrl-C stops, and the same command goes on.
#[derive(Args)]
pub struct CompareArgs {
    /// Strategies, the baseline first, with settings behind colons, such as
    /// roulette,particle-filter:population=tile
    #[arg(long, value_name = "A,B,…", value_delimiter = ',', required = true)]
    strategies: Vec<StrategySpec>,

    /// Another renderer: mitsuba, or one of its variants as in mitsuba:llvm_ad_rgb; may be given several times. It is
    /// found by the Python that COHORT_MITSUBA_PYTHON names, or python3
    #[arg(long = "peer", value_name = "PEER", value_delimiter = ',')]
    peers: Vec<PeerName>,

    #[command(flatten)]
    study: StudyArgs,
}

/// Runs the subcommand.
pub fn run(arguments: &CompareArgs) -> Result<ExitCode, Box<dyn Error>> {
    arguments.study.run(StudyKind::Compare, |base| {
        let ours = arguments.strategies.iter().map(|spec| Planned {
            name: spec.name.clone(),
            how: How::Ours(EntrySettings {
                strategy: spec.strategy,
                options: spec.options,
                sampler: spec.sampler.unwrap_or(base.sampler),
                guiding: spec.guiding.unwrap_or(base.guiding),
                adaptive: spec.adaptive.unwrap_or(base.adaptive),
                trial: spec.trial.unwrap_or(base.trial),
                ..base.clone()
            }),
            variation: None,
        });
        let peers = arguments.peers.iter().map(|peer| {
            let variant = peer.variant_for(base.colour);
            Planned {
                name: variant.to_string(),
                how: How::Mitsuba(variant),
                variation: None,
            }
        });
        ours.chain(peers).collect()
    })
}
