//! Stage, only for `hide_emitters`: camera rays look through area lights.

use std::time::Instant;

use super::batch::Segments;
use super::engine::Engine;
use super::statistics::TraceStatistics;
use crate::embree::{Coherence, Ray1, RayHit1};
use crate::spectrum::Colour;

/// Follows every camera ray that met a glowing shape on, to the first surface that does not glow.
///
/// Lamps cover few pixels: these rays are traced one by one.
pub(super) fn look_through<C: Colour>(
    engine: &Engine,
    segments: &mut Segments<C>,
    statistics: &mut TraceStatistics,
) {
    let glows = |geometry: u32| {
        engine
            .accelerator
            .shape(&engine.scene, geometry)
            .is_some_and(|shape| shape.emitter.is_some())
    };
    let start = Instant::now();
    for i in 0..segments.len() {
        if !glows(segments.hits.geometry_id(i)) {
            continue;
        }
        let (origin, direction) = (segments.rays.origin(i), segments.rays.direction(i));
        let far = engine.camera.far_along(direction.into());
        let mut nearest = segments.rays.tfar(i);
        let through = loop {
            let mut ray = RayHit1::new(Ray1::new(origin, direction, nearest.next_up(), far));
            engine.accelerator.nearest1(&mut ray, Coherence::Incoherent);
            statistics.rays += 1;
            nearest = ray.ray.tfar;
            if !glows(ray.hit.geometry_id) {
                break ray;
            }
        };
        segments
            .rays
            .set(i, origin, direction, through.ray.tnear, through.ray.tfar);
        segments.hits.set(i, &through.hit);
    }
    statistics.intersection_time += start.elapsed();
}
