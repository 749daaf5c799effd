//! # `go-with-the-winners`
//!
//! Splits important particles and ends unimportant ones (paper section 4.2, figure 3; Szirmay-Kalos, Antal and Sbert 2005):
//!
//! ```text
//! nu = W a sqrt(1 + (n_max^2 - 1) / (s + 1)^2)
//! ```
//!
//! On a diffuse surface (s = 0) that is n_max W a, for a mirror (s infinite) W a: where a surface scatters light
//! widely, more directions are worth trying. A camera path starts with W = 1 and so has about n_max a children at its first
//! diffuse vertex; each of them has W = 1 / n_max, and from there on survives with about the probability of the albedo.
//! Each particle decides alone.
//!
//! **Settings:** `n-max`, the most children of one particle with W = 1, positive and at most 1024 (default 10, as in the
//! paper; 1 never splits).
//!
//! **When it wins:** when the first vertex is dear and the light behind it noisy: its children share one camera ray and one
//! evaluation of the surface. It loses where most of the noise is in the camera ray itself (edges, depth of field), and
//! it cannot see that another particle's children would have been better value.

use super::particle_filter::check_n_max;
use super::{Population, SettingError, Strategy};

/// Splits and ends particles one by one; see the [module](self).
#[derive(Clone, Copy, Debug)]
pub struct GoWithTheWinners {
    n_max: f32,
}

impl GoWithTheWinners {
    /// The strategy's name.
    pub const NAME: &str = "go-with-the-winners";
    /// The paper's n_max.
    pub const DEFAULT_N_MAX: f32 = 10.0;

    /// About `n_max` children for a particle of importance 1 on a white diffuse surface.
    ///
    /// # Errors
    /// If `n_max` is not positive, or above 1024.
    pub fn new(n_max: f32) -> Result<Self, SettingError> {
        check_n_max(Self::NAME, n_max)?;
        Ok(Self { n_max })
    }
}

impl Strategy for GoWithTheWinners {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn settings(&self) -> Vec<(&'static str, String)> {
        vec![("n-max", self.n_max.to_string())]
    }

    fn expected_counts(&self, population: &Population, nu: &mut [f32]) {
        let extra = self.n_max * self.n_max - 1.0;
        for (nu, particle) in nu.iter_mut().zip(population.particles()) {
            let spread = 1.0 / (particle.shininess + 1.0);
            let splitting = (1.0 + extra * spread * spread).sqrt();
            *nu = particle.importance * particle.albedo * splitting;
        }
    }
}
