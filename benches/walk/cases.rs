//! What is measured: every strategy with every way to draw.

use cohort::walk::{
    CountRule, GoWithTheWinners, ParticleFilter, Rounding, Scope, SettingError, Strategy,
    StrategyKind, StrategyOptions,
};

/// A strategy, and the particles that it makes for itself.
pub struct Case {
    /// Its name.
    pub kind: StrategyKind,
    /// The strategy.
    pub strategy: Box<dyn Strategy>,
    /// How many particles it aims at per camera path.
    pub n_max: f32,
}

impl Case {
    fn new(kind: StrategyKind, options: &StrategyOptions) -> Result<Self, SettingError> {
        let strategy = kind.build(options)?;
        let n_max = match kind {
            StrategyKind::ParticleFilter | StrategyKind::PaperParticleFilter => {
                ParticleFilter::default_n_max(strategy.scope())
            }
            StrategyKind::GoWithTheWinners => GoWithTheWinners::DEFAULT_N_MAX,
            StrategyKind::FixedDepth
            | StrategyKind::Roulette
            | StrategyKind::ThroughputRoulette
            | StrategyKind::AdjointRoulette
            | StrategyKind::Ears => 1.0,
        };
        Ok(Self {
            kind,
            strategy,
            n_max,
        })
    }

    /// Every strategy as it is by default; the particle filter also in all its populations and ways to draw.
    pub fn all() -> Result<Vec<Self>, SettingError> {
        let mut cases = Vec::new();
        for kind in StrategyKind::ALL {
            // Without knowledge, those that learn decide as before their first lesson.
            if kind != StrategyKind::ParticleFilter {
                cases.push(Self::new(kind, &StrategyOptions::default())?);
                continue;
            }
            for population in Scope::JOINT {
                for counts in Rounding::ALL {
                    let options = StrategyOptions {
                        rule: Some(CountRule::Importance),
                        population: Some(population),
                        counts: Some(counts),
                        ..StrategyOptions::default()
                    };
                    cases.push(Self::new(kind, &options)?);
                }
            }
        }
        Ok(cases)
    }

    /// Strategy, population and way to draw.
    pub fn name(&self) -> [String; 3] {
        [
            self.kind.to_string(),
            self.strategy.scope().to_string(),
            self.strategy.rounding().to_string(),
        ]
    }

    /// How many of `count` particles are resampled together.
    pub fn group_size(&self, count: usize) -> usize {
        match self.strategy.scope() {
            Scope::Particle => 1,
            Scope::CameraPath => self.n_max as usize,
            // The samples of a pixel in a full pass.
            Scope::Pixel => 16,
            Scope::Tile => count,
        }
    }
}
