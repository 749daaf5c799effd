//! Hits become points of surfaces.

use std::ops::Range;

use super::batch::Segments;
use super::engine::Engine;
use crate::scene::{CornerLanes, Geometry, SurfaceLanes, SurfacePoint};
use crate::spectrum::Colour;

/// Hits whose surface points are found together: all of their memory fits the first-level cache.
pub(super) const CHUNK: usize = 64;

/// The surface points of a chunk of hits.
///
/// Vertices lie scattered in memory, and a loop that fetched and used them hit by hit would wait for each in turn. So a
/// chunk is taken in steps, indices, vertices, arithmetic: the fetches of a step do not depend on each other, and the
/// processor overlaps them; the arithmetic is one loop over lanes.
pub(super) struct SurfaceChunk {
    indices: [[u32; 3]; CHUNK],
    corners: CornerLanes<CHUNK>,
    points: SurfaceLanes<CHUNK>,
}

impl Default for SurfaceChunk {
    fn default() -> Self {
        Self {
            indices: [[0; 3]; CHUNK],
            corners: CornerLanes::default(),
            points: SurfaceLanes::default(),
        }
    }
}

impl SurfaceChunk {
    /// The point of the hit at `lane` of the chunk last [located](Self::locate). That of a miss means nothing.
    #[inline(always)]
    pub fn point(&self, lane: usize) -> SurfacePoint {
        self.points.get(lane)
    }

    /// Finds the surface points of the segments `chunk`, which are at most [`CHUNK`].
    #[inline(always)]
    pub fn locate<C: Colour>(
        &mut self,
        engine: &Engine,
        segments: &Segments<C>,
        chunk: Range<usize>,
    ) {
        let geometries = &segments.hits.geometry_ids()[chunk.clone()];
        let primitives = &segments.hits.primitive_ids()[chunk.clone()];
        let (mut u, mut v) = ([0.0; CHUNK], [0.0; CHUNK]);
        u[..chunk.len()].copy_from_slice(&segments.hits.us()[chunk.clone()]);
        v[..chunk.len()].copy_from_slice(&segments.hits.vs()[chunk.clone()]);
        let mut has_quadrics = false;
        for (lane, (&geometry, &primitive)) in geometries.iter().zip(primitives).enumerate() {
            match geometry_of(engine, geometry) {
                Some(Geometry::Triangles(mesh)) => self.indices[lane] = mesh.corners(primitive),
                Some(_) => has_quadrics = true,
                None => {}
            }
        }
        for (lane, &geometry) in geometries.iter().enumerate() {
            if let Some(Geometry::Triangles(mesh)) = geometry_of(engine, geometry) {
                mesh.fetch(self.indices[lane], &mut self.corners, lane);
            }
        }
        self.corners.interpolate(&u, &v, &mut self.points);
        if has_quadrics {
            self.locate_quadrics(engine, segments, chunk);
        }
    }

    /// Finds the points of those that are no meshes.
    fn locate_quadrics<C: Colour>(
        &mut self,
        engine: &Engine,
        segments: &Segments<C>,
        chunk: Range<usize>,
    ) {
        for (lane, i) in chunk.enumerate() {
            let Some(geometry) = geometry_of(engine, segments.hits.geometry_id(i)) else {
                continue;
            };
            if !matches!(geometry, Geometry::Triangles(_)) {
                let point = geometry.surface(&segments.hit(i));
                self.points.set(lane, &point);
            }
        }
    }
}

/// The shape that a geometry number names, if it is one: misses have none.
#[inline(always)]
fn geometry_of(engine: &Engine, geometry: u32) -> Option<&Geometry> {
    let shape = engine.accelerator.shape(&engine.scene, geometry)?;
    Some(&shape.geometry)
}
