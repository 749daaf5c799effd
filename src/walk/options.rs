//! Building a strategy from its name and the settings that a user has given.

use std::fmt::{self, Display};
use std::str::FromStr;

use serde::Serialize;

use super::error::list;
use super::{
    AdjointRoulette, CountRule, Ears, FixedDepth, GoWithTheWinners, Objective, ParticleFilter,
    Roulette, Rounding, Scope, SettingError, Strategy, ThroughputRoulette,
};

/// The strategies that can be asked for by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum StrategyKind {
    /// [`FixedDepth`].
    FixedDepth,
    /// [`Roulette`].
    Roulette,
    /// [`ThroughputRoulette`].
    ThroughputRoulette,
    /// [`GoWithTheWinners`].
    GoWithTheWinners,
    /// [`ParticleFilter`].
    ParticleFilter,
    /// [`AdjointRoulette`].
    AdjointRoulette,
    /// [`Ears`].
    Ears,
    /// [`ParticleFilter`] with the settings of [`ParticleFilter::paper`].
    PaperParticleFilter,
}

/// What a user has set; `None` is the strategy's default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct StrategyOptions {
    /// T of [`Roulette`].
    pub threshold: Option<f32>,
    /// P of [`Roulette`].
    pub termination: Option<f32>,
    /// The first reflection at stake in [`ThroughputRoulette`].
    pub from_depth: Option<u32>,
    /// By what [`ParticleFilter`] chooses the expected counts.
    pub rule: Option<CountRule>,
    /// Which error [`Ears`] and [`ParticleFilter`] make small.
    pub objective: Option<Objective>,
    /// n_max of [`GoWithTheWinners`] and [`ParticleFilter`].
    pub n_max: Option<f32>,
    /// The joint population of [`ParticleFilter`].
    pub population: Option<Scope>,
    /// How [`ParticleFilter`] draws its integers.
    pub counts: Option<Rounding>,
}

impl StrategyOptions {
    /// The names of the settings that were given.
    fn given(&self) -> impl Iterator<Item = &'static str> {
        let given = [
            ("threshold", self.threshold.is_some()),
            ("termination", self.termination.is_some()),
            ("from-depth", self.from_depth.is_some()),
            ("rule", self.rule.is_some()),
            ("objective", self.objective.is_some()),
            ("n-max", self.n_max.is_some()),
            ("population", self.population.is_some()),
            ("counts", self.counts.is_some()),
        ];
        given
            .into_iter()
            .filter(|&(_, is_given)| is_given)
            .map(|(name, _)| name)
    }
}

impl StrategyKind {
    /// Every strategy.
    pub const ALL: [Self; 8] = [
        Self::FixedDepth,
        Self::Roulette,
        Self::ThroughputRoulette,
        Self::GoWithTheWinners,
        Self::AdjointRoulette,
        Self::Ears,
        Self::ParticleFilter,
        Self::PaperParticleFilter,
    ];

    /// The name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::FixedDepth => FixedDepth::NAME,
            Self::Roulette => Roulette::NAME,
            Self::ThroughputRoulette => ThroughputRoulette::NAME,
            Self::GoWithTheWinners => GoWithTheWinners::NAME,
            Self::AdjointRoulette => AdjointRoulette::NAME,
            Self::Ears => Ears::NAME,
            Self::ParticleFilter => ParticleFilter::NAME,
            Self::PaperParticleFilter => "paper-particle-filter",
        }
    }

    /// The settings that the strategy has.
    pub fn settings(self) -> &'static [&'static str] {
        match self {
            Self::FixedDepth | Self::AdjointRoulette | Self::PaperParticleFilter => &[],
            Self::Ears => &["objective"],
            Self::Roulette => &["threshold", "termination"],
            Self::ThroughputRoulette => &["from-depth"],
            Self::GoWithTheWinners => &["n-max"],
            Self::ParticleFilter => &["rule", "objective", "n-max", "population", "counts"],
        }
    }

    /// The strategy with the settings of `options`, and its defaults where they say nothing.
    ///
    /// # Errors
    /// If a value is out of its range, or belongs to a setting that this strategy does not have.
    pub fn build(self, options: &StrategyOptions) -> Result<Box<dyn Strategy>, SettingError> {
        self.refuse_foreign(options)?;
        Ok(match self {
            Self::FixedDepth => Box::new(FixedDepth),
            Self::Roulette => Box::new(Roulette::new(
                options.threshold.unwrap_or(Roulette::DEFAULT_THRESHOLD),
                options.termination.unwrap_or(Roulette::DEFAULT_TERMINATION),
            )?),
            Self::ThroughputRoulette => Box::new(ThroughputRoulette::new(
                options
                    .from_depth
                    .unwrap_or(ThroughputRoulette::DEFAULT_FROM_DEPTH),
            )),
            Self::GoWithTheWinners => Box::new(GoWithTheWinners::new(
                options.n_max.unwrap_or(GoWithTheWinners::DEFAULT_N_MAX),
            )?),
            Self::AdjointRoulette => Box::new(AdjointRoulette),
            Self::Ears => Box::new(Ears::new(options.objective.unwrap_or_default())),
            Self::ParticleFilter => Box::new(particle_filter(options)?),
            Self::PaperParticleFilter => Box::new(ParticleFilter::paper()),
        })
    }

    /// Refuses settings that would be ignored.
    fn refuse_foreign(self, options: &StrategyOptions) -> Result<(), SettingError> {
        let own = self.settings();
        match options.given().find(|name| !own.contains(name)) {
            None => Ok(()),
            Some(setting) => Err(SettingError::NotASetting {
                strategy: self.name(),
                setting,
                known: match self {
                    Self::PaperParticleFilter => format!(
                        "it is `{}` with the paper's settings, and that one has {}",
                        ParticleFilter::NAME,
                        list(Self::ParticleFilter.settings())
                    ),
                    _ if own.is_empty() => "it has none".to_owned(),
                    _ => format!("it has {}", list(own)),
                },
            }),
        }
    }
}

