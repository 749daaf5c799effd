//! The settings that trade accuracy for time, and the values of each that a study compares.

use std::fmt::{self, Display};
use std::num::NonZeroU32;
use std::str::FromStr;

use super::EntrySettings;
use super::plan::{How, Planned, Variation};
use crate::embree::BuildQuality;
use crate::film::FilmSums;
use crate::render::{ColourMode, WavelengthCount};
use crate::sampling::SamplerKind;
use crate::transport::DirectLight;
use crate::walk::{ParticleFilter, Roulette, Scope, StrategyKind, StrategyOptions};

/// The baseline's name.
pub const BASELINE: &str = "default";

/// A setting whose cost and use can be measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Watertight intersection.
    Robust,
    /// Effort in building the acceleration structure.
    BuildQuality,
    /// Wavelengths of a path, or three channels.
    Wavelengths,
    /// Precision in which a pixel adds up its samples.
    Sums,
    /// Most segments of a path.
    MaxDepth,
    /// Next-event estimation.
    Direct,
    /// Importance below which roulette may end a path.
    Threshold,
    /// Probability with which it does.
    Termination,
    /// Most children of a vertex in go-with-the-winners.
    NMax,
    /// Which paths the particle filter resamples together.
    Population,
    /// Where the random numbers of paths come from.
    Sampler,
}

/// A name that is no axis.
#[derive(Debug, thiserror::Error)]
#[error("no setting `{name}` can be studied; there are {}", names())]
pub struct UnknownAxis {
    /// The name.
    name: String,
}

fn names() -> String {
    Axis::ALL.map(Axis::name).join(", ")
}

impl Axis {
    /// Every axis.
    pub const ALL: [Self; 11] = [
        Self::Robust,
        Self::BuildQuality,
        Self::Wavelengths,
        Self::Sums,
        Self::MaxDepth,
        Self::Direct,
        Self::Threshold,
        Self::Termination,
        Self::NMax,
        Self::Population,
        Self::Sampler,
    ];

    /// The name on the command line: that of the option of `cohort render`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Robust => "robust",
            Self::BuildQuality => "build-quality",
            Self::Wavelengths => "wavelengths",
            Self::Sums => "sums",
            Self::MaxDepth => "max-depth",
            Self::Direct => "direct",
            Self::Threshold => "threshold",
            Self::Termination => "termination",
            Self::NMax => "n-max",
            Self::Population => "population",
            Self::Sampler => "sampler",
        }
    }

    /// What `base` becomes with each value of this setting that is worth a look. Values that `base` has already are left
    /// out: they are the baseline.
    pub fn variants(self, base: &EntrySettings) -> Vec<Planned> {
        let all: Vec<(String, EntrySettings)> = match self {
            Self::Robust => [false, true]
                .map(|robust| {
                    (
                        on_off(robust),
                        EntrySettings {
                            robust,
                            ..base.clone()
                        },
                    )
                })
                .into(),
            Self::BuildQuality => [
                ("low", BuildQuality::Low),
                ("medium", BuildQuality::Medium),
                ("high", BuildQuality::High),
            ]
            .map(|(name, build_quality)| {
                (
                    name.into(),
                    EntrySettings {
                        build_quality,
                        ..base.clone()
                    },
                )
            })
            .into(),
            Self::Wavelengths => [
                ("1", ColourMode::Spectral(WavelengthCount::One)),
                ("4", ColourMode::Spectral(WavelengthCount::Four)),
                ("8", ColourMode::Spectral(WavelengthCount::Eight)),
                ("rgb", ColourMode::Rgb),
            ]
            .map(|(name, colour)| {
                (
                    name.into(),
                    EntrySettings {
                        colour,
                        ..base.clone()
                    },
                )
            })
            .into(),
            Self::Sums => [
                ("single", FilmSums::Single),
                ("double", FilmSums::Double),
                ("compensated", FilmSums::Compensated),
            ]
            .map(|(name, sums)| {
                (
                    name.into(),
                    EntrySettings {
                        sums,
                        ..base.clone()
                    },
                )
            })
            .into(),
            Self::MaxDepth => [2, 3, 5, 9, 17]
                .map(|depth| {
                    let max_depth = NonZeroU32::new(depth);
                    (
                        depth.to_string(),
                        EntrySettings {
                            max_depth,
                            ..base.clone()
                        },
                    )
                })
                .into(),
            Self::Direct => [
                ("next-event", DirectLight::NextEvent),
                ("off", DirectLight::Off),
            ]
            .map(|(name, direct_light)| {
                (
                    name.into(),
                    EntrySettings {
                        direct_light,
                        ..base.clone()
                    },
                )
            })
            .into(),
            Self::Threshold => [0.02, Roulette::DEFAULT_THRESHOLD, 0.3, 1.0]
                .map(|value| {
                    of_strategy(base, StrategyKind::Roulette, value, |options, value| {
                        options.threshold = Some(value);
                    })
                })
                .into(),
            Self::Termination => [0.25, Roulette::DEFAULT_TERMINATION, 0.75]
                .map(|value| {
                    of_strategy(base, StrategyKind::Roulette, value, |options, value| {
                        options.termination = Some(value);
                    })
                })
                .into(),
            Self::NMax => [2.0, 4.0, 10.0]
                .map(|value| {
                    of_strategy(
                        base,
                        StrategyKind::GoWithTheWinners,
                        value,
                        |options, value| {
                            options.n_max = Some(value);
                        },
                    )
                })
                .into(),
            Self::Population => [Scope::CameraPath, Scope::Pixel, Scope::Tile]
                .map(|value| {
                    of_strategy(
                        base,
                        StrategyKind::ParticleFilter,
                        value,
                        |options, value| {
                            options.population = Some(value);
                            // The same number of paths whatever the population.
                            options.n_max = Some(ParticleFilter::default_n_max(Scope::Pixel));
                        },
                    )
                })
                .into(),
            Self::Sampler => SamplerKind::ALL
                .map(|sampler| {
                    (
                        sampler.to_string(),
                        EntrySettings {
                            sampler,
                            ..base.clone()
                        },
                    )
                })
                .into(),
        };
        let defaults = EntrySettings::default();
        all.into_iter()
            .filter(|(_, entry)| !same_render(entry, base))
            .map(|(value, entry)| Planned {
                name: format!("{self}={value}"),
                variation: Some(Variation {
                    axis: self.name(),
                    value,
                    is_default: same_render(&entry, &defaults),
                }),
                how: How::Ours(entry),
            })
            .collect()
    }
}

