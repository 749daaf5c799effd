//! Hits of quads become hits of triangles.

use multiversion::multiversion;

use crate::embree::{Half, OnPrimitives};
use crate::scene::{Geometry, Shape};

/// What is needed to tell which triangle of its shape a hit is on, and where.
pub(super) struct TriangleNames {
    /// By shape, and one more for misses: the first of its quads that is two triangles; [`Self::NO_QUADS`] where its primitives
    /// are no quads.
    first_pairs: Vec<u32>,
}

impl TriangleNames {
    const NO_QUADS: u32 = u32::MAX;

    pub fn of(shapes: &[Shape]) -> Self {
        let first_pairs = shapes.iter().map(|shape| match &shape.geometry {
            Geometry::Triangles(mesh) => mesh.faces().alone(),
            Geometry::Sphere(_) | Geometry::Disk(_) | Geometry::Cylinder(_) => Self::NO_QUADS,
        });
        Self {
            first_pairs: first_pairs.chain([Self::NO_QUADS]).collect(),
        }
    }

    /// Lets primitives and coordinates of hits, whose geometries are shapes, be those of triangles instead of quads.
    pub fn name(&self, hits: &mut OnPrimitives<'_>) {
        name(&self.first_pairs, hits);
    }
}

/// So many hits are renamed at once.
const LANES: usize = 64;

#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
fn name<'a>(first_pairs: &[u32], hits: &mut OnPrimitives<'a>) {
    let miss = first_pairs.len() - 1;
    let coordinates = (hits.u.chunks_mut(LANES)).zip(hits.v.chunks_mut(LANES));
    let primitives = (hits.geometry_id.chunks(LANES)).zip(hits.primitive_id.chunks_mut(LANES));
    for ((shapes, primitives), (us, vs)) in primitives.zip(coordinates) {
        // Looked up before, so that what follows goes over lanes.
        let mut first_pair = [0; LANES];
        for (first_pair, &shape) in first_pair.iter_mut().zip(shapes) {
            *first_pair = first_pairs[miss.min(shape as usize)];
        }
        let coordinates = us.iter_mut().zip(vs);
        let quads = primitives.iter_mut().zip(first_pair);
        for ((primitive, first_pair), (u, v)) in quads.zip(coordinates) {
            let quad = *primitive;
            let half = Half::of(*u, *v);
            let is_pair = quad >= first_pair;
            let is_second = is_pair & half.is_second;
            // Two triangles for each pair before it. What a miss has means nothing, and may be any number.
            let before = quad.max(first_pair) - first_pair;
            *primitive = quad.wrapping_add(before).wrapping_add(is_second.into());
            (*u, *v) = if is_second {
                (half.u, half.v)
            } else {
                (*u, *v)
            };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quads_of_every_shape_become_triangles() {
        // A mesh of three triangles alone and pairs after them, a sphere, a mesh of pairs.
        let names = TriangleNames {
            first_pairs: vec![3, TriangleNames::NO_QUADS, 0, TriangleNames::NO_QUADS],
        };
        let cases = [
            // Shape, quad, u, v; triangle, u, v.
            ((0, 2, 0.75, 0.5), (2, 0.75, 0.5)),
            ((0, 3, 0.25, 0.5), (3, 0.25, 0.5)),
            ((0, 3, 0.75, 0.5), (4, 0.25, 0.5)),
            ((0, 5, 0.75, 0.5), (8, 0.25, 0.5)),
            ((1, 0, 0.75, 0.5), (0, 0.75, 0.5)),
            ((2, 0, 0.25, 0.5), (0, 0.25, 0.5)),
            ((2, 7, 0.75, 1.0), (15, 0.25, 0.0)),
            ((u32::MAX, 9, 0.75, 0.5), (9, 0.75, 0.5)),
        ];
        let geometry_id = cases.map(|(hit, _)| hit.0);
        let mut primitive_id = cases.map(|(hit, _)| hit.1);
        let (mut u, mut v) = (cases.map(|(hit, _)| hit.2), cases.map(|(hit, _)| hit.3));
        names.name(&mut OnPrimitives {
            geometry_id: &geometry_id,
            primitive_id: &mut primitive_id,
            u: &mut u,
            v: &mut v,
        });
        for (i, (hit, expected)) in cases.into_iter().enumerate() {
            assert_eq!((primitive_id[i], u[i], v[i]), expected, "{hit:?}");
        }
    }
}
