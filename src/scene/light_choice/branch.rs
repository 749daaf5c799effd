//! Which lights stand together: a binary tree, split so that both halves cost least (Conty Estevez and Kulla 2018, section 4.4).

use glam::Vec3;

use super::bounds::LightBounds;

/// Below this depth binary branches are split in the middle of their list, so that no way is long.
const BALANCED_DEPTH: u32 = 24;

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

/// A binary tree of lights.
pub enum Branch {
    /// One light.
    Leaf(PlacedLight),
    /// The bounds of all lights, and both groups of them.
    Inner(LightBounds, Box<[Branch; 2]>),
}

impl Branch {
    /// The binary tree of `lights`, which are not empty, at this `depth`.
    pub fn grow(lights: &mut [PlacedLight], depth: u32) -> Self {
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

    /// The bounds of all its lights.
    pub fn bounds(&self) -> &LightBounds {
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

    /// `most` branches or fewer that are this one together: those that cost most have been opened.
    pub fn open(self, most: usize) -> Vec<Self> {
        let mut branches = vec![self];
        while branches.len() < most {
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
