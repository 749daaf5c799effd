//! Stage: next-event estimation. Every vertex looks at one point of one emitter, or as many as the integrator says.

use glam::Vec3;
use multiversion::multiversion;

use super::batch::{CameraPaths, ShadowRays, Vertices};
use super::engine::Engine;
use super::guidance::Guidance;
use super::light_chunk::LightChunk;
use super::lineage::Lineage;
use super::offset::{leave_surface, leave_surface_by};
use super::variant::{Scattering, Variant};
use crate::lanes::{CHUNK, KeptLanes, VectorLanes, append_kept, copy_kept};
use crate::learning::{Knowledge, LightObservation};
use crate::sampling::{Sampler, SequencePoint, SolidAnglePdf, Use, power_heuristic};
use crate::scene::{BsdfValues, SurfaceSamples};
use crate::spectrum::{Colour, SpectrumArithmetic};
use crate::walk::ExpectedCount;

/// Shadow rays end this share of their length before the light, so that they do not meet it.
const SHADOW_END: f32 = 1.0 - 1e-4;

/// Draws light for every vertex and fills `shadow` with the rays that decide whether it arrives.
///
/// The emitter is chosen by what it can contribute, as far as that is guessed and, where directions are guided, known; a path's contribution is MIS-weighted
/// against hitting the same light by chance, with as many children as are `expected` of each vertex.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
pub(super) fn sample_lights<C: Colour, V: Variant>(
    engine: &Engine,
    paths: &CameraPaths<C>,
    vertices: &Vertices<C, V>,
    expected: &[ExpectedCount],
    sampler: &mut Sampler,
    knowledge: Option<&Knowledge>,
    shadow: &mut ShadowRays<C>,
) {
    let (samples, depth) = (engine.settings.samples, vertices.depth);
    let chooses_by_what_is_known = knowledge.is_some() && engine.light_choice.depends_on_surface();
    shadow.restart(vertices.len() * samples.emitters as usize);
    let mut numbers = [[0.0; CHUNK]; 3];
    let mut positions = VectorLanes::default();
    let mut normals = VectorLanes::default();
    let mut lights = LightChunk::<C>::new();
    let mut bsdfs = BsdfValues::new();
    let mut rays = ShadowChunk::new();
    let mut points = [SequencePoint::default(); CHUNK];
    let mut clearances = [0.0; CHUNK];
    let mut guidance = Guidance::new();
    let starts = (0..vertices.len()).step_by(CHUNK);
    for (sample, start) in (0..samples.emitters).flat_map(|s| starts.clone().map(move |i| (s, i))) {
        let chunk = start..vertices.len().min(start + CHUNK);
        if sampler.has_sequences() {
            for (point, vertex) in points.iter_mut().zip(&vertices.point[chunk.clone()]) {
                *point = vertex.branch(sample, depth);
            }
        }
        sampler.fill(&points, chunk.len(), Use::Light(depth), numbers.each_mut());
        positions.load(vertices.position.slices(chunk.clone()));
        let [choice, u, v] = &numbers;
        lights.choose(engine, vertices, chunk.clone(), choice, knowledge);
        lights.draw(engine, paths, vertices, chunk.clone(), &positions, [u, v]);
        normals.load(vertices.normal.slices(chunk.clone()));
        V::Scattering::evaluate(
            &vertices.bsdf[chunk.clone()],
            &normals,
            &lights.direction,
            &mut bsdfs,
        );
        if let Some(knowledge) = knowledge {
            let bsdfs_of_chunk = &vertices.bsdf[chunk.clone()];
            let insights = vertices.insight[chunk.clone()].iter().copied();
            if guidance.ask(knowledge, bsdfs_of_chunk.iter().zip(insights)) {
                guidance.mix(bsdfs_of_chunk, &normals, &lights.direction, &mut bsdfs);
            }
        }
        normals.load(vertices.geometric_normals().slices(chunk.clone()));
        let clearances = vertices.clearances(chunk.clone(), &mut clearances);
        rays.aim(&positions, &normals, clearances, &lights);
        let expected = &expected[chunk.clone()];
        rays.weigh(&lights, &bsdfs.pdf, expected, samples);

        let mut kept = KeptLanes::none();
        let mut contributions = [C::Spectrum::ZERO; CHUNK];
        for (lane, i) in chunk.clone().enumerate() {
            let contribution = vertices.throughput[i]
                * bsdfs.value[lane]
                * lights.weight[lane]
                * rays.weight[lane];
            contributions[lane] = contribution;
            // Where no light was drawn, the rest means nothing.
            kept.add_if(
                lane,
                !contribution.is_black() & !lights.weight[lane].is_black(),
            );
        }
        rays.append(&kept, shadow);
        if !vertices.segment.is_empty() {
            if chooses_by_what_is_known {
                let contributions = &contributions[..expected.len()];
                let looks = &mut shadow.looks;
                let numbers = note_looks(vertices, start, &lights, contributions, looks);
                shadow.look.extend(kept.iter().map(|lane| numbers[lane]));
            }
            let segments = kept.iter().map(|lane| vertices.segment[start + lane]);
            shadow.segment.extend(segments);
        }
        append_kept(&mut shadow.path, &vertices.path[chunk], &kept);
        append_kept(&mut shadow.contribution, &contributions, &kept);
    }
    shadow.rays.resize(shadow.path.len());
}

/// The shadow rays of a chunk of vertices, in world space.
struct ShadowChunk {
    origin: VectorLanes<CHUNK>,
    direction: VectorLanes<CHUNK>,
    far: [f32; CHUNK],
    /// The MIS weight over the number of lights drawn and the probability with which the emitter was chosen.
    weight: [f32; CHUNK],
}

