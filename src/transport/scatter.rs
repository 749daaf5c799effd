//! Stage: children leave their parents in directions drawn from the bsdf.

use super::batch::{Segments, Vertices};
use super::offset::leave_surface;
use crate::sampling::RandomStream;
use crate::spectrum::{Colour, SpectrumArithmetic};
use crate::walk::Child;

/// Starts one segment for every child that can carry light; siblings side by side.
pub(super) fn scatter<C: Colour>(
    vertices: &Vertices<C>,
    children: &[Child],
    random: &mut RandomStream,
    segments: &mut Segments<C>,
) {
    segments.restart(children.len());
    for child in children {
        let parent = child.parent as usize;
        let sample = vertices.bsdf[parent].sample(vertices.outgoing[parent], random.uniform_2d());
        let throughput = vertices.throughput[parent] * sample.weight * child.weight;
        if throughput.is_black() {
            continue;
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
        segments.push(vertices.path[parent], throughput, sample.pdf);
    }
    let count = segments.len();
    segments.rays.resize(count);
}
