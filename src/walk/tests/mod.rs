//! Proofs by trial: every strategy and every rounding against its formula.

mod furnace;
mod invariants;
mod learned;
mod means;
mod paper;
mod rules;
mod variance;

use super::{
    FixedDepth, GoWithTheWinners, Offspring, ParticleFilter, Population, Roulette, Rounding, Scope,
    Strategy, ThroughputRoulette, WalkReport,
};
use crate::sampling::{RandomStream, StreamKey};

fn random(seed: u64) -> RandomStream {
    RandomStream::new(StreamKey {
        seed,
        tile: 0,
        pass: 0,
    })
}

/// The columns of a [`Population`].
#[derive(Clone, Debug, Default)]
struct Particles {
    importance: Vec<f32>,
    albedo: Vec<f32>,
    shininess: Vec<f32>,
    group: Vec<u32>,
}

impl Particles {
    /// Diffuse white particles of one group.
    fn white(importance: &[f32]) -> Self {
        let mut particles = Self::default();
        for &w in importance {
            particles.push(w, 1.0, 0.0, 0);
        }
        particles
    }

    fn push(&mut self, importance: f32, albedo: f32, shininess: f32, group: u32) {
        self.importance.push(importance);
        self.albedo.push(albedo);
        self.shininess.push(shininess);
        self.group.push(group);
    }

    fn population(&self, depth: u32) -> Population<'_> {
        Population {
            importance: &self.importance,
            albedo: &self.albedo,
            shininess: &self.shininess,
            group: &self.group,
            depth,
            paths: self.importance.len() as u32,
            points: None,
            learned: None,
        }
    }
}

/// The filter on pixels with n_max 1, so that nu = W a.
fn filter(counts: Rounding) -> ParticleFilter {
    ParticleFilter::new(1.0, Scope::Pixel, counts).unwrap()
}

/// Every strategy, the particle filter with every rounding.
fn every_strategy() -> Vec<Box<dyn Strategy>> {
    let mut strategies: Vec<Box<dyn Strategy>> = vec![
        Box::new(FixedDepth),
        Box::new(Roulette::new(0.1, 0.5).unwrap()),
        Box::new(Roulette::new(0.7, 0.9).unwrap()),
        Box::new(ThroughputRoulette::new(1)),
        Box::new(GoWithTheWinners::new(10.0).unwrap()),
        Box::new(ParticleFilter::paper()),
    ];
    for counts in Rounding::ALL {
        strategies.push(Box::new(filter(counts)));
    }
    strategies
}

/// n of every particle.
fn counts(offspring: &Offspring) -> Vec<u64> {
    let mut counts = vec![0; offspring.expected_counts().len()];
    for child in offspring.children() {
        counts[child.parent as usize] += 1;
    }
    counts
}

/// nu of every particle.
fn means(offspring: &Offspring) -> Vec<f64> {
    offspring
        .expected_counts()
        .iter()
        .map(|&nu| nu.into())
        .collect()
}

/// Mean and variance of a series of observations.
#[derive(Clone, Copy, Debug, Default)]
struct Moments {
    number: f64,
    sum: f64,
    sum_of_squares: f64,
}

impl Moments {
    fn add(&mut self, x: f64) {
        self.number += 1.0;
        self.sum += x;
        self.sum_of_squares += x * x;
    }

    fn mean(&self) -> f64 {
        self.sum / self.number
    }

    fn variance(&self) -> f64 {
        (self.sum_of_squares - self.sum * self.mean()) / (self.number - 1.0)
    }

    fn standard_error(&self) -> f64 {
        (self.variance().max(0.0) / self.number).sqrt()
    }
}
