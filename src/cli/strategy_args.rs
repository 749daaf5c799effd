//! Which strategy, and its settings.

use clap::Args;
use cohort::walk::{
    CountRule, Objective, Rounding, Scope, SettingError, Strategy, StrategyKind, StrategyOptions,
};

/// Which strategy, and its settings.
#[derive(Args)]
#[command(next_help_heading = "Strategy")]
pub struct StrategyArgs {
    /// Who decides how long paths are followed: fixed-depth, roulette, throughput-roulette, go-with-the-winners,
    /// adjoint-roulette, ears, particle-filter or paper-particle-filter [default: particle-filter, with array-qmc and guiding]
    #[arg(long, value_name = "NAME")]
    strategy: Option<StrategyKind>,

    /// roulette: importance below which a path may end (the paper's T) [default: 0.1]
    #[arg(long, value_name = "T")]
    threshold: Option<f32>,

    /// roulette: probability of ending (the paper's P) [default: 0.5]
    #[arg(long, value_name = "P")]
    termination: Option<f32>,

    /// throughput-roulette: number of segments from which on a path may end [default: the scene's rr_depth]
    #[arg(long, value_name = "N")]
    from_depth: Option<u32>,

    /// particle-filter: by what children are counted: learned or importance [default: learned, or importance where --n-max is given]
    #[arg(long, value_name = "NAME")]
    rule: Option<CountRule>,

    /// ears, particle-filter: which error is to become small: relative or mse [default: relative]
    #[arg(long, value_name = "NAME")]
    objective: Option<Objective>,

    /// go-with-the-winners, particle-filter by importance: most children of a vertex of full importance [default: 10, or 1 for
    /// the populations pixel and tile]
    #[arg(long, value_name = "N")]
    n_max: Option<f32>,

    /// particle-filter: which paths are resampled together: camera-path, pixel or tile [default: pixel]
    #[arg(long, value_name = "NAME")]
    population: Option<Scope>,

    /// particle-filter: how counts are drawn: multinomial, stratified, systematic, residual or residual-stratified
    /// [default: systematic]
    #[arg(long, value_name = "NAME")]
    counts: Option<Rounding>,
}

impl StrategyArgs {
    /// Whether a strategy is asked for by its name.
    pub fn is_named(&self) -> bool {
        self.strategy.is_some()
    }

    /// The strategy; `roulette_depth` is the scene's own choice for `throughput-roulette`.
    ///
    /// # Errors
    /// Settings that the strategy does not have, and values out of their range.
    pub fn build(&self, roulette_depth: u32) -> Result<Box<dyn Strategy>, SettingError> {
        let strategy = self.strategy.unwrap_or(StrategyKind::ParticleFilter);
        let of_scene = match strategy {
            StrategyKind::ThroughputRoulette => Some(roulette_depth),
            _ => None,
        };
        strategy.build(&StrategyOptions {
            threshold: self.threshold,
            termination: self.termination,
            from_depth: self.from_depth.or(of_scene),
            rule: self.rule,
            objective: self.objective,
            n_max: self.n_max,
            population: self.population,
            counts: self.counts,
        })
    }
}
