//! # `ears`
//!
//! Efficiency-aware Russian roulette and splitting (Rath, Grittmann, Herholz, Weier and Slusallek 2022): every path decides alone, by what was
//! learned of the light behind it,
//!
//! ```text
//! nu_r = t sqrt(E[v^2] / c),   nu_s = t sqrt(Var[v] / c),   t = W a / I sqrt(image cost / image relative variance)
//! nu   = nu_r   where nu_r < 1
//!        nu_s   where nu_s > 1
//!        1      otherwise
//! ```
//!
//! v is what a child brings back, c what it costs, I the brightness of the pixel. Ending a path is decided by the second moment,
//! for it risks everything; splitting it by the variance, for copies share their mean: between them lies a range in which a path goes on alone. The ten
//! pixels that vary most do not count for the image's cost and variance, as in the authors' implementation.
//!
//! At mirrors and glass, whose light depends on direction more than on place, no path is split, and none given up more readily than without lessons.
//! All particles together get at most four children for each camera path. Before anything is learned, paths survive by half where their importance is below a tenth.
//!
//! **Settings**
//! - `objective`: `relative` (default), the error relative to each pixel's brightness, as published, or `mse`, where I is 1 everywhere.
//!
//! **When it wins:** where paths differ much in what they are worth, as under light that arrives indirectly.

use super::learned::{EfficientCounts, before_lessons, bound};
use super::{Objective, Population, Strategy};

/// Makes variance times cost least for each path; see the [module](self).
#[derive(Clone, Copy, Debug, Default)]
pub struct Ears {
    objective: Objective,
}

impl Ears {
    /// The strategy's name.
    pub const NAME: &str = "ears";

    /// For the least error of this kind.
    pub fn new(objective: Objective) -> Self {
        Self { objective }
    }
}

impl Strategy for Ears {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn settings(&self) -> Vec<(&'static str, String)> {
        vec![("objective", self.objective.to_string())]
    }

    fn learns(&self) -> bool {
        true
    }

    fn objective(&self) -> Objective {
        self.objective
    }

    fn expected_counts(&self, population: &Population, nu: &mut [f32]) {
        for (index, nu) in nu.iter_mut().enumerate() {
            *nu = before_lessons(population, index);
        }
        if let Some(learned) = &population.learned {
            let rule = EfficientCounts {
                objective: self.objective,
                dead_zone: 1.0,
                shared: 0.0,
            };
            learned.efficient_counts(rule, population.shininess, nu);
        }
        bound(population, nu);
    }
}
