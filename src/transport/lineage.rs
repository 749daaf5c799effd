//! Who descends from whom, and what each brought back: what a batch observes while the render learns.

use super::batch::{CameraPaths, Segments};
use crate::learning::{Bin, LobeClass, Observation, Observations, Odds, PixelObservation};
use crate::room::{make_room, resize};
use crate::spectrum::{Colour, SpectrumArithmetic};

/// What a camera ray costs with what is done where it ends, where a bounce costs 1. It has neighbours that go its way, and nothing has to be scattered for it.
///
/// Both costs were chosen by the error of whole renders (`docs/tried.md`, "What rays cost").
const CAMERA_RAY_COST: f32 = 0.4;

/// What a shadow ray costs: it ends at the first thing that it meets, and nothing is done there.
const SHADOW_RAY_COST: f32 = 0.4;

/// How a segment left its vertex.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Birth {
    /// The segment that led to the vertex: its index in the generation before.
    pub parent: u32,
    /// The [address](crate::learning::Knowledge::address) of the vertex.
    pub address: u32,
    /// Where the lobes of its surface point, if it has any and counts are learned.
    pub lobe: Option<LobeClass>,
    /// The direction that it took, if it is one of those that are learned.
    pub bin: Option<Bin>,
    /// How likely that would have been with other shares of guided directions, where they are mixed with others.
    pub odds: Option<Odds>,
    /// What light at the camera is multiplied by to be the radiance that came along the segment.
    pub per_radiance: f32,
    /// What it is multiplied by to be the value of an [`Observation`].
    pub per_value: f32,
}

/// All segments of a batch that were scattered equally often.
#[derive(Default)]
pub(super) struct Generation {
    births: Vec<Birth>,
    /// The mean over wavelengths of what each brought to the camera.
    light: Vec<f32>,
    /// What each costs: itself, and shadow rays from its end.
    cost: Vec<f32>,
}

impl Generation {
    /// Segment number `segment` brought `light` to the camera.
    #[inline(always)]
    pub fn add<S: SpectrumArithmetic>(&mut self, segment: usize, light: S) {
        self.light[segment] += light.mean();
    }

    /// A shadow ray was traced from the end of segment number `segment`.
    #[inline(always)]
    pub fn count_shadow_ray(&mut self, segment: usize) {
        self.cost[segment] += SHADOW_RAY_COST;
    }
}

/// The generations of a batch, and what was observed in all batches of a tile.
#[derive(Default)]
pub(super) struct Lineage {
    generations: Vec<Generation>,
    /// How many of them are in use.
    depth: usize,
    /// What each segment of the first generation saw emitted, if that is set aside.
    seen: Vec<f32>,
    /// What was observed; pixels are numbered within the tile.
    pub observed: Observations,
}

impl Lineage {
    /// A new batch begins.
    pub fn restart(&mut self) {
        self.depth = 0;
        self.seen.clear();
    }

    /// The generation of `segments` begins.
    pub fn begin<C: Colour>(&mut self, segments: &Segments<C>) {
        if self.depth == self.generations.len() {
            self.generations.push(Generation::default());
        }
        let generation = &mut self.generations[self.depth];
        self.depth += 1;
        generation.births.clone_from(&segments.births);
        make_room(&mut generation.light, segments.len());
        generation.light.resize(segments.len(), 0.0);
        let cost = if self.depth == 1 {
            CAMERA_RAY_COST
        } else {
            1.0
        };
        make_room(&mut generation.cost, segments.len());
        generation.cost.resize(segments.len(), cost);
    }

    /// The generation that began last.
    pub fn youngest(&mut self) -> Option<&mut Generation> {
        self.generations[..self.depth].last_mut()
    }

    /// Sets aside what the first generation has brought so far, when that is what camera paths see emitted: it is not to count as noise.
    ///
    /// It depends on nothing but what a camera path starts with. Where sequences spread that evenly, the edge of a lamp is smooth long before anything else, however much
    /// single paths differ there.
    pub fn set_seen_aside(&mut self) {
        if let [first, ..] = &self.generations[..self.depth] {
            make_room(&mut self.seen, first.light.len());
            self.seen.extend_from_slice(&first.light);
        }
    }