/// The filter that the options ask for.
fn particle_filter(options: &StrategyOptions) -> Result<ParticleFilter, SettingError> {
    let population = options
        .population
        .unwrap_or(ParticleFilter::DEFAULT_POPULATION);
    let counts = options.counts.unwrap_or(ParticleFilter::DEFAULT_COUNTS);
    // A number of particles asks for the rule that has one.
    let rule = options.rule.unwrap_or(match options.n_max {
        Some(_) => CountRule::Importance,
        None => CountRule::Learned,
    });
    let foreign = match rule {
        CountRule::Learned => options.n_max.map(|_| ("n-max", "rule=importance")),
        CountRule::Importance => options.objective.map(|_| ("objective", "rule=learned")),
    };
    if let Some((setting, with)) = foreign {
        return Err(SettingError::NotASetting {
            strategy: ParticleFilter::NAME,
            setting,
            known: format!("that belongs to {with}, and this is rule={rule}"),
        });
    }
    match rule {
        CountRule::Learned => {
            ParticleFilter::learned(options.objective.unwrap_or_default(), population, counts)
        }
        CountRule::Importance => {
            let n_max = options.n_max;
            let n_max = n_max.unwrap_or(ParticleFilter::default_n_max(population));
            ParticleFilter::new(n_max, population, counts)
        }
    }
}

impl Display for StrategyKind {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for StrategyKind {
    type Err = SettingError;

