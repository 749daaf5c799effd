//! # `adjoint-roulette`
//!
//! Adjoint-driven Russian roulette and splitting (Vorba and Křivánek 2016): every path decides alone, so that what it is expected to contribute to
//! its pixel stays within a window,
//!
//! ```text
//! e  = W a E[v] / I,    low = 2 / (1 + s),    high = s low,    s = 5
//! nu = e / low      where e < low
//!      e / high     where e > high
//!      1            otherwise
//! ```
//!
//! v is what a child brings back, as learned, and I the brightness of the pixel.
//!
//! At mirrors and glass, whose light depends on direction more than on place, no path is split, and none given up more readily than without lessons.
//! Before anything is learned, paths survive by half where their importance is below a tenth.
//!
//! **Settings:** none.
//!
//! **When it wins:** as `ears`; it looks at what paths are expected to bring alone, not at how much that varies, nor at what it costs.

use super::learned::{BOUNDS, before_lessons, bound, of_discrete_directions};
use super::{Population, Strategy};

/// The ratio of the window's ends.
const WINDOW: f32 = 5.0;

/// Keeps what a path is expected to contribute within a window; see the [module](self).
#[derive(Clone, Copy, Debug, Default)]
pub struct AdjointRoulette;

impl AdjointRoulette {
    /// The strategy's name.
    pub const NAME: &str = "adjoint-roulette";
}

impl Strategy for AdjointRoulette {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn settings(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    fn learns(&self) -> bool {
        true
    }

    fn expected_counts(&self, population: &Population, nu: &mut [f32]) {
        let [least, most] = BOUNDS;
        let low = 2.0 / (1.0 + WINDOW);
        let high = WINDOW * low;
        for (index, nu) in nu.iter_mut().enumerate() {
            let Some(learned) = population.known(index) else {
                *nu = before_lessons(population, index);
                continue;
            };
            let expected =
                learned.reflected[index] * learned.mean[index] / learned.brightness[index];
            let count = if expected < low {
                expected / low
            } else {
                (expected / high).max(1.0)
            };
            let count = count.clamp(least, most);
            *nu = if population.shininess[index] == f32::INFINITY {
                of_discrete_directions(count, before_lessons(population, index))
            } else {
                count
            };
        }
        bound(population, nu);
    }
}
