//! Populations like those of a render that is a few bounces deep.

use cohort::walk::Population;
use rand_mt::Mt;

use super::cases::Case;

/// Albedos of the Cornell box: white more often than green and red.
const ALBEDOS: [f32; 5] = [0.74, 0.74, 0.74, 0.25, 0.15];

/// So deep that every strategy decides.
const DEPTH: u32 = 8;

/// A population's arrays.
pub struct Particles {
    importance: Vec<f32>,
    albedo: Vec<f32>,
    shininess: Vec<f32>,
    group: Vec<u32>,
}

impl Particles {
    /// `count` particles as the strategy of `case` meets them: diffuse, in groups of its scope, with importances spread
    /// evenly about the 1 / `n_max` that it leaves to each.
    pub fn new(count: usize, case: &Case) -> Self {
        let mut random = Mt::new(1);
        let mut uniform = || (f64::from(random.next_u32()) + 0.5) / f64::from(u32::MAX);
        let group_size = case.group_size(count);
        Self {
            importance: (0..count)
                .map(|_| 2.0 * uniform() as f32 / case.n_max)
                .collect(),
            albedo: (0..count)
                .map(|_| ALBEDOS[(uniform() * ALBEDOS.len() as f64) as usize % ALBEDOS.len()])
                .collect(),
            shininess: vec![0.0; count],
            group: (0..count)
                .map(|index| (index / group_size) as u32)
                .collect(),
        }
    }

    /// What the strategy is shown.
    pub fn population(&self) -> Population<'_> {
        Population {
            importance: &self.importance,
            albedo: &self.albedo,
            shininess: &self.shininess,
            group: &self.group,
            paths: self.importance.len() as u32,
            depth: DEPTH,
            points: None,
            learned: None,
        }
    }
}
