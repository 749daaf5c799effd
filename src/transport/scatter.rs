//! Stage: children leave their parents in directions drawn from the bsdf.

use std::ops::Range;

use multiversion::multiversion;

use super::batch::{CameraPaths, Segments, Vertices};
use super::engine::Engine;
use super::guidance::{Guidance, SquarePlaces};
use super::lineage::Birth;
use super::offset::{leave_surface, leave_surface_by};
use super::variant::{Scattering, Variant, carries_points};
use crate::lanes::{CHUNK, KeptLanes, VectorColumn, VectorLanes, append_kept, copy_kept};
use crate::learning::Knowledge;
use crate::sampling::{Sampler, SequencePoint, SolidAnglePdf, Use};
use crate::scene::BsdfSamples;
use crate::spectrum::{Colour, SpectrumArithmetic};
use crate::walk::Child;

/// Starts one segment for every child that can carry light; siblings side by side.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
pub(super) fn scatter<C: Colour, V: Variant>(
    engine: &Engine,
    paths: &CameraPaths<C>,
    vertices: &Vertices<C, V>,
    children: &[Child],
    sampler: &mut Sampler,
    knowledge: Option<&Knowledge>,
    segments: &mut Segments<C>,
) {
    let depth = vertices.depth;
    segments.restart(depth + 1, children.len());
    let light_is_chosen = engine.light_choice.depends_on_surface();
    if light_is_chosen {
        segments.remember_origins(children.len());
    }
    let mut ranks = sampler.ranks();
    let carries_points = carries_points::<V>(sampler);
    let mut elders = ElderSiblings::default();
    let mut points = [SequencePoint::default(); CHUNK];
    let mut numbers = [[0.0; CHUNK]; 3];
    let mut normals = VectorLanes::default();
    let mut samples = BsdfSamples::new();
    let mut origins = VectorLanes::default();
    let mut clearances = [0.0; CHUNK];
    let mut guidance = Guidance::new();
    let mut places = SquarePlaces::default();
    let learns = !vertices.segment.is_empty();
    for children in children.chunks(CHUNK) {
        let run = run_of_parents(children);
        fetch(&vertices.normal, children, &run, &mut normals);
        if let Some(ranks) = &mut ranks {
            for (point, child) in points.iter_mut().zip(children) {
                *point = paths.rank(vertices.path[child.parent as usize], ranks);
            }
        } else if sampler.has_sequences() {
            for (point, child) in points.iter_mut().zip(children) {
                let parent = vertices.point[child.parent as usize];
                *point = parent.branch(elders.before(child), depth);
            }
        }
        let direction = Use::Direction(depth);
        if V::CHOOSES_LOBES {
            sampler.fill(&points, children.len(), direction, numbers.each_mut());
        } else {
            let [u, v, _] = &mut numbers;
            sampler.fill(&points, children.len(), direction, [u, v]);
        }
        let parents = children.iter().map(|child| child.parent as usize);
        let bsdfs = parents.clone().map(|parent| &vertices.bsdf[parent]);
        let is_guided = knowledge.is_some_and(|knowledge| {
            let insights = parents.clone().map(|parent| vertices.insight[parent]);
            guidance.ask(knowledge, bsdfs.clone().zip(insights))
        });
        let mut diffuse = [numbers[0], numbers[1]];
        if is_guided {
            guidance.warp(children.len(), &mut numbers, &mut diffuse);
        }
        V::Scattering::sample(bsdfs.clone(), &normals, &numbers, &diffuse, &mut samples);
        if is_guided {
            guidance.redirect(bsdfs.clone(), &normals, &diffuse, &mut samples);
        }
        if learns {
            places = SquarePlaces::of(&normals, &samples.direction);
        }
        fetch(vertices.geometric_normals(), children, &run, &mut normals);
        fetch(&vertices.position, children, &run, &mut origins);
        let clearances = vertices.clearances(parents, &mut clearances);
        for lane in 0..CHUNK {
            let (position, normal) = (origins.get(lane), normals.get(lane));
            let direction = samples.direction.get(lane);
            let origin = match clearances {
                None => leave_surface(position, normal, direction),
                Some(clearances) => leave_surface_by(clearances[lane], position, normal, direction),
            };
            origins.put(lane, origin);
        }

        let mut kept = KeptLanes::none();
        let mut throughputs = [C::Spectrum::ZERO; CHUNK];
        for (lane, child) in children.iter().enumerate() {
            let throughput =
                vertices.throughput[child.parent as usize] * samples.weight[lane] * child.weight;
            throughputs[lane] = throughput;
            kept.add_if(lane, !throughput.is_black());
        }
        append_rays(&kept, &origins, &samples.direction, segments);
        let lanes = kept.iter();
        let parent = |lane: usize| children[lane].parent as usize;
        segments
            .path
            .extend(lanes.clone().map(|lane| vertices.path[parent(lane)]));
        append_kept(&mut segments.throughput, &throughputs, &kept);
        if carries_points {
            let points = lanes.clone().map(|lane| points[lane]);
            segments.point.extend(points);
        }
        let pdfs = lanes.clone().map(|lane| {
            let expected = 1.0 / children[lane].weight;
            SolidAnglePdf(samples.pdf[lane]).taken_times(expected)
        });
        segments.direction_pdf.extend(pdfs);
        if learns {
            let birth = |lane: usize| {
                let parent = parent(lane);
                // Of light at the camera, the part that the child's own throughput has multiplied, and that of its parent.
                let expected = 1.0 / children[lane].weight;
                let reflected = vertices.throughput[parent] * vertices.bsdf[parent].albedo();
                Birth {
                    parent: vertices.segment[parent],
                    address: vertices.address[parent],
                    lobe: vertices.lobe(parent),
                    bin: places.bin(lane),
                    odds: guidance.odds(lane, &places, samples.pdf[lane]),
                    per_radiance: 1.0 / throughputs[lane].mean(),
                    per_value: expected / reflected.mean(),
                }
            };
            segments.births.extend(lanes.clone().map(birth));
        }
        if V::REFRACTS {
            let refraction = lanes.clone().map(|lane| samples.refraction[lane]);
            segments.refraction.extend(refraction);
        }
        if light_is_chosen {
            let origins = lanes.map(|lane| vertices.origin(parent(lane)));
            segments.origins.extend(origins);
        }
    }
    let count = segments.len();
    segments.rays.resize(count);
}

