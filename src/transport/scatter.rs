//! Stage: children leave their parents in directions drawn from the bsdf.

use multiversion::multiversion;

use super::batch::{Segments, Vertices};
use super::engine::Engine;
use super::offset::leave_surface;
use crate::sampling::{Sampler, Use};
use crate::spectrum::{Colour, SpectrumArithmetic};
use crate::walk::Child;

/// Starts one segment for every child that can carry light; siblings side by side. Their parents have been scattered
/// `depth` times before.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
pub(super) fn scatter<C: Colour>(
    engine: &Engine,
    vertices: &Vertices<C>,
    children: &[Child],
    depth: u32,
    sampler: &mut Sampler,
    segments: &mut Segments<C>,
) {
    segments.restart(children.len());
    let light_is_chosen = engine.light_choice.depends_on_surface();
    if light_is_chosen {
        segments.remember_origins(children.len());
    }
    let mut elder_siblings = 0;
    for (i, child) in children.iter().enumerate() {
        let parent = child.parent as usize;
        let has_elder = i > 0 && children[i - 1].parent == child.parent;
        elder_siblings = if has_elder { elder_siblings + 1 } else { 0 };
        let point = vertices.point[parent].branch(elder_siblings, depth);
        let u = sampler.numbers(point, Use::Direction(depth));
        let sample = vertices.bsdf[parent].sample(vertices.outgoing[parent], u);
        let mut throughput = vertices.throughput[parent] * sample.weight * child.weight;
        if throughput.is_black() {
            continue;
        }
        let was_single = vertices.is_single[parent];
        if sample.is_dispersive && !was_single {
            throughput = throughput.only_hero();
        }
        let direction = vertices.frame[parent].to_world(sample.incident);
        let normal = vertices.geometric_normal[parent];
        let origin = leave_surface(vertices.position[parent], normal, direction);
        segments.rays.set(
            segments.len(),
            origin.into(),
            direction.into(),
            0.0,
            f32::INFINITY,
        );
        let is_single = was_single || sample.is_dispersive;
        segments.push(
            vertices.path[parent],
            throughput,
            point,
            is_single,
            sample.pdf,
        );
        if light_is_chosen {
            segments.origins.push(vertices.receiver(parent));
        }
    }
    let count = segments.len();
    segments.rays.resize(count);
}
