//! Stage: the strategy decides how many children every vertex gets.

use multiversion::multiversion;

use super::batch::{CameraPaths, Particles, Vertices};
use super::recollection::Recollection;
use super::variant::{Scattering, Variant};
use crate::learning::Knowledge;
use crate::sampling::Sampler;
use crate::spectrum::{Colour, SpectrumArithmetic};
use crate::walk::{Offspring, Population, Scalar, Scope, Strategy, WalkReport};

/// What a thread needs to let strategies decide; its memory is reused.
#[derive(Default)]
pub(super) struct Decision {
    particles: Particles,
    recollection: Recollection,
    /// What was decided last.
    pub offspring: Offspring,
}

/// Shows the vertices to the strategy as a population, with what is known of them by `knowledge`, and lets it decide.
///
/// `depth` is the number of scattering events before these vertices.
pub(super) fn decide<C: Colour, V: Variant>(
    strategy: &dyn Strategy,
    knowledge: Option<&Knowledge>,
    paths: &CameraPaths<C>,
    vertices: &Vertices<C, V>,
    depth: u32,
    sampler: &mut Sampler,
    decision: &mut Decision,
) -> WalkReport {
    let Decision {
        particles,
        recollection,
        offspring,
    } = decision;
    particles.resize(vertices.len());
    let (scalar, scope) = (strategy.scalar(), strategy.scope());
    show(vertices, scalar, scope, &paths.pixel, particles);
    let population = Population {
        importance: &particles.importance,
        albedo: &particles.albedo,
        shininess: &particles.shininess,
        group: &particles.group,
        paths: paths.radiance.len() as u32,
        depth,
        points: sampler.decisions(&vertices.point),
        learned: knowledge.and_then(|knowledge| {
            recollection.recall(knowledge, paths, vertices, &particles.reflected)
        }),
    };
    strategy.resample(&population, sampler.stream(), offspring)
}

/// Fills the columns of `particles`, which are as long as `vertices`; `pixels` has the pixel of every camera path.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
fn show<C: Colour, V: Variant>(
    vertices: &Vertices<C, V>,
    wanted: Scalar,
    scope: Scope,
    pixels: &[u32],
    particles: &mut Particles,
) {
    let scalar = |spectrum: C::Spectrum| match wanted {
        Scalar::Mean => spectrum.mean(),
        Scalar::Maximum => spectrum.max_component(),
    };
    for (importance, &throughput) in particles.importance.iter_mut().zip(&vertices.throughput) {
        *importance = scalar(throughput);
    }
    let both = particles.albedo.iter_mut().zip(&mut particles.reflected);
    let vertex = vertices.bsdf.iter().zip(&vertices.throughput);
    for ((albedo, reflected), (bsdf, &throughput)) in both.zip(vertex) {
        let spectrum = bsdf.albedo();
        *albedo = scalar(spectrum);
        *reflected = (throughput * spectrum).mean();
    }
    if V::REFRACTS {
        // As Mitsuba's roulette: light is not less important for being compressed.
        let both = particles
            .importance
            .iter_mut()
            .zip(&mut particles.reflected);
        for ((importance, reflected), bsdf) in both.zip(&vertices.bsdf) {
            let squared_index = bsdf.refraction().squared_index;
            *importance *= squared_index;
            *reflected *= squared_index;
        }
    }
    for (shininess, bsdf) in particles.shininess.iter_mut().zip(&vertices.bsdf) {
        *shininess = bsdf.shininess();
    }
    match scope {
        Scope::Particle | Scope::CameraPath => particles.group.copy_from_slice(&vertices.path),
        Scope::Pixel => {
            for (group, path) in particles.group.iter_mut().zip(&vertices.path) {
                *group = pixels[*path as usize];
            }
        }
        Scope::Tile => particles.group.fill(0),
    }
}
