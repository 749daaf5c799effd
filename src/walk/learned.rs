//! What a render has learned of its particles.

use multiversion::multiversion;

use super::{Objective, Population, Roulette};

/// The least and the largest number of children.
pub(super) const BOUNDS: [f32; 2] = [0.02, 20.0];

/// The most children of a generation for each camera path, on average.
const MOST_PER_PATH: f64 = 4.0;

/// What was learned before about the particles of a [`Population`]: one entry per particle in every slice.
///
/// The *value* of going on at a particle is what one child of it would bring back if neither the surface's albedo nor the particle's
/// throughput took anything away. All of it comes from paths traced before: to a strategy these are numbers fixed in advance.
#[derive(Clone, Copy, Debug)]
pub struct Learned<'a> {
    /// The mean of the value, in radiance.
    pub mean: &'a [f32],
    /// The mean of its square; 0 where nothing is known.
    pub square: &'a [f32],
    /// What a child costs with all its descendants, where a bounce costs 1.
    pub cost: &'a [f32],
    /// Throughput times albedo, as a mean over wavelengths: what multiplies the value.
    pub reflected: &'a [f32],
    /// The mean radiance of the particle's pixel; 0 where nothing is known.
    pub brightness: &'a [f32],
    /// The square root of what a camera path costs over its relative variance, each as a mean over the image.
    pub relative_factor: f32,
    /// The same with the variance itself.
    pub absolute_factor: f32,
}

impl Learned<'_> {
    /// Whether every slice has `count` entries.
    pub(super) fn is_complete(&self, count: usize) -> bool {
        let columns = [
            self.mean,
            self.square,
            self.cost,
            self.reflected,
            self.brightness,
        ];
        columns.iter().all(|column| column.len() == count)
    }

    /// Writes the efficient numbers of children into `nu`, where something is known of a particle: of all counts they make variance times cost least,
    ///
    /// ```text
    /// nu_r = t sqrt((E[v^2] - s E[v]^2) / c),   nu_s = t sqrt(Var[v] / c),   t = W a / I sqrt(image cost / image variance)
    /// ```
    ///
    /// (Rath et al. 2022, "EARS: Efficiency-Aware Russian Roulette and Splitting", section 4, where s = 0). Ending a path is decided by nu_r, for it risks
    /// everything, but for what neighbours share where they round jointly; splitting it by nu_s, for copies share their mean. Between them lies a range in
    /// which a path goes on alone. It reaches from nu_r = 1 / z to nu_r = z at least, and counts beyond are drawn to 1 by that factor z.
    ///
    /// Mirrors and glass, whose `shininess` is infinite, are [left alone](of_discrete_directions): `nu` says what they would get without lessons.
    pub(super) fn efficient_counts(
        &self,
        rule: EfficientCounts,
        shininess: &[f32],
        nu: &mut [f32],
    ) {
        efficient_counts(self, rule, shininess, nu);
    }
}

/// What [`Learned::efficient_counts`] is to make of what was learned.
#[derive(Clone, Copy, Debug)]
pub(super) struct EfficientCounts {
    /// Which error they make small.
    pub objective: Objective,
    /// z, at least 1.
    pub dead_zone: f32,
    /// s, from 0 to 1: the part of the squared mean that is not at risk where a path ends.
    pub shared: f32,
}

#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
fn efficient_counts(learned: &Learned, rule: EfficientCounts, shininess: &[f32], nu: &mut [f32]) {
    let [least, most] = BOUNDS;
    let EfficientCounts {
        objective,
        dead_zone,
        shared,
    } = rule;
    let moments = learned.mean.iter().zip(learned.square).zip(learned.cost);
    let pixels = learned.reflected.iter().zip(learned.brightness);
    let counts = nu.iter_mut().zip(shininess);
    for ((nu, &shininess), (((&mean, &square), &cost), (&reflected, &brightness))) in
        counts.zip(moments.zip(pixels))
    {
        let t = reflected
            * match objective {
                Objective::Relative => learned.relative_factor / brightness,
                Objective::Mse => learned.absolute_factor,
            };
        let count = |spread: f32| t * (spread / cost).sqrt();
        let roulette = count((square - shared * mean * mean).max(0.0));
        let splitting = count((square - mean * mean).max(0.0));
        let drawn_up = roulette * dead_zone;
        let drawn_down = splitting.min(roulette / dead_zone);
        let efficient = if drawn_up < 1.0 {
            drawn_up.max(least)
        } else {
            drawn_down.clamp(1.0, most)
        };
        let efficient = if shininess == f32::INFINITY {
            of_discrete_directions(efficient, *nu)
        } else {
            efficient
        };
        // No jumps: particles side by side are looked at together.
        *nu = if is_known(square, brightness) {
            efficient
        } else {
            *nu
        };
    }
}

/// The number of children at a vertex that passes light on in discrete directions, where `efficient` would be right on average over all directions, and
/// `before_lessons` without having learned.
///
/// What goes on there depends on direction, and what was learned is a mean over many: no path is split, and none given up more readily than without lessons.
#[inline(always)]
pub(super) fn of_discrete_directions(efficient: f32, before_lessons: f32) -> f32 {
    let at_most_one = if efficient < 1.0 { efficient } else { 1.0 };
    if at_most_one > before_lessons {
        at_most_one
    } else {
        before_lessons
    }
}

/// Whether anything was learned of a particle. Where no light was found yet, it may be there all the same.
#[inline(always)]
pub(super) fn is_known(square: f32, brightness: f32) -> bool {
    (square > 0.0) & (brightness > 0.0)
}

/// Keeps the number of children that are expected of all particles together at or below [`MOST_PER_PATH`] for each camera path.
///
/// Where the image seems to be free of noise, paths that are not seem to be worth any number of rays, and a population would grow from bounce to bounce.
pub(super) fn bound(population: &Population, nu: &mut [f32]) {
    let sum: f64 = nu.iter().map(|&nu| f64::from(nu)).sum();
    let most = MOST_PER_PATH * f64::from(population.paths);
    if sum > most {
        let scale = (most / sum) as f32;
        nu.iter_mut().for_each(|nu| *nu *= scale);
    }
}

/// What a strategy asks of a particle of which nothing is known yet: the same as [`Roulette`].
#[inline(always)]
pub(super) fn before_lessons(population: &Population, index: usize) -> f32 {
    if population.importance[index] * population.albedo[index] >= Roulette::DEFAULT_THRESHOLD {
        1.0
    } else {
        1.0 - Roulette::DEFAULT_TERMINATION
    }
}
