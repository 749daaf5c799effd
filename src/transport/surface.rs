//! Hits become points of surfaces.

use std::ops::Range;

use super::batch::Segments;
use super::engine::Engine;
use super::shape_table::ShapeEntry;
use crate::embree::INVALID_GEOMETRY;
use crate::lanes::{CHUNK, KeptLanes, VectorLanes, load};
use crate::scene::{CornerLanes, Geometry, PlaneLanes, Planes, Shape, SurfaceLanes};
use crate::spectrum::Colour;

/// The surface points of a chunk of hits.
///
/// Triangles lie scattered in memory, and a loop that fetched and used them hit by hit would wait for each in turn. So a
/// chunk is taken in steps: planes of flat triangles and indices of others, vertices, arithmetic. What a step needs is announced a
/// step before, and the processor fetches it meanwhile; the arithmetic is one loop over lanes.
pub(super) struct SurfaceChunk<'s> {
    /// The shapes hit.
    pub entries: [&'s ShapeEntry; CHUNK],
    /// Those of the chunk that follows.
    next_entries: [&'s ShapeEntry; CHUNK],
    /// The planes of what it hits that has one, by number.
    next_planes: [u32; CHUNK],
    /// Of flat triangles in the world.
    planes: PlaneLanes<CHUNK>,
    /// Of all other triangles; without meaning in other lanes.
    corners: [[u32; 3]; CHUNK],
    triangles: CornerLanes<CHUNK>,
    /// Those of misses mean nothing. Those in instances are in the space of the group until they are [placed](Self::place).
    pub points: SurfaceLanes<CHUNK>,
}

impl<'s> SurfaceChunk<'s> {
    pub fn new(engine: &'s Engine) -> Self {
        let miss = engine.shapes.entry(INVALID_GEOMETRY);
        Self {
            entries: [miss; CHUNK],
            next_entries: [miss; CHUNK],
            next_planes: [Planes::NONE; CHUNK],
            planes: PlaneLanes::default(),
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
        self.entries = self.next_entries;
        let mut corner_lanes = KeptLanes::none();
        let mut has_quadrics = false;
        for (lane, i) in chunk.clone().enumerate() {
            if let Some(plane) = engine.scene.planes.get(self.next_planes[lane]) {
                self.planes.put(lane, plane);
                continue;
            }
            match engine.shape(segments, i).map(|shape| &shape.geometry) {
                None => {}
                Some(Geometry::Triangles(mesh)) => {
                    let triangle = mesh.corners(segments.hits.primitive_id(i));
                    mesh.prefetch_vertices(triangle);
                    self.corners[lane] = triangle;
                    corner_lanes.add_if(lane, true);
                }
                Some(_) => has_quadrics = true,
            }
        }
        self.announce(engine, segments, chunk.end);
        self.meet_planes(segments, chunk.clone());
        if corner_lanes.len() > 0 {
            self.interpolate(engine, segments, chunk.clone(), &corner_lanes);
        }
        if has_quadrics {
            self.locate_quadrics(engine, segments, chunk);
        }
    }

    /// Finds the points of triangles that have no plane, those in `lanes`.
    #[inline(always)]
    fn interpolate<C: Colour>(
        &mut self,
        engine: &Engine,
        segments: &Segments<C>,
        chunk: Range<usize>,
        lanes: &KeptLanes,
    ) {
        for lane in lanes.iter() {
            if let Some(shape) = engine.shape(segments, chunk.start + lane)
                && let Geometry::Triangles(mesh) = &shape.geometry
            {
                mesh.fetch(self.corners[lane], &mut self.triangles, lane);
            }
        }
        let (mut u, mut v) = ([0.0; CHUNK], [0.0; CHUNK]);
        load(&mut u, &segments.hits.us()[chunk.clone()]);
        load(&mut v, &segments.hits.vs()[chunk]);
        let mut points = SurfaceLanes::default();
        self.triangles.interpolate(&u, &v, &mut points);
        if lanes.len() == CHUNK {
            self.points = points;
            return;
        }
        for lane in lanes.iter() {
            self.points.set(lane, &points.get(lane));
        }
    }

    /// Finds the points of those that have one; the points in all other lanes mean nothing after it.
    #[inline(always)]
    fn meet_planes<C: Colour>(&mut self, segments: &Segments<C>, chunk: Range<usize>) {
        let rays = &segments.rays;
        let (mut origins, mut directions) = (VectorLanes::default(), VectorLanes::default());
        let mut t = [0.0; CHUNK];
        origins.load(rays.origins().map(|axis| &axis[chunk.clone()]));
        directions.load(rays.directions().map(|axis| &axis[chunk.clone()]));
        load(&mut t, &rays.tfars()[chunk]);
        let points = &mut self.points;
        self.planes.find_points(&origins, &directions, &t, points);
    }

    /// Looks at what the chunk of segments from `start` on has met, and says that its triangles will be asked for soon.
    #[inline(always)]
    fn announce<C: Colour>(&mut self, engine: &'s Engine, segments: &Segments<C>, start: usize) {
        let chunk = start..segments.len().min(start + CHUNK);
        let geometries = &segments.hits.geometry_ids()[chunk.clone()];
        let primitives = &segments.hits.primitive_ids()[chunk];
        for (lane, (&geometry, &primitive)) in geometries.iter().zip(primitives).enumerate() {
            let entry = engine.shapes.entry(geometry);
            let plane = entry.plane(primitive);
            self.next_entries[lane] = entry;
            self.next_planes[lane] = plane;
            if plane != Planes::NONE {
                engine.scene.planes.prefetch(plane);
            } else if let Some(Shape {
                geometry: Geometry::Triangles(mesh),
                ..
            }) = engine.accelerator.shape(&engine.scene, geometry)
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
            if let Some(instance) = engine.instance(segments, i) {
                self.points
                    .set(lane, &instance.point(&self.points.get(lane)));
            }
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
            match engine.shape(segments, i) {
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