/// The parents of a chunk of children, where each of some neighbours has one child: nothing has been decided of them yet, or all
/// have been let live.
#[inline(always)]
fn run_of_parents(children: &[Child]) -> Option<Range<usize>> {
    let first = children.first()?.parent;
    let is_next = |is_run, (i, child): (usize, &Child)| is_run & (child.parent == first + i as u32);
    let is_run = children.iter().enumerate().fold(true, is_next);
    let start = first as usize;
    is_run.then_some(start..start + children.len())
}

/// Puts what `column` says of the parents of a chunk of children, perhaps a `run` of them, into the lanes of the children.
#[inline(always)]
fn fetch(
    column: &VectorColumn,
    children: &[Child],
    run: &Option<Range<usize>>,
    lanes: &mut VectorLanes<CHUNK>,
) {
    match run {
        Some(run) => lanes.load(column.slices(run.clone())),
        None => {
            for (lane, child) in children.iter().enumerate() {
                lanes.put(lane, column.get(child.parent as usize));
            }
        }
    }
}

/// Counts siblings, which stand side by side.
#[derive(Default)]
struct ElderSiblings {
    last: Option<Child>,
    count: u32,
}

impl ElderSiblings {
    /// How many siblings came before `child`, the one that follows the last that was asked for.
    #[inline(always)]
    fn before(&mut self, child: &Child) -> u32 {
        let is_sibling = self.last.is_some_and(|last| last.parent == child.parent);
        self.count = if is_sibling { self.count + 1 } else { 0 };
        self.last = Some(*child);
        self.count
    }
}

/// Appends the rays in the lanes `kept`, in world space, to those of `segments`.
#[inline(always)]
fn append_rays<C: Colour>(
    kept: &KeptLanes,
    origins: &VectorLanes<CHUNK>,
    directions: &VectorLanes<CHUNK>,
    segments: &mut Segments<C>,
) {
    let place = segments.len()..segments.len() + kept.len();
    let rays = segments.rays.as_mut();
    let columns = rays.origin.into_iter().chain(rays.direction);
    for (column, lanes) in columns.zip(origins.0.iter().chain(&directions.0)) {
        copy_kept(&mut column[place.clone()], lanes, kept);
    }
    rays.tnear[place.clone()].fill(0.0);
    rays.tfar[place].fill(f32::INFINITY);
}
