//! Light drawn for many vertices at once.

use std::ops::Range;

use glam::Vec3;

use super::batch::{CameraPaths, Origin, Vertices};
use super::engine::Engine;
use super::offset::leave_surface;
use super::variant::{Scattering, Variant};
use crate::lanes::{CHUNK, KeptLanes, VectorLanes};
use crate::learning::Knowledge;
use crate::scene::{ChosenGroup, LightQuestion, LightSample, Parallelogram};
use crate::spectrum::{Colour, SpectrumArithmetic};

/// Light drawn for a chunk of vertices, one lane each.
///
/// Lamps are rectangles more often than anything else: those are drawn in one loop over lanes, all others one by one.
pub(super) struct LightChunk<C: Colour> {
    /// The emitter chosen.
    emitter: [u32; CHUNK],
    /// The probability of that choice; 0 where no light can arrive.
    pub probability: [f32; CHUNK],
    /// The group of emitters from which it was chosen; `None` where nothing is learned of groups, or no light can arrive.
    pub group: [Option<ChosenGroup>; CHUNK],
    lamps: LampLanes,
    /// Unit direction from the vertex to the light, in world space.
    pub direction: VectorLanes<CHUNK>,
    /// Distance in scene units; infinite for the surroundings.
    pub distance: [f32; CHUNK],
    /// Where shadow rays end, off the light's surface: it is not to be in its own way. Without meaning at infinite distance.
    pub target: VectorLanes<CHUNK>,
    /// The density of the direction over solid angle; infinite where only next-event estimation can find the light.
    pub pdf: [f32; CHUNK],
    /// Radiance over density, or what stands for it with a light that is a point.
    pub weight: [C::Spectrum; CHUNK],
}

/// No emitter.
const NOBODY: u32 = u32::MAX;

/// The rectangle that was chosen in each lane.
struct LampLanes {
    /// Which emitter it is; [`NOBODY`] where there is none yet.
    emitter: [u32; CHUNK],
    corner: VectorLanes<CHUNK>,
    first_edge: VectorLanes<CHUNK>,
    second_edge: VectorLanes<CHUNK>,
    normal: VectorLanes<CHUNK>,
    area: [f32; CHUNK],
    /// 1 / density where light leaves towards the vertex, otherwise 0.
    weight: [f32; CHUNK],
}

impl LampLanes {
    fn new() -> Self {
        Self {
            emitter: [NOBODY; CHUNK],
            corner: VectorLanes::default(),
            first_edge: VectorLanes::default(),
            second_edge: VectorLanes::default(),
            normal: VectorLanes::default(),
            area: [1.0; CHUNK],
            weight: [0.0; CHUNK],
        }
    }

    /// Puts emitter number `emitter`, a rectangle, into its lane.
    fn put(&mut self, lane: usize, emitter: u32, lamp: &Parallelogram) {
        self.emitter[lane] = emitter;
        self.corner.put(lane, lamp.corner.position);
        self.first_edge.put(lane, lamp.first_edge);
        self.second_edge.put(lane, lamp.second_edge);
        self.normal.put(lane, lamp.corner.geometric_normal);
        self.area[lane] = lamp.area;
    }
}

impl<C: Colour> LightChunk<C> {
    pub fn new() -> Self {
        Self {
            emitter: [0; CHUNK],
            probability: [1.0; CHUNK],
            group: [None; CHUNK],
            lamps: LampLanes::new(),
            direction: VectorLanes::default(),
            distance: [0.0; CHUNK],
            target: VectorLanes::default(),
            pdf: [0.0; CHUNK],
            weight: [C::Spectrum::ZERO; CHUNK],
        }
    }

    /// Chooses an emitter for every vertex of `chunk` from a uniform number in [0, 1) each, and by what is known of lights where directions are guided.
    #[inline(always)]
    pub fn choose<V: Variant>(
        &mut self,
        engine: &Engine,
        vertices: &Vertices<C, V>,
        chunk: Range<usize>,
        numbers: &[f32; CHUNK],
        knowledge: Option<&Knowledge>,
    ) {
        if let Some(only) = engine.light_choice.only() {
            self.emitter = [only as u32; CHUNK];
            self.probability = [1.0; CHUNK];
            return;
        }
        self.probability = [0.0; CHUNK];
        self.group = [None; CHUNK];
        let mut asking = KeptLanes::none();
        let mut questions = [LightQuestion::default(); CHUNK];
        for (lane, i) in chunk.enumerate() {
            let Origin { receiver, insight } = vertices.origin(i);
            questions[asking.len()] = LightQuestion {
                receiver,
                weights: knowledge.map(|knowledge| knowledge.group_weights(insight)),
                u: numbers[lane],
            };
            asking.add_if(lane, vertices.bsdf[i].has_smooth_lobe());
        }
        let mut chosen = [None; CHUNK];
        let chosen = &mut chosen[..asking.len()];
        engine
            .light_choice
            .choose(&questions[..asking.len()], chosen);
        for (lane, chosen) in asking.iter().zip(chosen) {
            if let Some(chosen) = chosen {
                self.emitter[lane] = chosen.emitter as u32;
                self.probability[lane] = chosen.probability;
                self.group[lane] = chosen.group;
            }
        }
    }

