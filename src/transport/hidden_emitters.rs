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
        let next = |tnear| {
            let mut ray = RayHit1::new(Ray1::new(origin, direction, tnear, far));
            engine.accelerator.nearest1(&mut ray, Coherence::Incoherent);
            statistics.rays += 1;
            ray
        };
        let through = past_everything_that(
            |ray| glows(ray.hit.geometry_id),
            segments.rays.tfar(i),
            next,
        );
        let Ray1 { tnear, tfar, .. } = through.ray;
        segments.rays.set(i, origin, direction, tnear, tfar);
        segments.hits.set(i, &through.hit);
    }
    statistics.intersection_time += start.elapsed();
}

/// The first ray of those that `next` traces beyond the distance `met_at` which met nothing that `glows`.
///
/// Each starts beyond the one before, wherever that one met something: Embree, not robust, may round the distance of a triangle to slightly less than
/// where the ray starts, and would give the same answer for ever.
fn past_everything_that(
    glows: impl Fn(&RayHit1) -> bool,
    met_at: f32,
    mut next: impl FnMut(f32) -> RayHit1,
) -> RayHit1 {
    let mut tnear = met_at.next_up();
    loop {
        let ray = next(tnear);
        if !glows(&ray) {
            return ray;
        }
        tnear = ray.ray.tfar.max(tnear).next_up();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lamp, and a wall behind it; the lamp is met until the ray starts four floats behind it.
    #[test]
    fn a_lamp_whose_distance_is_rounded_down_is_passed() {
        let lamp = 2.0_f32;
        let sticks_until = f32::from_bits(lamp.to_bits() + 4);
        let (mut rays, mut starts_at) = (0, 0.0);
        let through = past_everything_that(
            |ray| ray.hit.geometry_id == 1,
            lamp,
            |tnear| {
                rays += 1;
                assert!(
                    rays <= 4,
                    "the ray from {tnear} does not come past the lamp"
                );
                assert!(tnear > starts_at);
                starts_at = tnear;
                let mut ray = RayHit1::new(Ray1::new([0.0; 3], [0.0, 0.0, 1.0], tnear, 9.0));
                let on_lamp = tnear < sticks_until;
                ray.hit.geometry_id = u32::from(on_lamp);
                ray.ray.tfar = if on_lamp { lamp } else { 3.0 };
                ray
            },
        );
        assert_eq!(rays, 4);
        assert_eq!(through.ray.tfar, 3.0);
        assert_eq!(through.ray.tnear, sticks_until);
    }
}