    fn from_str(text: &str) -> Result<Self, SettingError> {
        SettingError::choose("strategy", text, &Self::ALL)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(kind: StrategyKind, options: StrategyOptions) -> String {
        kind.build(&options)
            .expect_err("must be refused")
            .to_string()
    }

    #[test]
    fn names_can_be_read_back() {
        for kind in StrategyKind::ALL {
            assert_eq!(kind.to_string().parse(), Ok(kind));
        }
        for counts in Rounding::ALL {
            assert_eq!(counts.to_string().parse(), Ok(counts));
        }
        for scope in Scope::JOINT {
            assert_eq!(scope.to_string().parse(), Ok(scope));
        }
        assert_eq!(
            "rullette".parse::<StrategyKind>().unwrap_err().to_string(),
            "there is no strategy `rullette`; choose one of fixed-depth, roulette, throughput-roulette, \
             go-with-the-winners, adjoint-roulette, ears, particle-filter, paper-particle-filter"
        );
        assert!("particle".parse::<Scope>().is_err());
    }

    #[test]
    fn defaults_are_the_documented_ones() {
        let settings = |kind: StrategyKind, population| {
            let options = StrategyOptions {
                population,
                ..Default::default()
            };
            let strategy = kind.build(&options).unwrap();
            let settings = strategy
                .settings()
                .into_iter()
                .map(|(name, value)| format!("{name} {value}"));
            (strategy.name(), settings.collect::<Vec<_>>().join(", "))
        };
        assert_eq!(
            settings(StrategyKind::FixedDepth, None),
            ("fixed-depth", String::new())
        );
        assert_eq!(
            settings(StrategyKind::Roulette, None),
            ("roulette", "threshold 0.1, termination 0.5".to_owned())
        );
        assert_eq!(
            settings(StrategyKind::ThroughputRoulette, None),
            ("throughput-roulette", "from-depth 5".to_owned())
        );
        assert_eq!(
            settings(StrategyKind::GoWithTheWinners, None),
            ("go-with-the-winners", "n-max 10".to_owned())
        );
        for (population, expected) in [
            (
                None,
                "rule learned, objective relative, population pixel, counts systematic",
            ),
            (
                Some(Scope::Tile),
                "rule learned, objective relative, population tile, counts systematic",
            ),
        ] {
            assert_eq!(
                settings(StrategyKind::ParticleFilter, population),
                ("particle-filter", expected.to_owned())
            );
        }
        assert_eq!(
            settings(StrategyKind::Ears, None),
            ("ears", "objective relative".to_owned())
        );
        for (population, n_max) in [(Scope::CameraPath, "10"), (Scope::Pixel, "1")] {
            let options = StrategyOptions {
                rule: Some(CountRule::Importance),
                population: Some(population),
                ..Default::default()
            };
            let settings = StrategyKind::ParticleFilter
                .build(&options)
                .unwrap()
                .settings();
            assert_eq!(settings[0], ("rule", "importance".to_owned()));
            assert_eq!(settings[1], ("n-max", n_max.to_owned()));
        }
        assert_eq!(
            settings(StrategyKind::PaperParticleFilter, None),
            (
                "particle-filter",
                "rule importance, n-max 10, population camera-path, counts multinomial".to_owned()
            )
        );
    }

    #[test]
    fn given_settings_are_used() {
        let all = [
            (
                StrategyKind::Roulette,
                StrategyOptions {
                    threshold: Some(0.25),
                    termination: Some(0.75),
                    ..Default::default()
                },
            ),
            (
                StrategyKind::ThroughputRoulette,
                StrategyOptions {
                    from_depth: Some(9),
                    ..Default::default()
                },
            ),
            (
                StrategyKind::GoWithTheWinners,
                StrategyOptions {
                    n_max: Some(3.5),
                    ..Default::default()
                },
            ),
            (
                StrategyKind::ParticleFilter,
                StrategyOptions {
                    n_max: Some(2.5),
                    population: Some(Scope::Tile),
                    counts: Some(Rounding::Stratified),
                    ..Default::default()
                },
            ),
        ];
        let values = all.map(|(kind, options)| {
            let settings = kind.build(&options).unwrap().settings();
            let known = |(name, _): &(&str, String)| kind.settings().contains(name);
            assert!(settings.iter().all(known), "{settings:?}");
            settings
                .into_iter()
                .map(|(_, value)| value)
                .collect::<Vec<_>>()
                .join(" ")
        });
        assert_eq!(
            values,
            ["0.25 0.75", "9", "3.5", "importance 2.5 tile stratified"]
        );
    }

    #[test]
    fn settings_of_another_strategy_are_refused() {
        let n_max = StrategyOptions {
            n_max: Some(4.0),
            ..Default::default()
        };
        assert_eq!(
            refusal(StrategyKind::Roulette, n_max),
            "the strategy `roulette` has no setting `n-max`; it has threshold, termination"
        );
        assert_eq!(
            refusal(StrategyKind::FixedDepth, n_max),
            "the strategy `fixed-depth` has no setting `n-max`; it has none"
        );
        assert_eq!(
            refusal(StrategyKind::PaperParticleFilter, n_max),
            "the strategy `paper-particle-filter` has no setting `n-max`; it is `particle-filter` with the \
             paper's settings, and that one has rule, objective, n-max, population, counts"
        );
    }

    #[test]
    fn settings_of_the_other_rule_are_refused() {
        let learned = StrategyOptions {
            rule: Some(CountRule::Learned),
            n_max: Some(2.0),
            ..Default::default()
        };
        let importance = StrategyOptions {
            rule: Some(CountRule::Importance),
            objective: Some(Objective::Mse),
            ..Default::default()
        };
        let message = refusal(StrategyKind::ParticleFilter, learned);
        assert!(
            message.contains("`n-max`; that belongs to rule=importance"),
            "{message}"
        );
        let message = refusal(StrategyKind::ParticleFilter, importance);
        assert!(
            message.contains("`objective`; that belongs to rule=learned"),
            "{message}"
        );
    }

    #[test]
    fn values_out_of_range_are_refused() {
        for threshold in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            let options = StrategyOptions {
                threshold: Some(threshold),
                ..Default::default()
            };
            assert!(refusal(StrategyKind::Roulette, options).contains("positive and finite"));
        }
        for termination in [-0.1, 1.0, f32::NAN] {
            let options = StrategyOptions {
                termination: Some(termination),
                ..Default::default()
            };
            assert!(refusal(StrategyKind::Roulette, options).contains("at least 0 and below 1"));
        }
        for n_max in [0.0, -1.0, 1025.0, f32::NAN, f32::INFINITY] {
            let options = StrategyOptions {
                n_max: Some(n_max),
                ..Default::default()
            };
            for kind in [StrategyKind::GoWithTheWinners, StrategyKind::ParticleFilter] {
                assert!(refusal(kind, options).contains("positive and at most 1024"));
            }
        }
        let error = ParticleFilter::new(1.0, Scope::Particle, Rounding::Systematic).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the strategy `particle-filter` cannot have population = particle: it must be camera-path, pixel or tile"
        );
    }
}
