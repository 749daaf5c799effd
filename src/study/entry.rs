//! Who takes part in a study.

use std::num::{NonZeroU32, NonZeroUsize};
use std::str::FromStr;

use thiserror::Error;

use crate::embree::BuildQuality;
use crate::film::FilmSums;
use crate::render::{Budget, ColourMode, Settings};
use crate::sampling::{SamplerKind, UnknownSampler};
use crate::scene::Scene;
use crate::transport::DirectLight;
use crate::walk::{SettingError, StrategyKind, StrategyOptions};

/// A way to render, of which any number of renders can be made.
#[derive(Clone, Debug, PartialEq)]
pub struct EntrySettings {
    /// Who decides how long paths are followed.
    pub strategy: StrategyKind,
    /// The strategy's settings.
    pub options: StrategyOptions,
    /// How colours are carried.
    pub colour: ColourMode,
    /// Where the random numbers of paths come from.
    pub sampler: SamplerKind,
    /// Whether directions are guided by what was learned.
    pub guiding: bool,
    /// Whether pixels in which one path leaves much error get more of them.
    pub adaptive: bool,
    /// Whether what was learned is tried against doing without.
    pub trial: bool,
    /// How direct light is found.
    pub direct_light: DirectLight,
    /// Most segments of a path, camera ray included; `None` takes what the scene says.
    pub max_depth: Option<NonZeroU32>,
    /// Watertight intersection.
    pub robust: bool,
    /// Effort in building the acceleration structure.
    pub build_quality: BuildQuality,
    /// How pixels add up their samples.
    pub sums: FilmSums,
}

impl Default for EntrySettings {
    /// What `cohort render` does unless told otherwise.
    fn default() -> Self {
        let settings = Settings::default();
        Self {
            strategy: StrategyKind::Roulette,
            options: StrategyOptions::default(),
            colour: settings.colour,
            sampler: settings.sampler,
            guiding: settings.guiding,
            adaptive: settings.adaptive,
            trial: settings.trial,
            direct_light: settings.direct_light,
            max_depth: settings.max_depth,
            robust: settings.robust,
            build_quality: settings.build_quality,
            sums: settings.film_sums,
        }
    }
}

impl EntrySettings {
    /// The settings of a render of `scene`. The budget stands for how samples are divided into passes alone: passes
    /// that start small.
    ///
    /// # Errors
    /// Settings that the strategy does not have, and values out of their range.
    pub fn settings(&self, scene: &Scene, threads: NonZeroUsize) -> Result<Settings, SettingError> {
        let mut options = self.options;
        if self.strategy == StrategyKind::ThroughputRoulette {
            let of_scene = scene.integrator.roulette_depth;
            options.from_depth = options.from_depth.or(Some(of_scene));
        }
        Ok(Settings {
            strategy: self.strategy.build(&options)?,
            budget: Budget::Time(std::time::Duration::MAX),
            threads,
            seed: 0,
            colour: self.colour,
            sampler: self.sampler,
            guiding: self.guiding,
            adaptive: self.adaptive,
            trial: self.trial,
            direct_light: self.direct_light,
            max_depth: self.max_depth,
            robust: self.robust,
            build_quality: self.build_quality,
            film_sums: self.sums,
        })
    }
}

/// A strategy as it is written in a list: its name, and settings behind colons, such as
/// `particle-filter:population=tile:n-max=2` or `roulette:sampler=sobol`.
#[derive(Clone, Debug, PartialEq)]
pub struct StrategySpec {
    /// As written.
    pub name: String,
    /// Which strategy.
    pub strategy: StrategyKind,
    /// Its settings.
    pub options: StrategyOptions,
    /// The sampler that it is to have, if it is not the others'.
    pub sampler: Option<SamplerKind>,
    /// Whether its directions are to be guided, if that is not as with the others.
    pub guiding: Option<bool>,
    /// Whether pixels with much error are to get more paths, likewise.
    pub adaptive: Option<bool>,
    /// Whether what it learns is to be tried, likewise.
    pub trial: Option<bool>,
}

