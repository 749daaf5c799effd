//! Hits become points of surfaces.

use std::ops::Range;

use super::batch::Segments;
use super::engine::Engine;
use crate::lanes::{CHUNK, load};
use crate::scene::{CornerLanes, Geometry, Shape, SurfaceLanes};
use crate::spectrum::Colour;

/// The surface points of a chunk of hits.
///
/// Vertices lie scattered in memory, and a loop that fetched and used them hit by hit would wait for each in turn. So a
/// chunk is taken in steps, indices, vertices, arithmetic: what a step needs is announced a step before, and the processor
/// fetches it meanwhile; the arithmetic is one loop over lanes.
pub(super) struct SurfaceChunk<'s> {
    /// The shapes hit; none by misses.
    pub shapes: [Option<&'s Shape>; CHUNK],
    /// Those of the chunk that follows.
    next_shapes: [Option<&'s Shape>; CHUNK],
    corners: [[u32; 3]; CHUNK],
    triangles: CornerLanes<CHUNK>,
    /// Those of misses mean nothing. Those in instances are in the space of the group until they are [placed](Self::place).
    pub points: SurfaceLanes<CHUNK>,
}

impl<'s> SurfaceChunk<'s> {
    pub fn new() -> Self {
        Self {
            shapes: [None; CHUNK],
            next_shapes: [None; CHUNK],
            corners: [[0; 3]; CHUNK],
            triangles: CornerLanes::default(),
            points: SurfaceLanes::default(),
        }
    }

    /// Finds the surface points of the segments `chunk`, at most [`CHUNK`]: first of the first ones, then of those that
    /// follow.
    #[inline(always)]
    pub fn locate<C: Colour>(
        &mut self,
        engine: &'s Engine,
        segments: &Segments<C>,
        chunk: Range<usize>,
    ) {
        if chunk.start == 0 {
            self.announce(engine, segments, 0);
        }
        self.shapes = self.next_shapes;
        let primitives = &segments.hits.primitive_ids()[chunk.clone()];
        let mut has_quadrics = false;
        for (lane, &primitive) in primitives.iter().enumerate() {
            if let Some(shape) = self.shapes[lane] {
                match &shape.geometry {
                    Geometry::Triangles(mesh) => {
                        let corners = mesh.corners(primitive);
                        mesh.prefetch(corners);
                        self.corners[lane] = corners;
                    }
                    _ => has_quadrics = true,
                }
            }
        }
        self.announce(engine, segments, chunk.end);
        let shapes = &self.shapes[..chunk.len()];
        for (lane, (shape, corners)) in shapes.iter().zip(&self.corners).enumerate() {
            if let Some(Shape {
                geometry: Geometry::Triangles(mesh),
                ..
            }) = shape
            {
                mesh.fetch(*corners, &mut self.triangles, lane);
            }
        }
        let (mut u, mut v) = ([0.0; CHUNK], [0.0; CHUNK]);
        load(&mut u, &segments.hits.us()[chunk.clone()]);
        load(&mut v, &segments.hits.vs()[chunk.clone()]);
        self.triangles.interpolate(&u, &v, &mut self.points);
        if has_quadrics {
            self.locate_quadrics(segments, chunk);
        }
    }

    /// Looks at what the chunk of segments from `start` on has met, and says that its triangles will be asked for soon.
    #[inline(always)]
    fn announce<C: Colour>(&mut self, engine: &'s Engine, segments: &Segments<C>, start: usize) {
        let chunk = start..segments.len().min(start + CHUNK);
        let geometries = &segments.hits.geometry_ids()[chunk.clone()];
        let primitives = &segments.hits.primitive_ids()[chunk];
        let hits = geometries.iter().zip(primitives);
        for (next, (&geometry, &primitive)) in self.next_shapes.iter_mut().zip(hits) {
            *next = engine.accelerator.shape(&engine.scene, geometry);
            if let Some(Shape {
                geometry: Geometry::Triangles(mesh),
                ..
            }) = next
            {
                mesh.prefetch_corners(primitive);
            }
        }
    }

    /// Moves the points of the chunk that stand in instances from the space of their group to the world. To be called after
    /// [`Self::locate`] in scenes that have instances.
    pub fn place<C: Colour>(
        &mut self,
        engine: &Engine,
        segments: &Segments<C>,
        chunk: Range<usize>,
    ) {
        for (lane, i) in chunk.enumerate() {
            if self.shapes[lane].is_some()
                && let Some(instance) = engine.instance(segments, i)
            {
                self.points
                    .set(lane, &instance.point(&self.points.get(lane)));
            }
        }
    }

    /// Finds the points of those that are no meshes.
    fn locate_quadrics<C: Colour>(&mut self, segments: &Segments<C>, chunk: Range<usize>) {
        for (lane, i) in chunk.enumerate() {
            match self.shapes[lane] {
                None
                | Some(Shape {
                    geometry: Geometry::Triangles(_),
                    ..
                }) => {}
                Some(shape) => {
                    let point = shape.geometry.surface(&segments.hit(i));
                    self.points.set(lane, &point);
                }
            }
        }
    }
}