fn on_off(is_on: bool) -> String {
    if is_on { "on" } else { "off" }.to_owned()
}

/// `base` by `strategy` with one setting.
fn of_strategy<T: Display + Copy>(
    base: &EntrySettings,
    strategy: StrategyKind,
    value: T,
    set: impl Fn(&mut StrategyOptions, T),
) -> (String, EntrySettings) {
    // The other settings of the strategy stay what they are, if it is the base's.
    let mut options = if base.strategy == strategy {
        base.options
    } else {
        StrategyOptions::default()
    };
    set(&mut options, value);
    let entry = EntrySettings {
        strategy,
        options,
        ..base.clone()
    };
    (value.to_string(), entry)
}

/// Whether two are the same but for defaults that one of them names.
fn same_render(a: &EntrySettings, b: &EntrySettings) -> bool {
    let built = |entry: &EntrySettings| match entry.strategy.build(&entry.options) {
        Ok(strategy) => format!("{} {:?}", strategy.name(), strategy.settings()),
        Err(error) => error.to_string(),
    };
    let rest = |entry: &EntrySettings| EntrySettings {
        options: StrategyOptions::default(),
        ..entry.clone()
    };
    built(a) == built(b) && rest(a) == rest(b)
}

impl Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Axis {
    type Err = UnknownAxis;

    fn from_str(text: &str) -> Result<Self, UnknownAxis> {
        let mut all = Self::ALL.into_iter();
        all.find(|axis| axis.name() == text)
            .ok_or_else(|| UnknownAxis {
                name: text.to_owned(),
            })
    }
}

/// The baseline and every value of every axis, each varied alone.
pub fn competitors(base: &EntrySettings, axes: &[Axis]) -> Vec<Planned> {
    let baseline = Planned {
        name: BASELINE.to_owned(),
        how: How::Ours(base.clone()),
        variation: None,
    };
    let variants = axes.iter().flat_map(|axis| axis.variants(base));
    std::iter::once(baseline).chain(variants).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_is_a_render_of_its_own() {
        let base = EntrySettings::default();
        let all = competitors(&base, &Axis::ALL);
        for (index, one) in all.iter().enumerate() {
            for other in &all[..index] {
                let (How::Ours(a), How::Ours(b)) = (&one.how, &other.how) else {
                    panic!("all are ours");
                };
                assert!(!same_render(a, b), "{} and {}", one.name, other.name);
            }
        }
        let names: Vec<&str> = all.iter().map(|planned| planned.name.as_str()).collect();
        assert_eq!(names[0], BASELINE);
        assert!(names.contains(&"wavelengths=rgb") && !names.contains(&"wavelengths=4"));
        assert!(names.contains(&"robust=on") && !names.contains(&"threshold=0.1"));
    }

    #[test]
    fn axes_have_the_names_of_options() {
        for axis in Axis::ALL {
            assert_eq!(axis.name().parse::<Axis>().unwrap(), axis);
        }
        let message = "sampler2".parse::<Axis>().unwrap_err().to_string();
        assert!(message.contains("wavelengths, sums"), "{message}");
    }
}
