//! Stage: the strategy decides how many children every vertex gets.

use super::batch::{Particles, Vertices};
use super::variant::{Scattering, Variant};
use crate::sampling::Sampler;
use crate::spectrum::{Colour, SpectrumArithmetic};
use crate::walk::{Offspring, Population, Scalar, Scope, Strategy, WalkReport};

/// Shows the vertices to the strategy as a population and lets it fill `offspring`.
///
/// `samples` is the number of camera paths of each pixel, `depth` the number of scattering events before these vertices.
pub(super) fn decide<C: Colour, V: Variant>(
    strategy: &dyn Strategy,
    vertices: &Vertices<C, V>,
    samples: u32,
    depth: u32,
    particles: &mut Particles,
    sampler: &mut Sampler,
    offspring: &mut Offspring,
) -> WalkReport {
    // Asked once: a call through the trait for every particle would be felt.
    let (wanted, scope) = (strategy.scalar(), strategy.scope());
    let scalar = |spectrum: C::Spectrum| match wanted {
        Scalar::Mean => spectrum.mean(),
        Scalar::Maximum => spectrum.max_component(),
    };
    particles.restart(vertices.len());
    particles.importance.extend(
        vertices
            .throughput
            .iter()
            .map(|&throughput| scalar(throughput)),
    );
    if V::REFRACTS {
        // As Mitsuba's roulette: light is not less important for being compressed.
        for (importance, bsdf) in particles.importance.iter_mut().zip(&vertices.bsdf) {
            *importance *= bsdf.refraction().squared_index;
        }
    }
    particles
        .albedo
        .extend(vertices.bsdf.iter().map(|bsdf| scalar(bsdf.albedo())));
    particles
        .shininess
        .extend(vertices.bsdf.iter().map(|bsdf| bsdf.shininess()));
    let group_of = |path: u32| match scope {
        Scope::Particle | Scope::CameraPath => path,
        Scope::Pixel => path / samples,
        Scope::Tile => 0,
    };
    particles
        .group
        .extend(vertices.path.iter().map(|&path| group_of(path)));
    let population = Population {
        importance: &particles.importance,
        albedo: &particles.albedo,
        shininess: &particles.shininess,
        group: &particles.group,
        depth,
        points: sampler.has_sequences().then_some(&vertices.point),
    };
    strategy.resample(&population, sampler.stream(), offspring)
}