impl ShadowChunk {
    fn new() -> Self {
        Self {
            origin: VectorLanes::default(),
            direction: VectorLanes::default(),
            far: [0.0; CHUNK],
            weight: [0.0; CHUNK],
        }
    }

    /// From the vertices at `positions`, with unit geometric `normals` and perhaps `clearances`, to the light that was drawn for them.
    ///
    /// A ray ends off the light's surface, as it starts off its own: a light that is curved, or that lights itself, would
    /// otherwise be in its own way where the ray grazes it.
    #[inline(always)]
    fn aim<C: Colour>(
        &mut self,
        positions: &VectorLanes<CHUNK>,
        normals: &VectorLanes<CHUNK>,
        clearances: Option<&[f32; CHUNK]>,
        lights: &LightChunk<C>,
    ) {
        for i in 0..CHUNK {
            let direction = lights.direction.get(i);
            let (position, normal) = (positions.get(i), normals.get(i));
            let origin = match clearances {
                None => leave_surface(position, normal, direction),
                Some(clearances) => leave_surface_by(clearances[i], position, normal, direction),
            };
            let offset = lights.target.get(i) - origin;
            let length = offset.length();
            let is_near = (lights.distance[i] < f32::INFINITY) & (length > 0.0);
            let reciprocal = 1.0 / length;
            let choose = |near: f32, other: f32| if is_near { near } else { other };
            self.direction.put(
                i,
                Vec3::new(
                    choose(offset.x * reciprocal, direction.x),
                    choose(offset.y * reciprocal, direction.y),
                    choose(offset.z * reciprocal, direction.z),
                ),
            );
            let end = if lights.distance[i] < f32::INFINITY {
                length * SHADOW_END
            } else {
                f32::INFINITY
            };
            self.far[i] = end;
            self.origin.put(i, origin);
        }
    }

    /// Weighs the `lights` that were drawn, where the bsdf would have drawn their directions with `bsdf_pdf` for each of the children that are `expected`.
    #[inline(always)]
    fn weigh<C: Colour>(
        &mut self,
        lights: &LightChunk<C>,
        bsdf_pdf: &[f32; CHUNK],
        expected: &[ExpectedCount],
        samples: SurfaceSamples,
    ) {
        let mut children = [0.0; CHUNK];
        for (children, expected) in children.iter_mut().zip(expected) {
            *children = expected.as_f32() * samples.directions as f32;
        }
        let emitters = samples.emitters as f32;
        for i in 0..CHUNK {
            let probability = lights.probability[i];
            let light_pdf = SolidAnglePdf(lights.pdf[i])
                .chosen_with(probability)
                .taken_times(emitters);
            let bsdf_pdf = SolidAnglePdf(bsdf_pdf[i]).taken_times(children[i]);
            let weight = power_heuristic(light_pdf, bsdf_pdf) / (emitters * probability);
            self.weight[i] = if probability > 0.0 { weight } else { 0.0 };
        }
    }

    /// Appends the rays in the lanes `kept` to those of `shadow`.
    #[inline(always)]
    fn append<C: Colour>(&self, kept: &KeptLanes, shadow: &mut ShadowRays<C>) {
        let start = shadow.path.len();
        let rays = shadow.rays.as_mut();
        let place = start..start + kept.len();
        let columns = rays.origin.into_iter().chain(rays.direction);
        for (column, lanes) in columns.zip(self.origin.0.iter().chain(&self.direction.0)) {
            copy_kept(&mut column[place.clone()], lanes, kept);
        }
        rays.tnear[place.clone()].fill(0.0);
        copy_kept(&mut rays.tfar[place], &self.far, kept);
    }
}

/// Adds what each light drawn for the vertices from number `start` on contributes, if nothing is in its way, to the `looks`; returns the numbers of these, lane by
/// lane, which mean nothing where there is none.
#[inline(always)]
fn note_looks<C: Colour, V: Variant>(
    vertices: &Vertices<C, V>,
    start: usize,
    lights: &LightChunk<C>,
    contributions: &[C::Spectrum],
    looks: &mut Vec<LightObservation>,
) -> [u32; CHUNK] {
    let mut numbers = [0; CHUNK];
    for (lane, contribution) in contributions.iter().enumerate() {
        if let Some(group) = lights.group[lane] {
            let vertex = start + lane;
            let reflected = vertices.throughput[vertex] * vertices.bsdf[vertex].albedo();
            numbers[lane] = looks.len() as u32;
            looks.push(LightObservation {
                address: vertices.address[vertex],
                group,
                value: contribution.mean() / reflected.mean(),
            });
        }
    }
    numbers
}

/// Adds what the unoccluded shadow rays carry.
pub(super) fn add_unoccluded<C: Colour>(
    shadow: &ShadowRays<C>,
    paths: &mut CameraPaths<C>,
    lineage: Option<&mut Lineage>,
) {
    if let Some(lineage) = lineage {
        let looks = &mut lineage.observed.lights;
        let first = looks.len();
        looks.extend_from_slice(&shadow.looks);
        for (i, &look) in shadow.look.iter().enumerate() {
            if shadow.rays.occluded(i) {
                looks[first + look as usize].value = 0.0;
            }
        }
        if let Some(generation) = lineage.youngest() {
            for (i, &segment) in shadow.segment.iter().enumerate() {
                generation.count_shadow_ray(segment as usize);
                if !shadow.rays.occluded(i) {
                    generation.add(segment as usize, shadow.contribution[i]);
                }
            }
        }
    }
    for i in 0..shadow.path.len() {
        if !shadow.rays.occluded(i) {
            paths.radiance[shadow.path[i] as usize] += shadow.contribution[i];
        }
    }
}
