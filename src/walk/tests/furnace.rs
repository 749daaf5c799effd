//! A closed room in one dimension: every vertex emits 1 and reflects rho on average, so that every path must
//! collect 1 + rho + rho^2 + ... = 1 / (1 - rho), whatever the strategy.

use super::*;

/// The albedos: one of rho (1 +- d), with d so small that even weights never resampled keep a finite variance.
struct Room {
    rho: f64,
    greatest_depth: u32,
}

impl Room {
    fn endless(rho: f64) -> Self {
        Self {
            rho,
            greatest_depth: u32::MAX,
        }
    }

    fn albedo(&self, random: &mut RandomStream) -> f32 {
        let spread = ((1.0 - self.rho) / 2.0).sqrt();
        let sign = if random.bits() & 1 == 0 { 1.0 } else { -1.0 };
        (self.rho * (1.0 + sign * spread)) as f32
    }

    /// What a path collects on average.
    fn radiance(&self) -> f64 {
        (1.0 - self.rho.powf(f64::from(self.greatest_depth) + 1.0)) / (1.0 - self.rho)
    }

    /// What the paths of each of `groups` collect on average, `paths` to a group.
    fn walk(
        &self,
        strategy: &dyn Strategy,
        groups: u32,
        paths: u32,
        random: &mut RandomStream,
    ) -> Moments {
        let mut collected = vec![0.0; groups as usize];
        let mut particles = Particles::default();
        for group in 0..groups {
            for _ in 0..paths {
                particles.push(1.0, 0.0, 0.0, group);
            }
        }
        let mut offspring = Offspring::new();
        for depth in 0..=self.greatest_depth {
            if particles.importance.is_empty() {
                break;
            }
            for (&w, &group) in particles.importance.iter().zip(&particles.group) {
                collected[group as usize] += f64::from(w) / f64::from(paths);
            }
            particles
                .albedo
                .iter_mut()
                .for_each(|a| *a = self.albedo(random));
            strategy.resample(&particles.population(depth), random, &mut offspring);
            let mut next = Particles::default();
            for child in offspring.children() {
                let parent = child.parent as usize;
                let throughput =
                    particles.importance[parent] * child.weight * particles.albedo[parent];
                next.push(throughput, 0.0, 0.0, particles.group[parent]);
            }
            particles = next;
        }
        let mut moments = Moments::default();
        collected
            .into_iter()
            .for_each(|radiance| moments.add(radiance));
        moments
    }

    fn assert_radiance(&self, strategy: &dyn Strategy, groups: u32, paths: u32) {
        let seen = self.walk(strategy, groups, paths, &mut random(9));
        let error = seen.mean() - self.radiance();
        // The second bound lets no strategy hide behind its own noise.
        assert!(
            error.abs() < 4.0 * seen.standard_error()
                && seen.standard_error() < 0.1 * self.radiance(),
            "{strategy:?} at albedo {}: {} +- {}, expected {}",
            self.rho,
            seen.mean(),
            seen.standard_error(),
            self.radiance()
        );
    }
}

const ALBEDOS: [f64; 4] = [0.5, 0.9, 0.99, 0.999];

#[test]
fn roulette_and_splitting() {
    let strategies: [&dyn Strategy; 2] = [
        &Roulette::new(0.1, 0.5).unwrap(),
        &GoWithTheWinners::new(10.0).unwrap(),
    ];
    for strategy in strategies {
        for rho in ALBEDOS {
            Room::endless(rho).assert_radiance(strategy, 1000, 1);
        }
    }
}

#[test]
fn every_particle_filter() {
    for counts in Rounding::ALL {
        for rho in ALBEDOS {
            Room::endless(rho).assert_radiance(&filter(counts), 200, 8);
            let splitting = ParticleFilter::new(10.0, Scope::CameraPath, counts).unwrap();
            Room::endless(rho).assert_radiance(&splitting, 200, 1);
        }
    }
}

/// Without a greatest depth its variance is infinite at the higher albedos, and no mean could be tested.
#[test]
fn throughput_roulette() {
    for rho in ALBEDOS {
        let room = Room {
            rho,
            greatest_depth: 40,
        };
        room.assert_radiance(&ThroughputRoulette::new(5), 4000, 1);
    }
}

#[test]
fn fixed_depth() {
    for rho in ALBEDOS {
        let room = Room {
            rho,
            greatest_depth: 100,
        };
        room.assert_radiance(&FixedDepth, 1000, 1);
    }
}
