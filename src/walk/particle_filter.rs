//! # `particle-filter`
//!
//! Resamples whole populations (paper section 4.3, figure 5): the paths are the particles of a particle filter, a
//! reflection is its time step. All particles of a population round their expected counts jointly.
//!
//! **By what was learned** (`rule` `learned`, the default), the counts make variance times cost least:
//!
//! ```text
//! nu_k = W_k a_k / I sqrt((E[v^2] - s E[v]^2) / c) sqrt(image cost / image relative variance)
//! ```
//!
//! v is what a child brings back, c what it costs, I the brightness of the pixel, and s the part of what neighbours have in common that they hold in
//! balance by rounding jointly: 1/2 where the sampler sorts populations, else 0. A dead zone leaves particles alone from 2/3 to 3/2, and draws
//! other counts to 1 by the same factor. No count above 1 is more than Var\[v\] would make it, for copies of what does not vary are
//! worth nothing; nu is kept from 0.02 to 20, at mirrors and glass it is at most 1, and all particles together get at most four children for each camera path. Before anything is learned,
//! paths survive by half where their importance is below a tenth.
//!
//! **By importance** (`rule` `importance`), as the paper has it, the resampling equalises the importance:
//!
//! ```text
//! nu_k = n_max W_k a_k
//! N    = sum of the nu_k of a population,   m' = floor(N), plus 1 with probability N - floor(N)
//! ```
//!
//! m' children are drawn, particle k having nu_k of them on average. (Figure 5 divides the importance of a child of j by the
//! step of the cumulative sum at k in one place and at j in another; it must be at j.) After each step all particles of
//! all populations have the same scalar importance W a / nu = 1 / n_max.
//!
//! **Settings**
//! - `rule`: `learned` (default) or `importance` (default where `n-max` is given).
//! - `objective`, of the learned rule: `relative` (default), the error relative to each pixel's brightness, or `mse`, where I is 1 everywhere.
//! - `population`, whose particles are resampled together: `camera-path` (the offspring of one camera path, as the paper
//!   has it), `pixel` (default) or `tile`. W is relative to each particle's own camera path in any case.
//! - `n-max`, of the rule by importance: how many particles the method aims at per camera path, positive and at most 1024. Default: 10 for `camera-path`,
//!   where it splits the first vertex as go-with-the-winners does; 1 for `pixel` and `tile`, where there are many particles
//!   without splitting.
//! - `counts`, how the integers are drawn: `independent`, `multinomial`, `stratified`, `systematic` (default), `residual` or
//!   `residual-stratified`; see [`Rounding`].
//!
//! The preset `paper-particle-filter` is the paper's literal form: `importance`, `camera-path`, 10, `multinomial`.
//!
//! **When it wins:** by what was learned, where paths differ much in what they are worth, and with the sampler `array-qmc`, which sorts
//! populations so that neighbours contribute alike: then `systematic` counts cancel each other's noise. `multinomial` counts add noise that
//! independent roulette would not have, the more the larger the population; they are here because the paper has them.

use std::fmt::{self, Display};
use std::str::FromStr;

use serde::Serialize;

use super::learned::{EfficientCounts, before_lessons, bound};
use super::{ExpectedCount, Objective, Population, Rounding, Scope, SettingError, Strategy};

/// By what factor the range is wider in which particles are left alone.
const DEAD_ZONE: f32 = 1.5;

/// The part of the squared mean that is not at risk where populations are sorted: what neighbours have in common, they hold in balance.
const SHARED: f32 = 0.5;

/// By what a filter chooses the expected counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum CountRule {
    /// What was learned.
    #[default]
    Learned,
    /// Importance alone.
    Importance,
}

impl CountRule {
    /// Every rule.
    pub const ALL: [Self; 2] = [Self::Learned, Self::Importance];
}

impl Display for CountRule {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Learned => "learned",
            Self::Importance => "importance",
        })
    }
}

impl FromStr for CountRule {
    type Err = SettingError;

    fn from_str(text: &str) -> Result<Self, SettingError> {
        SettingError::choose("rule", text, &Self::ALL)
    }
}