    /// Draws a point of the emitter chosen for each of the vertices `chunk`, whose positions are `positions`, from two uniform numbers in [0, 1) each.
    #[inline(always)]
    pub fn draw<V: Variant>(
        &mut self,
        engine: &Engine,
        paths: &CameraPaths<C>,
        vertices: &Vertices<C, V>,
        chunk: Range<usize>,
        positions: &VectorLanes<CHUNK>,
        [u, v]: [&[f32; CHUNK]; 2],
    ) {
        // With one lamp, what was chosen is what is there.
        if self.emitter != self.lamps.emitter {
            self.fetch_lamps(engine);
        }
        self.draw_lamps(positions, u, v);
        // With one emitter, what it is need not be asked for every vertex.
        let only = engine.light_choice.only();
        let has_only_lamp = only.is_some_and(|only| engine.lamp(only).is_some());
        let path = |lane: usize| vertices.path[chunk.start + lane] as usize;
        let (mut lamps, mut others) = (KeptLanes::none(), KeptLanes::none());
        for (lane, i) in chunk.clone().enumerate() {
            if !vertices.bsdf[i].has_smooth_lobe() {
                self.put(lane, positions.get(lane), None);
            } else if has_only_lamp {
                self.shine(engine, paths, path(lane), lane);
            } else {
                // Nobody can foresee who has chosen a lamp: each kind has a loop of its own.
                let is_lamp = engine.lamp(self.emitter[lane] as usize).is_some();
                lamps.add_if(lane, is_lamp);
                others.add_if(lane, !is_lamp);
            }
        }
        for lane in lamps.iter() {
            self.shine(engine, paths, path(lane), lane);
        }
        let (shapes, emitters) = (&engine.scene.shapes, &engine.scene.emitters);
        for lane in others.iter() {
            let emitter = &emitters[self.emitter[lane] as usize];
            let (position, u) = (positions.get(lane), [u[lane], v[lane]]);
            let wavelengths = &paths.wavelengths[path(lane)];
            let sample = emitter.sample::<C>(shapes, position, wavelengths, u);
            self.put(lane, position, sample.as_ref());
        }
    }

    /// Puts the light of the rectangle in a lane, as a path sees it, beside what was drawn of it.
    #[inline(always)]
    fn shine(&mut self, engine: &Engine, paths: &CameraPaths<C>, path: usize, lane: usize) {
        let emitter = self.emitter[lane] as usize;
        let radiance = engine.emission.radiance(paths, path, emitter);
        self.weight[lane] = radiance * self.lamps.weight[lane];
    }

    /// Puts the rectangles that were chosen into their lanes.
    fn fetch_lamps(&mut self, engine: &Engine) {
        for (lane, &emitter) in self.emitter.iter().enumerate() {
            if let Some(lamp) = engine.lamp(emitter as usize) {
                self.lamps.put(lane, emitter, lamp);
            }
        }
    }

    /// Draws a point of the rectangle in every lane.
    #[inline(always)]
    fn draw_lamps(&mut self, positions: &VectorLanes<CHUNK>, u: &[f32; CHUNK], v: &[f32; CHUNK]) {
        let lamps = &mut self.lamps;
        for i in 0..CHUNK {
            let normal = lamps.normal.get(i);
            let point = lamps.corner.get(i)
                + u[i] * lamps.first_edge.get(i)
                + v[i] * lamps.second_edge.get(i);
            let offset = point - positions.get(i);
            let distance = offset.length();
            let reciprocal = if distance > 0.0 { 1.0 / distance } else { 0.0 };
            let direction = offset * reciprocal;
            let cosine = -direction.dot(normal);
            let pdf = distance * distance / (lamps.area[i] * cosine);
            // A point seen from behind or edge-on, or one that coincides with the vertex, sends nothing.
            let sends = (pdf > 0.0) & (pdf < f32::INFINITY);
            lamps.weight[i] = if sends { 1.0 / pdf } else { 0.0 };
            self.pdf[i] = if sends { pdf } else { 1.0 };
            self.distance[i] = distance;
            self.direction.put(i, direction);
            self.target.put(i, leave_surface(point, normal, -direction));
        }
    }

    /// Puts what was drawn from `position` into its lane.
    fn put(&mut self, lane: usize, position: Vec3, sample: Option<&LightSample<C::Spectrum>>) {
        let Some(light) = sample else {
            self.weight[lane] = C::Spectrum::ZERO;
            self.pdf[lane] = 1.0;
            return;
        };
        let target = match &light.surface {
            Some(point) => leave_surface(point.position, point.geometric_normal, -light.direction),
            None => position + light.direction * light.distance,
        };
        self.direction.put(lane, light.direction);
        self.distance[lane] = light.distance;
        self.target.put(lane, target);
        self.pdf[lane] = light.pdf.map_or(f32::INFINITY, |pdf| pdf.0);
        self.weight[lane] = light.weight;
    }
}