/// What is wrong with a written strategy.
#[derive(Debug, Error)]
pub enum SpecError {
    /// No such strategy or setting, or a value out of its range.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// No such sampler.
    #[error(transparent)]
    Sampler(#[from] UnknownSampler),
    /// A setting without a value.
    #[error(
        "`{0}`: a setting is written name=value, as in roulette:threshold=0.05:termination=0.3"
    )]
    NoValue(String),
    /// A value that is not a number.
    #[error("`{setting}={value}`: the value is not {expected}")]
    Value {
        /// The setting.
        setting: &'static str,
        /// What was given.
        value: String,
        /// What it has to be.
        expected: &'static str,
    },
    /// A setting that no strategy has.
    #[error(
        "no strategy has a setting `{0}`; there are threshold, termination, from-depth, rule, objective, n-max, population, counts, sampler, guiding, adaptive and trial"
    )]
    Unknown(String),
}

impl FromStr for StrategySpec {
    type Err = SpecError;

    fn from_str(text: &str) -> Result<Self, SpecError> {
        let mut parts = text.split(':');
        let strategy = parts.next().unwrap_or_default().parse::<StrategyKind>()?;
        let mut options = StrategyOptions::default();
        let mut sampler = None;
        let mut guiding = None;
        let mut adaptive = None;
        let mut trial = None;
        for part in parts {
            let (name, value) = part
                .split_once('=')
                .ok_or_else(|| SpecError::NoValue(part.to_owned()))?;
            match name {
                "threshold" => options.threshold = Some(number("threshold", value)?),
                "termination" => options.termination = Some(number("termination", value)?),
                "from-depth" => options.from_depth = Some(number("from-depth", value)?),
                "n-max" => options.n_max = Some(number("n-max", value)?),
                "rule" => options.rule = Some(value.parse()?),
                "objective" => options.objective = Some(value.parse()?),
                "population" => options.population = Some(value.parse()?),
                "sampler" => sampler = Some(value.parse()?),
                "guiding" => guiding = Some(on_or_off("guiding", value)?),
                "adaptive" => adaptive = Some(on_or_off("adaptive", value)?),
                "trial" => trial = Some(on_or_off("trial", value)?),
                "counts" => options.counts = Some(value.parse()?),
                _ => return Err(SpecError::Unknown(name.to_owned())),
            }
        }
        strategy.build(&options)?;
        Ok(Self {
            name: text.to_owned(),
            strategy,
            options,
            sampler,
            guiding,
            adaptive,
            trial,
        })
    }
}

fn on_or_off(setting: &'static str, value: &str) -> Result<bool, SpecError> {
    match value {
        "on" => Ok(true),
        "off" => Ok(false),
        _ => Err(SpecError::Value {
            setting,
            value: value.to_owned(),
            expected: "on or off",
        }),
    }
}

fn number<T: FromStr>(setting: &'static str, value: &str) -> Result<T, SpecError> {
    value.parse().map_err(|_| SpecError::Value {
        setting,
        value: value.to_owned(),
        expected: match setting {
            "from-depth" => "a whole number",
            _ => "a number",
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strategies_are_written_with_their_settings() {
        let spec: StrategySpec = "particle-filter:population=tile:n-max=2".parse().unwrap();
        assert_eq!(spec.strategy, StrategyKind::ParticleFilter);
        assert_eq!(spec.options.n_max, Some(2.0));
        let sobol: StrategySpec = "roulette:sampler=sobol".parse().unwrap();
        assert_eq!(sobol.sampler, Some(SamplerKind::Sobol));
        let guided: StrategySpec = "roulette:guiding=on".parse().unwrap();
        assert_eq!((guided.guiding, sobol.guiding), (Some(true), None));
        let adaptive: StrategySpec = "roulette:adaptive=on".parse().unwrap();
        assert_eq!((adaptive.adaptive, guided.adaptive), (Some(true), None));
        let tried: StrategySpec = "ears:trial=on".parse().unwrap();
        assert_eq!((tried.trial, guided.trial), (Some(true), None));
        let plain: StrategySpec = "roulette".parse().unwrap();
        assert_eq!(plain.options, StrategyOptions::default());
    }

    #[test]
    fn mistakes_are_refused() {
        for (text, said) in [
            ("rolette", "rolette"),
            ("roulette:threshold", "name=value"),
            ("roulette:threshold=x", "not a number"),
            ("throughput-roulette:from-depth=1.5", "not a whole number"),
            ("roulette:size=3", "no strategy has a setting `size`"),
            ("roulette:sampler=halton", "sobol and array-qmc"),
            ("roulette:guiding=yes", "not on or off"),
            ("roulette:n-max=3", "n-max"),
            ("roulette:termination=1.5", "termination"),
        ] {
            let message = text.parse::<StrategySpec>().unwrap_err().to_string();
            assert!(message.contains(said), "{text}: {message}");
        }
    }
}