/// Resamples each population; see the [module](self).
#[derive(Clone, Copy, Debug)]
pub struct ParticleFilter {
    /// That of the learned rule; `None` by importance.
    objective: Option<Objective>,
    /// By importance: how many particles there are to be.
    n_max: f32,
    population: Scope,
    counts: Rounding,
}

impl ParticleFilter {
    /// The strategy's name.
    pub const NAME: &str = "particle-filter";
    /// The population unless another is chosen.
    pub const DEFAULT_POPULATION: Scope = Scope::Pixel;
    /// The way of drawing counts unless another is chosen.
    pub const DEFAULT_COUNTS: Rounding = Rounding::Systematic;

    /// A filter by what was learned.
    ///
    /// # Errors
    /// If `population` is [`Scope::Particle`].
    pub fn learned(
        objective: Objective,
        population: Scope,
        counts: Rounding,
    ) -> Result<Self, SettingError> {
        Ok(Self {
            objective: Some(objective),
            ..Self::new(1.0, population, counts)?
        })
    }

    /// A filter by importance that aims at `n_max` particles per camera path in each `population` and draws integers by `counts`.
    ///
    /// # Errors
    /// If `n_max` is not positive or above 1024, or if `population` is [`Scope::Particle`].
    pub fn new(n_max: f32, population: Scope, counts: Rounding) -> Result<Self, SettingError> {
        check_n_max(Self::NAME, n_max)?;
        if population == Scope::Particle {
            return Err(SettingError::OutOfRange {
                strategy: Self::NAME,
                setting: "population",
                value: population.to_string(),
                range: "camera-path, pixel or tile",
            });
        }
        Ok(Self {
            objective: None,
            n_max,
            population,
            counts,
        })
    }

    /// n_max for a `population`, unless another is chosen: the paper's where it has to split a single path, else 1.
    pub fn default_n_max(population: Scope) -> f32 {
        if population == Scope::CameraPath {
            10.0
        } else {
            1.0
        }
    }

    /// The literal form of the paper.
    pub fn paper() -> Self {
        let population = Scope::CameraPath;
        Self {
            objective: None,
            n_max: Self::default_n_max(population),
            population,
            counts: Rounding::Multinomial,
        }
    }
}

impl Strategy for ParticleFilter {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn settings(&self) -> Vec<(&'static str, String)> {
        let rule = match self.objective {
            Some(objective) => [
                ("rule", CountRule::Learned.to_string()),
                ("objective", objective.to_string()),
            ],
            None => [
                ("rule", CountRule::Importance.to_string()),
                ("n-max", self.n_max.to_string()),
            ],
        };
        let [rule, of_rule] = rule;
        vec![
            rule,
            of_rule,
            ("population", self.population.to_string()),
            ("counts", self.counts.to_string()),
        ]
    }

    fn scope(&self) -> Scope {
        self.population
    }

    fn rounding(&self) -> Rounding {
        self.counts
    }

    fn learns(&self) -> bool {
        self.objective.is_some()
    }

    fn objective(&self) -> Objective {
        self.objective.unwrap_or_default()
    }

    fn expected_counts(&self, population: &Population, nu: &mut [f32]) {
        let Some(objective) = self.objective else {
            let numbers = population.importance.iter().zip(population.albedo);
            for (nu, (w, a)) in nu.iter_mut().zip(numbers) {
                *nu = self.n_max * w * a;
            }
            return;
        };
        for (index, nu) in nu.iter_mut().enumerate() {
            *nu = before_lessons(population, index);
        }
        if let Some(learned) = &population.learned {
            let are_sorted = population.points.is_some_and(|points| points.are_sorted());
            let rule = EfficientCounts {
                objective,
                dead_zone: DEAD_ZONE,
                shared: if are_sorted { SHARED } else { 0.0 },
            };
            learned.efficient_counts(rule, population.shininess, nu);
        }
        bound(population, nu);
    }
}

/// Refuses an `n_max` that asks for nothing, or for more than a particle is given.
pub(super) fn check_n_max(strategy: &'static str, n_max: f32) -> Result<(), SettingError> {
    let most = f64::from(ExpectedCount::LARGEST);
    if n_max > 0.0 && f64::from(n_max) <= most {
        return Ok(());
    }
    Err(SettingError::OutOfRange {
        strategy,
        setting: "n-max",
        value: n_max.to_string(),
        range: "positive and at most 1024",
    })
}
