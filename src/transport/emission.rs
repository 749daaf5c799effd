//! Stage: paths arrive. Emitted light is added, and surfaces that scatter become the vertices of the next stages.

use std::ops::Range;

use glam::Vec3;
use multiversion::multiversion;

use super::batch::{CameraPaths, Segments, Vertices};
use super::engine::Engine;
use super::lineage::Generation;
use super::settings::DirectLight;
use super::surface::SurfaceChunk;
use super::variant::{Arrivals, Scattering, Variant};
use crate::lanes::{CHUNK, VectorLanes, append_kept};
use crate::learning::Knowledge;
use crate::room::make_room;
use crate::sampling::{Sampler, SolidAnglePdf, power_heuristic};
use crate::scene::Emitter;
use crate::spectrum::{Colour, SpectrumArithmetic};

/// Adds the emission that every segment meets, MIS-weighted against next-event estimation, and fills `vertices` with
/// those that met a surface which scatters light, in the order of the segments.
///
/// At the last depth paths end.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
pub(super) fn arrive<C: Colour, V: Variant>(
    engine: &Engine,
    paths: &mut CameraPaths<C>,
    segments: &Segments<C>,
    vertices: &mut Vertices<C, V>,
    sampler: &mut Sampler,
    mut generation: Option<&mut Generation>,
    knowledge: Option<&Knowledge>,
) {
    let depth = segments.depth;
    vertices.restart(depth, segments.len());
    let max_depth = engine.settings.max_depth;
    let scatters = max_depth.is_none_or(|max_depth| depth + 1 < max_depth);
    let has_instances = V::INSTANCES && !engine.scene.instances.is_empty();
    if has_instances {
        make_room(&mut vertices.clearance, segments.len());
    }
    let mut ranks = sampler.ranks();
    let mut surfaces = SurfaceChunk::new(engine);
    let mut sides = SideChunk::new();
    for start in (0..segments.len()).step_by(CHUNK) {
        let chunk = start..segments.len().min(start + CHUNK);
        surfaces.locate(engine, segments, chunk.clone());
        if has_instances {
            surfaces.place(engine, segments, chunk.clone());
        }
        sides.find(
            segments.rays.directions().map(|axis| &axis[chunk.clone()]),
            &surfaces.points.shading_normal,
        );
        add_emission(
            engine,
            paths,
            segments,
            &surfaces,
            chunk.clone(),
            generation.as_deref_mut(),
            knowledge,
        );
        if !scatters {
            continue;
        }
        let arrivals = Arrivals {
            engine,
            paths,
            segments,
            chunk: chunk.clone(),
            surfaces: &surfaces,
            cosines: &sides.cosine,
        };
        let scattering = V::Scattering::arrive(&arrivals, sampler, &mut vertices.bsdf);
        let segment_of = |lane| start + lane;
        let kept = scattering.iter().map(segment_of);
        if generation.is_some() {
            vertices.segment.extend(kept.clone().map(|i| i as u32));
        }
        append_kept(
            &mut vertices.path,
            &segments.path[chunk.clone()],
            &scattering,
        );
        let throughputs = &segments.throughput[chunk.clone()];
        append_kept(&mut vertices.throughput, throughputs, &scattering);
        if let Some(ranks) = &mut ranks {
            let points = kept.map(|i| paths.rank(segments.path[i], ranks));
            vertices.point.extend(points);
        } else if sampler.has_sequences() {
            vertices.point.extend(kept.map(|i| segments.point[i]));
        }
        let points = &surfaces.points;
        vertices.position.append(&points.position, &scattering);
        if !engine.shades_flat {
            vertices
                .geometric_normal
                .append(&points.geometric_normal, &scattering);
        }
        vertices.normal.append(&sides.normal, &scattering);
        if has_instances {
            let clearance = |lane| {
                let instance = engine.instance(segments, segment_of(lane));
                instance.map_or(0.0, |instance| instance.clearance(&points.get(lane)))
            };
            vertices.clearance.extend(scattering.iter().map(clearance));
        }
    }
}

