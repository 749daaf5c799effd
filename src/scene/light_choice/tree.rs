//! A tree of lights: the way down goes to each side in proportion to its importance.
//!
//! Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting" (without the splitting). Their tree is binary; here every node takes
//! the place of several of theirs and has up to [`WIDTH`] children, which are looked at together, as lanes.

use glam::Vec3;

use super::ChosenLight;
use super::bounds::LightBounds;
use super::importance::LightLanes;

/// The most children of a node.
const WIDTH: usize = 8;

/// The tree of the lights that have a place.
#[derive(Clone, Debug)]
pub struct LightTree {
    /// The first is the root.
    nodes: Vec<Node>,
    /// The way from the root to every emitter: which child to go to from each node.
    ways: Vec<Option<Vec<u8>>>,
}

#[derive(Clone, Debug)]
struct Node {
    lights: LightLanes<WIDTH>,
    children: [Child; WIDTH],
}

#[derive(Clone, Copy, Debug)]
enum Child {
    /// The lane is empty.
    None,
    Node(u32),
    Emitter(u32),
}

/// A binary tree of lights.
enum Branch {
    Leaf(PlacedLight),
    Inner(LightBounds, Box<[Branch; 2]>),
}

/// Below this depth binary branches are split in the middle of their list, so that no way is long.
const BALANCED_DEPTH: u32 = 24;

/// A child whose light can arrive gets at least this probability: importances are guesses.
const LEAST_SHARE: f32 = 1e-3;

/// The greatest number below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

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

impl Branch {
    /// The binary tree of `lights`, which are not empty, at this `depth`.
    fn grow(lights: &mut [PlacedLight], depth: u32) -> Self {
        if let [light] = lights {
            return Self::Leaf(*light);
        }
        let middle = split(lights, depth);
        let (first, second) = lights.split_at_mut(middle);
        let children = [Self::grow(first, depth + 1), Self::grow(second, depth + 1)];
        let [first, second] = &children;
        let bounds = first.bounds().union(second.bounds());
        Self::Inner(bounds, Box::new(children))
    }

    fn bounds(&self) -> &LightBounds {
        match self {
            Self::Leaf(light) => &light.bounds,
            Self::Inner(bounds, _) => bounds,
        }
    }

    /// What would be gained by looking at its children instead; nothing where it has none.
    fn cost(&self) -> Option<f32> {
        match self {
            Self::Leaf(_) => None,
            Self::Inner(bounds, _) => Some(bounds.cost()),
        }
    }

    /// At most [`WIDTH`] branches that are this one together: those that cost most have been opened.
    fn open(self) -> Vec<Self> {
        let mut branches = vec![self];
        while branches.len() < WIDTH {
            let costs = branches
                .iter()
                .enumerate()
                .filter_map(|(index, branch)| Some((index, branch.cost()?)));
            let Some((index, _)) = costs.max_by(|(_, one), (_, other)| one.total_cmp(other)) else {
                break;
            };
            if let Self::Inner(_, children) = branches.remove(index) {
                let [first, second] = *children;
                branches.insert(index, second);
                branches.insert(index, first);
            }
        }
        branches
    }
}

impl LightTree {
    /// The tree of `lights`; `None` if there are none.
    pub fn new(mut lights: Vec<PlacedLight>) -> Option<Self> {
        let emitters = lights
            .iter()
            .map(|light| light.emitter as usize + 1)
            .max()?;
        let mut tree = Self {
            nodes: Vec::new(),
            ways: vec![None; emitters],
        };
        tree.add(Branch::grow(&mut lights, 0), &mut Vec::new());
        Some(tree)
    }

    /// Adds the nodes of a branch at the end of `way`; returns the number of the first of them.
    fn add(&mut self, branch: Branch, way: &mut Vec<u8>) -> u32 {
        let own = self.nodes.len();
        self.nodes.push(Node {
            lights: LightLanes::none(),
            children: [Child::None; WIDTH],
        });
        for (lane, branch) in branch.open().into_iter().enumerate() {
            self.nodes[own].lights.put(lane, branch.bounds());
            way.push(lane as u8);
            self.nodes[own].children[lane] = match branch {
                Branch::Leaf(light) => {
                    self.ways[light.emitter as usize] = Some(way.clone());
                    Child::Emitter(light.emitter)
                }
                Branch::Inner(..) => Child::Node(self.add(branch, way)),
            };
            way.pop();
        }
        own as u32
    }

    /// Chooses a light for a surface from `u` in [0, 1). `None` where no light can arrive.
    #[inline(always)]
    pub fn choose(&self, position: Vec3, normal: Vec3, mut u: f32) -> Option<ChosenLight> {
        let (mut node, mut probability) = (&self.nodes[0], 1.0);
        loop {
            let shares = node.shares(position, normal)?;
            let (mut lane, mut before, mut end) = (0, 0.0, 0.0);
            for (child, &share) in shares.iter().enumerate() {
                // Of what rounding leaves beyond all shares, the last that has one gets the rest.
                let is_next = (share > 0.0) & (u >= end);
                lane = if is_next { child } else { lane };
                before = if is_next { end } else { before };
                end += share;
            }
            probability *= shares[lane];
            u = ((u - before) / shares[lane]).min(BELOW_ONE);
            match node.children[lane] {
                Child::Node(next) => node = &self.nodes[next as usize],
                Child::Emitter(emitter) => {
                    return Some(ChosenLight {
                        emitter: emitter as usize,
                        probability,
                        remainder: u,
                    });
                }
                Child::None => return None,
            }
        }
    }

    /// The probability with which [`Self::choose`] chooses an emitter.
    #[inline]
    pub fn probability(&self, position: Vec3, normal: Vec3, emitter: usize) -> f32 {
        let Some(Some(way)) = self.ways.get(emitter) else {
            return 0.0;
        };
        let (mut node, mut probability) = (&self.nodes[0], 1.0);
        for &lane in way {
            let Some(shares) = node.shares(position, normal) else {
                return 0.0;
            };
            probability *= shares[usize::from(lane)];
            if let Child::Node(next) = node.children[usize::from(lane)] {
                node = &self.nodes[next as usize];
            }
        }
        probability
    }
}

impl Node {
    /// The probabilities of the children; `None` where none of their lights can arrive.
    #[inline(always)]
    fn shares(&self, position: Vec3, normal: Vec3) -> Option<[f32; WIDTH]> {
        let mut shares = self.lights.importances(position, normal);
        // Of numbers up to 10^30 eight are no infinite sum.
        let sum: f32 = shares.iter().sum();
        let possible: f32 = shares
            .iter()
            .map(|&share| f32::from(u8::from(share > 0.0)))
            .sum();
        let per_importance = (1.0 - possible * LEAST_SHARE) / sum;
        for share in &mut shares {
            let mixed = *share * per_importance + LEAST_SHARE;
            *share = if *share > 0.0 { mixed } else { 0.0 };
        }
        (sum > 0.0).then_some(shares)
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
