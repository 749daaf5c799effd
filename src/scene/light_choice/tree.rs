//! A binary tree of lights: the way down goes to either side in proportion to its importance.
//!
//! Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting" (without the splitting).

use glam::Vec3;

use super::ChosenLight;
use super::bounds::{LightBounds, LightSphere};

/// The tree of the lights that have a place.
#[derive(Clone, Debug)]
pub struct LightTree {
    /// The first is the root; the first child of an inner node is the next node.
    nodes: Vec<Node>,
    /// The way from the root to every emitter.
    ways: Vec<Option<Way>>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    lights: LightSphere,
    kind: Kind,
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Inner { second_child: u32 },
    Leaf { emitter: u32 },
}

/// Which child every node on the way to a leaf has, from the lowest bit on: 1 for the second.
#[derive(Clone, Copy, Debug, Default)]
struct Way {
    turns: u64,
    length: u32,
}

/// Below this depth nodes are split in the middle of their list, so that no way is longer than 64.
const BALANCED_DEPTH: u32 = 24;

/// A child whose light can arrive gets at least this probability: importances are guesses.
const LEAST_SHARE: f32 = 1e-3;

/// Groups that a split by cost chooses among, along each axis.
const BUCKETS: usize = 12;

/// A light on its way into the tree.
#[derive(Clone, Copy, Debug)]
pub struct PlacedLight {
    /// Its number among the scene's emitters.
    pub emitter: u32,
    /// Where it shines.
    pub bounds: LightBounds,
}

impl LightTree {
    /// The tree of `lights`; `None` if there are none.
    pub fn new(mut lights: Vec<PlacedLight>) -> Option<Self> {
        let emitters = lights
            .iter()
            .map(|light| light.emitter as usize + 1)
            .max()?;
        let mut tree = Self {
            nodes: Vec::with_capacity(2 * lights.len()),
            ways: vec![None; emitters],
        };
        tree.grow(&mut lights, Way::default());
        Some(tree)
    }

    /// Adds the subtree of `lights`, which are not empty, at the end of `way`.
    fn grow(&mut self, lights: &mut [PlacedLight], way: Way) -> LightBounds {
        let own = self.nodes.len();
        if let [light] = lights {
            self.nodes.push(Node {
                lights: LightSphere::from(&light.bounds),
                kind: Kind::Leaf {
                    emitter: light.emitter,
                },
            });
            self.ways[light.emitter as usize] = Some(way);
            return light.bounds;
        }
        let middle = split(lights, way.length);
        let (first, second) = lights.split_at_mut(middle);
        self.nodes.push(Node {
            lights: LightSphere::from(&first[0].bounds),
            kind: Kind::Inner { second_child: 0 },
        });
        let first = self.grow(first, way.turning(false));
        let second_child = self.nodes.len() as u32;
        let second = self.grow(second, way.turning(true));
        let bounds = first.union(&second);
        self.nodes[own] = Node {
            lights: LightSphere::from(&bounds),
            kind: Kind::Inner { second_child },
        };
        bounds
    }

    /// Chooses a light for a surface from `u` in [0, 1). `None` where no light can arrive.
    #[inline]
    pub fn choose(&self, position: Vec3, normal: Vec3, mut u: f32) -> Option<ChosenLight> {
        let (mut node, mut probability) = (0, 1.0);
        loop {
            match self.nodes[node].kind {
                Kind::Leaf { emitter } => {
                    return Some(ChosenLight {
                        emitter: emitter as usize,
                        probability,
                        remainder: u,
                    });
                }
                Kind::Inner { second_child } => {
                    let second_child = second_child as usize;
                    let first = self.share_of_first(node, second_child, position, normal)?;
                    if u < first {
                        u /= first;
                        probability *= first;
                        node += 1;
                    } else {
                        u = (u - first) / (1.0 - first);
                        probability *= 1.0 - first;
                        node = second_child;
                    }
                    u = u.min(1.0 - f32::EPSILON / 2.0);
                }
            }
        }
    }