/// Adds what the segments of a chunk find emitted to their paths.
#[inline(always)]
fn add_emission<C: Colour>(
    engine: &Engine,
    paths: &mut CameraPaths<C>,
    segments: &Segments<C>,
    surfaces: &SurfaceChunk,
    chunk: Range<usize>,
    mut generation: Option<&mut Generation>,
    knowledge: Option<&Knowledge>,
) {
    let hides_surroundings = segments.depth == 0 && engine.settings.hide_emitters;
    let wavelengths = &paths.wavelengths;
    let radiances = &mut paths.radiance;
    let mut add = |i: usize, path: usize, light: C::Spectrum| {
        radiances[path] += light;
        if let Some(generation) = &mut generation {
            generation.add(i, light);
        }
    };
    for (lane, i) in chunk.enumerate() {
        let Some(emitter) = surfaces.entries[lane].emitter() else {
            continue;
        };
        let path = segments.path[i] as usize;
        let wavelengths = &wavelengths[path];
        let direction = Vec3::from(segments.rays.direction(i));
        let emitted = match (&engine.scene.emitters[emitter], engine.shape(segments, i)) {
            (Emitter::Area(light), Some(shape)) => {
                let point = surfaces.points.get(lane);
                let parameters = || shape.geometry.parameters(&segments.hit(i), &point);
                let radiance = light.radiance::<C>(&point, parameters, -direction, wavelengths);
                let origin = Vec3::from(segments.rays.origin(i));
                (!radiance.is_black()).then(|| Emitted {
                    emitter,
                    radiance,
                    light_pdf: light.pdf(&engine.scene.shapes, origin, &point),
                })
            }
            (light, _) => (!hides_surroundings).then(|| Emitted {
                emitter,
                radiance: light.surrounding_radiance::<C>(direction, wavelengths),
                light_pdf: light.surrounding_pdf(direction),
            }),
        };
        if let Some(emitted) = emitted {
            let weight = engine.mis_weight(segments, i, &emitted, knowledge);
            add(
                i,
                path,
                segments.throughput[i] * (emitted.radiance * weight),
            );
        }
    }
}

/// Light that a segment meets.
struct Emitted<C: Colour> {
    emitter: usize,
    radiance: C::Spectrum,
    /// The density with which next-event estimation draws the same direction once it has chosen that emitter.
    light_pdf: SolidAnglePdf,
}

/// From which sides the segments of a chunk see their surfaces.
struct SideChunk {
    direction: VectorLanes<CHUNK>,
    /// Between the direction to where the path comes from and the shading normal.
    cosine: [f32; CHUNK],
    /// The shading normal of the side that is seen.
    normal: VectorLanes<CHUNK>,
}

impl SideChunk {
    fn new() -> Self {
        Self {
            direction: VectorLanes::default(),
            cosine: [0.0; CHUNK],
            normal: VectorLanes::default(),
        }
    }

    /// `directions` are those of at most [`CHUNK`] segments, in world space.
    #[inline(always)]
    fn find(&mut self, directions: [&[f32]; 3], shading_normals: &VectorLanes<CHUNK>) {
        self.direction.load(directions);
        for lane in 0..CHUNK {
            let normal = shading_normals.get(lane);
            let cosine = -self.direction.get(lane).dot(normal);
            self.cosine[lane] = cosine;
            self.normal
                .put(lane, if cosine < 0.0 { -normal } else { normal });
        }
    }
}

impl Engine {
    /// The weight of what segment `i` found emitted.
    #[inline(always)]
    fn mis_weight<C: Colour>(
        &self,
        segments: &Segments<C>,
        i: usize,
        emitted: &Emitted<C>,
        knowledge: Option<&Knowledge>,
    ) -> f32 {
        let direction_pdf = segments.direction_pdf[i];
        if self.settings.direct_light == DirectLight::Off || direction_pdf.0 == f32::INFINITY {
            return 1.0;
        }
        let chosen_with = match segments.origins.get(i) {
            Some(origin) => {
                let weights = knowledge.map(|knowledge| knowledge.group_weights(origin.insight));
                self.light_choice
                    .probability(&origin.receiver, weights, emitted.emitter)
            }
            None => 1.0,
        };
        power_heuristic(
            direction_pdf,
            emitted
                .light_pdf
                .chosen_with(chosen_with)
                .taken_times(self.settings.samples.emitters as f32),
        )
    }
}
