//! Stage: next-event estimation. Every vertex looks at one point of one emitter, or as many as the integrator says.

use glam::Vec3;
use multiversion::multiversion;

use super::batch::{CameraPaths, Receiver, ShadowRays, Vertices};
use super::engine::Engine;
use super::offset::leave_surface;
use crate::sampling::{Sampler, Use, power_heuristic};
use crate::scene::LightSample;
use crate::spectrum::{Colour, SpectrumArithmetic};

/// Shadow rays end this share of their length before the light, so that they do not meet it.
const SHADOW_END: f32 = 1.0 - 1e-4;

/// Draws light for every vertex and fills `shadow` with the rays that decide whether it arrives.
///
/// They have been scattered `depth` times before. The emitter is chosen by what it can contribute; a path's contribution is
/// MIS-weighted against hitting the same light by chance.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
pub(super) fn sample_lights<C: Colour>(
    engine: &Engine,
    paths: &CameraPaths<C>,
    vertices: &Vertices<C>,
    depth: u32,
    sampler: &mut Sampler,
    shadow: &mut ShadowRays<C>,
) {
    let emitters = &engine.scene.emitters;
    let samples = engine.settings.samples;
    let share = 1.0 / samples.emitters as f32;
    shadow.restart(vertices.len() * samples.emitters as usize);
    for i in 0..vertices.len() {
        if !vertices.bsdf[i].has_smooth_lobe() {
            continue;
        }
        for sample in 0..samples.emitters {
            let point = vertices.point[i].branch(sample, depth);
            let [choice, u, v] = sampler.numbers(point, Use::Light(depth));
            let Receiver { position, normal } = vertices.receiver(i);
            let Some(chosen) = engine.light_choice.choose(position, normal, choice) else {
                continue;
            };
            let path = vertices.path[i];
            let wavelengths = &paths.wavelengths[path as usize];
            let Some(light) = emitters[chosen.emitter].sample::<C>(
                &engine.scene.shapes,
                position,
                wavelengths,
                [u, v],
            ) else {
                continue;
            };
            let incident = vertices.frame[i].to_local(light.direction);
            let bsdf = vertices.bsdf[i].evaluate(vertices.outgoing[i], incident);
            let mis = match light.pdf {
                Some(pdf) => power_heuristic(
                    pdf.chosen_with(chosen.probability)
                        .taken_times(samples.emitters),
                    bsdf.pdf.taken_times(samples.directions),
                ),
                None => 1.0,
            };
            let throughput = if bsdf.is_dispersive && !vertices.is_single[i] {
                vertices.throughput[i].only_hero()
            } else {
                vertices.throughput[i]
            };
            let contribution =
                throughput * bsdf.value * light.weight * (mis * share / chosen.probability);
            if contribution.is_black() {
                continue;
            }
            let origin = leave_surface(position, vertices.geometric_normal[i], light.direction);
            let (direction, length) = towards(position, origin, &light);
            shadow.rays.set(
                shadow.path.len(),
                origin.into(),
                direction.into(),
                0.0,
                length * SHADOW_END,
            );
            shadow.path.push(path);
            shadow.contribution.push(contribution);
        }
    }
    shadow.rays.resize(shadow.path.len());
}

/// Unit direction and distance from the `origin` of a shadow ray to the light that was drawn from `position`.
///
/// The ray ends off the light's surface, as it starts off its own: a light that is curved, or that lights itself, would
/// otherwise be in its own way where the ray grazes it.
#[inline]
fn towards<S>(position: Vec3, origin: Vec3, light: &LightSample<S>) -> (Vec3, f32) {
    if light.distance == f32::INFINITY {
        return (light.direction, light.distance);
    }
    let target = match &light.surface {
        Some(point) => leave_surface(point.position, point.geometric_normal, -light.direction),
        None => position + light.direction * light.distance,
    };
    let offset = target - origin;
    let length = offset.length();
    if length > 0.0 {
        (offset / length, length)
    } else {
        (light.direction, 0.0)
    }
}

/// Adds what the unoccluded shadow rays carry.
pub(super) fn add_unoccluded<C: Colour>(shadow: &ShadowRays<C>, paths: &mut CameraPaths<C>) {
    for i in 0..shadow.path.len() {
        if !shadow.rays.occluded(i) {
            paths.radiance[shadow.path[i] as usize] += shadow.contribution[i];
        }
    }
}
