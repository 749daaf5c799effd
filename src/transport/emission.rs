//! Stage: paths arrive. Emitted light is added, and surfaces that scatter become the vertices of the next stages.

use glam::Vec3;
use multiversion::multiversion;

use super::batch::{CameraPaths, Receiver, Segments, Vertices};
use super::engine::Engine;
use super::settings::DirectLight;
use super::surface::{CHUNK, SurfaceChunk};
use crate::sampling::{Frame, Sampler, SolidAnglePdf, power_heuristic};
use crate::scene::{Emitter, EmitterId, SeenPoint, Side, SurfaceParameters};
use crate::spectrum::{Colour, SpectrumArithmetic};

/// Adds the emission that every segment meets, MIS-weighted against next-event estimation, and fills `vertices` with
/// those that met a surface which scatters light, in the order of the segments.
///
/// The segments have been scattered `depth` times before; `scatters` is false at the last depth, where paths end.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
pub(super) fn arrive<C: Colour>(
    engine: &Engine,
    paths: &mut CameraPaths<C>,
    segments: &Segments<C>,
    vertices: &mut Vertices<C>,
    sampler: &mut Sampler,
    depth: u32,
    scatters: bool,
) {
    let camera_rays = depth == 0;
    vertices.restart(segments.len());
    let hidden = camera_rays && engine.settings.hide_emitters;
    let mut surfaces = SurfaceChunk::default();
    for start in (0..segments.len()).step_by(CHUNK) {
        let chunk = start..segments.len().min(start + CHUNK);
        surfaces.locate(engine, segments, chunk.clone());
        for i in chunk {
            let path = segments.path[i];
            let wavelengths = &paths.wavelengths[path as usize];
            let direction = Vec3::from(segments.rays.direction(i));
            let hit = segments.hits.geometry_id(i);
            let Some(shape) = engine.accelerator.shape(&engine.scene, hit) else {
                if let Some(emitter) = engine.surroundings.filter(|_| !hidden) {
                    let light = &engine.scene.emitters[emitter];
                    let light_pdf = light.surrounding_pdf(direction);
                    let weight = engine.mis_weight(segments, i, emitter, light_pdf);
                    let radiance = light.surrounding_radiance::<C>(direction, wavelengths) * weight;
                    paths.radiance[path as usize] += segments.throughput[i] * radiance;
                }
                continue;
            };
            let point = surfaces.point(i - start);
            if let Some(emitter) = shape.emitter.map(EmitterId::index)
                && let Emitter::Area(light) = &engine.scene.emitters[emitter]
            {
                let radiance = light.radiance::<C>(&point, -direction, wavelengths);
                if !radiance.is_black() {
                    let origin = Vec3::from(segments.rays.origin(i));
                    let light_pdf = light.pdf(&engine.scene.shapes, origin, &point);
                    let weight = engine.mis_weight(segments, i, emitter, light_pdf);
                    paths.radiance[path as usize] += segments.throughput[i] * (radiance * weight);
                }
            }
            if !scatters {
                continue;
            }
            let Some(side) = Side::seen_with(-direction.dot(point.shading_normal)) else {
                continue;
            };
            let material = &engine.scene.materials[shape.material.index()];
            let facing = side.facing(point.shading_normal);
            let (frame, front, parameters) = if material.needs_parameters() {
                let parameters = shape.geometry.parameters(&segments.hit(i), &point);
                let front = parameters.shading_frame(point.shading_normal);
                let frame = Frame {
                    normal: facing,
                    ..front
                };
                (frame, front, parameters)
            } else {
                let frame = Frame::about(facing);
                (frame, frame, SurfaceParameters::default())
            };
            let choice = if material.is_mixed() {
                sampler.material_choice(segments.point[i], depth)
            } else {
                0.0
            };
            let seen = SeenPoint {
                side,
                frame: front,
                outgoing: frame.to_local(-direction),
                parameters,
                choice,
            };
            let Some(bsdf) = material.bsdf::<C>(&seen, wavelengths) else {
                continue;
            };
            vertices.path.push(path);
            vertices.throughput.push(segments.throughput[i]);
            vertices.point.push(segments.point[i]);
            vertices.is_single.push(segments.is_single[i]);
            vertices.position.push(point.position);
            vertices.geometric_normal.push(point.geometric_normal);
            vertices.outgoing.push(seen.outgoing);
            vertices.frame.push(frame);
            vertices.bsdf.push(bsdf);
        }
    }
}

impl Engine {
    /// The weight of light that segment `i` found at `emitter`, where next-event estimation draws the same direction with
    /// `light_pdf` once it has chosen that emitter.
    #[inline]
    fn mis_weight<C: Colour>(
        &self,
        segments: &Segments<C>,
        i: usize,
        emitter: usize,
        light_pdf: SolidAnglePdf,
    ) -> f32 {
        let direction_pdf = segments.direction_pdf[i];
        if self.settings.direct_light == DirectLight::Off || direction_pdf.0 == f32::INFINITY {
            return 1.0;
        }
        let chosen_with = match segments.origins.get(i) {
            Some(&Receiver { position, normal }) => {
                self.light_choice.probability(position, normal, emitter)
            }
            None => 1.0,
        };
        let samples = &self.settings.samples;
        power_heuristic(
            direction_pdf.taken_times(samples.directions),
            light_pdf
                .chosen_with(chosen_with)
                .taken_times(samples.emitters),
        )
    }
}
