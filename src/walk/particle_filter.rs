//! # `particle-filter`
//!
//! Resamples whole populations (paper section 4.3, figure 5): the paths are the particles of a particle filter, a
//! reflection is its time step, and what the resampling equalises is the importance,
//!
//! ```text
//! nu_k = n_max W_k a_k
//! N    = sum of the nu_k of a population,   m' = floor(N), plus 1 with probability N - floor(N)
//! ```
//!
//! m' children are drawn, particle k having nu_k of them on average. (Figure 5 divides the importance of a child of j by the
//! step of the cumulative sum at k in one place and at j in another; it must be at j.) After each step all particles of
//! all populations have the same scalar importance W a / nu = 1 / n_max: weights do not drift apart, and each surviving
//! path is worth its ray.
//!
//! **Settings**
//! - `population`, whose particles are resampled together: `camera-path` (the offspring of one camera path, as the paper
//!   has it), `pixel` (default) or `tile`. W is relative to each particle's own camera path in any case.
//! - `n-max`, how many particles the method aims at per camera path, positive and at most 1024. Default: 10 for `camera-path`,
//!   where it splits the first vertex as go-with-the-winners does; 1 for `pixel` and `tile`, where there are many particles
//!   without splitting.
//! - `counts`, how the integers are drawn: `independent`, `multinomial`, `stratified`, `systematic` (default), `residual` or
//!   `residual-stratified`; see [`Rounding`].
//!
//! The preset `paper-particle-filter` is the paper's literal form: `camera-path`, 10, `multinomial`.
//!
//! **When it wins:** in large populations whose neighbours contribute alike, with `systematic` counts, whose noise cancels
//! between neighbours. `multinomial` counts add noise that independent roulette would not have, the more the larger the
//! population; they are here because the paper has them.

use super::{ExpectedCount, Population, Rounding, Scalar, Scope, SettingError, Strategy};

/// Resamples each population in proportion to importance; see the [module](self).
#[derive(Clone, Copy, Debug)]
pub struct ParticleFilter {
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

    /// A filter that aims at `n_max` particles per camera path in each `population` and draws integers by `counts`.
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
        vec![
            ("n-max", self.n_max.to_string()),
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

    fn scalar(&self) -> Scalar {
        Scalar::Mean
    }

    fn expected_counts(&self, population: &Population, nu: &mut [f32]) {
        for ((nu, w), a) in nu
            .iter_mut()
            .zip(population.importance)
            .zip(population.albedo)
        {
            *nu = self.n_max * w * a;
        }
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