    /// All light has arrived: every segment passes on to its parent what it and its descendants brought.
    ///
    /// A first generation has no parents: its births name the camera paths.
    pub fn conclude<C: Colour>(&mut self, paths: &CameraPaths<C>) {
        for depth in (1..self.depth).rev() {
            let (elders, youngest) = self.generations.split_at_mut(depth);
            let (elders, youngest) = (&mut elders[depth - 1], &youngest[0]);
            let brought = youngest
                .births
                .iter()
                .zip(&youngest.light)
                .zip(&youngest.cost);
            for ((birth, &light), &cost) in brought {
                self.observed.segments.push(Observation {
                    address: birth.address,
                    lobe: birth.lobe,
                    bin: birth.bin,
                    odds: birth.odds,
                    radiance: light * birth.per_radiance,
                    value: light * birth.per_value,
                    cost,
                });
                elders.light[birth.parent as usize] += light;
                elders.cost[birth.parent as usize] += cost;
            }
        }
        let pixels = &mut self.observed.pixels;
        let first_of_batch = pixels.len();
        pixels.extend(paths.pixels.clone().map(|pixel| PixelObservation {
            pixel,
            ..PixelObservation::default()
        }));
        let pixels = &mut pixels[first_of_batch..];
        if let Some(first) = self.generations[..self.depth].first() {
            let brought = first.births.iter().zip(&first.light).zip(&first.cost);
            let seen = self.seen.iter().copied().chain(std::iter::repeat(0.0));
            for (((birth, &light), &cost), seen) in brought.zip(seen) {
                let pixel = &mut pixels[paths.pixel(birth.parent) as usize];
                pixel.paths += 1;
                pixel.radiance += light;
                let noisy = light - seen;
                pixel.noisy += noisy;
                pixel.square += noisy * noisy;
                pixel.cost += cost;
            }
        }
    }
}

/// The births of camera paths: each names its own.
pub(super) fn first_births(births: &mut Vec<Birth>, paths: usize) {
    resize(births, paths);
    for (path, birth) in (0..).zip(births) {
        *birth = Birth {
            parent: path,
            ..Birth::default()
        };
    }
}

#[cfg(test)]
mod tests {
    use super::super::path_counts::PathCounts;
    use super::*;
    use crate::spectrum::{Rgb, Spectrum};

    /// Two paths of one pixel: one sees a lamp of radiance 10, to the other light of radiance 1 is reflected.
    fn observed(sets_aside: bool) -> PixelObservation {
        let mut paths = CameraPaths::<Rgb>::new();
        paths.restart(0..1, PathCounts::Even(2));
        let mut segments = Segments::<Rgb>::new();
        segments.restart(0, 2);
        first_births(&mut segments.births, 2);
        segments.path.extend([0, 1]);
        let mut lineage = Lineage::default();
        lineage.restart();
        lineage.begin(&segments);
        let add = |lineage: &mut Lineage, segment, light| {
            let youngest = lineage.youngest().expect("a generation has begun");
            youngest.add(segment, Spectrum([light; 3]));
        };
        add(&mut lineage, 0, 10.0);
        if sets_aside {
            lineage.set_seen_aside();
        }
        add(&mut lineage, 1, 1.0);
        lineage.conclude(&paths);
        lineage.observed.pixels[0]
    }

    #[test]
    fn bounces_cost_more_than_other_rays() {
        let mut paths = CameraPaths::<Rgb>::new();
        paths.restart(0..1, PathCounts::Even(1));
        let mut segments = Segments::<Rgb>::new();
        segments.restart(0, 1);
        first_births(&mut segments.births, 1);
        segments.path.push(0);
        let mut lineage = Lineage::default();
        lineage.restart();
        for _ in 0..2 {
            lineage.begin(&segments);
            let youngest = lineage.youngest().expect("a generation has begun");
            youngest.count_shadow_ray(0);
        }
        lineage.conclude(&paths);
        let bounce = 1.0 + SHADOW_RAY_COST;
        assert_eq!(lineage.observed.segments[0].cost, bounce);
        let camera_path = CAMERA_RAY_COST + SHADOW_RAY_COST + bounce;
        assert_eq!(lineage.observed.pixels[0].cost, camera_path);
    }

    #[test]
    fn what_is_seen_is_bright_but_no_noise_if_it_is_set_aside() {
        let all = observed(false);
        assert_eq!((all.radiance, all.noisy, all.square), (11.0, 11.0, 101.0));
        let aside = observed(true);
        assert_eq!(
            (aside.radiance, aside.noisy, aside.square),
            (11.0, 1.0, 1.0)
        );
        assert_eq!((aside.paths, aside.cost), (2, 2.0 * CAMERA_RAY_COST));
    }
}
