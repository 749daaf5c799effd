//! # `throughput-roulette`
//!
//! Russian roulette as in Mitsuba 3 and pbrt: after a few free reflections, a particle survives with the probability
//! that its throughput would have,
//!
//! ```text
//! nu = 1                 for the first from_depth - 1 reflections
//! nu = min(W a, 0.95)    afterwards
//! ```
//!
//! W and a are the maxima over the wavelengths. Each particle decides alone. `from_depth` is Mitsuba's `rr_depth`
//! (`src/integrators/path.cpp`): there a path's depth is counted up once its direction has been sampled, and the roulette is
//! played when the new depth is at least `rr_depth`. A particle that has been scattered d times is therefore at stake when
//! d + 1 >= `from_depth`: with 5, the first four reflections are free, and the fifth is the first that can fail.
//! Two differences remain: Mitsuba asks after sampling the direction and so uses the sampled weight f cos / pdf where the
//! albedo stands here (on a diffuse surface they are equal), and it takes the squared index of refraction that a path in
//! glass has gathered out of W.
//!
//! **Settings:** `from-depth` (default 5; 0 and 1 both mean that even the first reflection can fail).
//!
//! **When it wins:** as the customary baseline. It keeps throughputs near 1 in rooms of middling brightness. At albedos
//! above sqrt(0.95) = 0.975 in a closed room, a path ends more often than it loses energy, the survivors' weights grow
//! without bound, and the variance is infinite unless the render has a greatest depth.

use super::{Population, Scalar, Strategy};

/// No survival is more probable than this, so that every path ends.
const MOST_PROBABLE: f32 = 0.95;

/// Lets particles survive in proportion to their throughput; see the [module](self).
#[derive(Clone, Copy, Debug)]
pub struct ThroughputRoulette {
    from_depth: u32,
}

impl ThroughputRoulette {
    /// The strategy's name.
    pub const NAME: &str = "throughput-roulette";
    /// Mitsuba's `rr_depth`.
    pub const DEFAULT_FROM_DEPTH: u32 = 5;

    /// Roulette from the reflection number `from_depth` on, counted from 1.
    pub fn new(from_depth: u32) -> Self {
        Self { from_depth }
    }
}

impl Strategy for ThroughputRoulette {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn settings(&self) -> Vec<(&'static str, String)> {
        vec![("from-depth", self.from_depth.to_string())]
    }

    fn scalar(&self) -> Scalar {
        Scalar::Maximum
    }

    fn expected_counts(&self, population: &Population, nu: &mut [f32]) {
        if population.depth.saturating_add(1) < self.from_depth {
            return nu.fill(1.0);
        }
        for ((nu, w), a) in nu
            .iter_mut()
            .zip(population.importance)
            .zip(population.albedo)
        {
            *nu = (w * a).min(MOST_PROBABLE);
        }
    }
}
