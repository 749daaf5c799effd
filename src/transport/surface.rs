//! Stage: hits become points of surfaces.

use super::batch::{Arrivals, Segments};
use super::engine::Engine;
use crate::scene::{Corners, Geometry, HitCoordinates, SurfacePoint, Triangles};
use crate::spectrum::Colour;

/// Hits whose memory is fetched together: their scratch fits the first-level cache.
const CHUNK: usize = 64;

/// Finds the surface point of every segment that hit something. The entries of misses mean nothing.
///
/// Vertices lie scattered in memory, and a loop that fetched and used them hit by hit would wait for each in turn. So a
/// chunk is taken in steps, indices, vertices, arithmetic: the fetches of a step do not depend on each other, and the
/// processor overlaps them.
pub(super) fn locate<C: Colour>(engine: &Engine, segments: &Segments<C>, arrivals: &mut Arrivals) {
    let count = segments.len();
    arrivals.point.clear();
    arrivals.point.resize(count, SurfacePoint::default());
    let mut indices = [[0; 3]; CHUNK];
    let mut corners = [Corners::default(); CHUNK];
    for start in (0..count).step_by(CHUNK) {
        let chunk = start..count.min(start + CHUNK);
        for i in chunk.clone() {
            if let Some(mesh) = mesh(engine, segments, i) {
                indices[i - start] = mesh.corners(segments.hits.primitive_id(i));
            }
        }
        for i in chunk.clone() {
            if let Some(mesh) = mesh(engine, segments, i) {
                corners[i - start] = mesh.corner_data(indices[i - start]);
            }
        }
        for i in chunk {
            let hit = segments.hits.geometry_id(i);
            let Some(shape) = engine.accelerator.shape(&engine.scene, hit) else {
                continue;
            };
            let [u, v] = segments.hits.uv(i);
            arrivals.point[i] = match &shape.geometry {
                Geometry::Triangles(mesh) => mesh.interpolate(&corners[i - start], u, v),
                quadric => quadric.surface(&HitCoordinates {
                    primitive: segments.hits.primitive_id(i),
                    u,
                    v,
                    normal: segments.hits.normal(i).into(),
                }),
            };
        }
    }
}

/// The mesh that segment `i` hit, if it is one.
#[inline]
fn mesh<'e, C: Colour>(
    engine: &'e Engine,
    segments: &Segments<C>,
    i: usize,
) -> Option<&'e Triangles> {
    let hit = segments.hits.geometry_id(i);
    match &engine.accelerator.shape(&engine.scene, hit)?.geometry {
        Geometry::Triangles(mesh) => Some(mesh),
        Geometry::Sphere(_) | Geometry::Disk(_) | Geometry::Cylinder(_) => None,
    }
}