    /// The probability with which [`Self::choose`] chooses an emitter.
    #[inline]
    pub fn probability(&self, position: Vec3, normal: Vec3, emitter: usize) -> f32 {
        let Some(&Some(Way { mut turns, .. })) = self.ways.get(emitter) else {
            return 0.0;
        };
        let (mut node, mut probability) = (0, 1.0);
        while let Kind::Inner { second_child } = self.nodes[node].kind {
            let second_child = second_child as usize;
            let Some(first) = self.share_of_first(node, second_child, position, normal) else {
                return 0.0;
            };
            if turns & 1 == 0 {
                probability *= first;
                node += 1;
            } else {
                probability *= 1.0 - first;
                node = second_child;
            }
            turns >>= 1;
        }
        probability
    }

    /// The probability of the first child of a node; `None` where none of its lights can arrive.
    #[inline]
    fn share_of_first(
        &self,
        node: usize,
        second_child: usize,
        position: Vec3,
        normal: Vec3,
    ) -> Option<f32> {
        let first = self.nodes[node + 1].lights.importance(position, normal);
        let second = self.nodes[second_child].lights.importance(position, normal);
        match (first > 0.0, second > 0.0) {
            (true, true) => Some((first / (first + second)).clamp(LEAST_SHARE, 1.0 - LEAST_SHARE)),
            (true, false) => Some(1.0),
            (false, true) => Some(0.0),
            (false, false) => None,
        }
    }
}

impl Way {
    fn turning(self, to_second: bool) -> Self {
        Self {
            turns: self.turns | u64::from(to_second) << self.length,
            length: self.length + 1,
        }
    }
}

/// Sorts `lights`, which are at least two, into two groups, and returns the size of the first.
fn split(lights: &mut [PlacedLight], depth: u32) -> usize {
    let half = lights.len() / 2;
    let centres = lights.iter().map(|light| light.bounds.centre());
    let (low, high) = centres.fold(
        (Vec3::INFINITY, Vec3::NEG_INFINITY),
        |(low, high), centre| (low.min(centre), high.max(centre)),
    );
    if depth >= BALANCED_DEPTH {
        return half;
    }
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in 0..3 {
        if high[axis] <= low[axis] {
            continue;
        }
        let mut buckets: [Option<LightBounds>; BUCKETS] = [None; BUCKETS];
        for light in lights.iter() {
            let bucket = &mut buckets[bucket(light, axis, low, high)];
            *bucket = Some(union(*bucket, Some(light.bounds)).unwrap_or(light.bounds));
        }
        for border in 1..BUCKETS {
            let group = |buckets: &[Option<LightBounds>]| buckets.iter().copied().fold(None, union);
            let groups = (group(&buckets[..border]), group(&buckets[border..]));
            let (Some(first), Some(second)) = groups else {
                continue;
            };
            let size = high - low;
            // Thin boxes are cut across.
            let regularity = size.max_element() / size[axis];
            let cost = regularity * (first.cost() + second.cost());
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, border));
            }
        }
    }
    let Some((_, axis, border)) = best else {
        return half;
    };
    // A stable partition: the tree depends on nothing but the lights and their order.
    lights.sort_by_key(|light| bucket(light, axis, low, high) >= border);
    lights.partition_point(|light| bucket(light, axis, low, high) < border)
}

/// The bucket of a light along an axis on which the centres reach from `low` to `high`.
fn bucket(light: &PlacedLight, axis: usize, low: Vec3, high: Vec3) -> usize {
    let share = (light.bounds.centre()[axis] - low[axis]) / (high[axis] - low[axis]);
    ((share * BUCKETS as f32) as usize).min(BUCKETS - 1)
}

fn union(first: Option<LightBounds>, second: Option<LightBounds>) -> Option<LightBounds> {
    match (first, second) {
        (Some(first), Some(second)) => Some(first.union(&second)),
        (first, second) => first.or(second),
    }
}
