//! A tree of lights: the way down goes to each side in proportion to its importance.
//!
//! Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting" (without the splitting). Their tree is binary; here every node takes
//! the place of several of theirs and has up to [`WIDTH`] children, which are looked at together, as lanes.

use super::branch::{Branch, PlacedLight};
use super::importance::LightLanes;
use super::{BELOW_ONE, Receiver};

/// The most children of a node.
pub const WIDTH: usize = 8;

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
    lights: NodeLights,
    children: [Child; WIDTH],
}

/// The lights of a node's children.
#[derive(Clone, Debug)]
#[expect(
    clippy::large_enum_variant,
    reason = "there is at most one node with one child"
)]
enum NodeLights {
    /// There is one child, and nothing to choose: a lamp beside a sky is as usual as anything.
    One(LightLanes<1>),
    Several(LightLanes<WIDTH>),
}

/// Lights of the tree.
#[derive(Clone, Copy, Debug)]
pub enum Child {
    /// The lane is empty: it has no power, and is never chosen.
    None,
    Node(u32),
    Emitter(u32),
}

/// A child whose light can arrive gets at least this probability: importances are guesses.
const LEAST_SHARE: f32 = 1e-3;

impl LightTree {
    /// All lights.
    pub const ROOT: Child = Child::Node(0);

    /// The tree of `lights`, whose root has at most `most` children; `None` if there are none.
    pub fn new(mut lights: Vec<PlacedLight>, most: usize) -> Option<Self> {
        let emitters = lights
            .iter()
            .map(|light| light.emitter as usize + 1)
            .max()?;
        let mut tree = Self {
            nodes: Vec::new(),
            ways: vec![None; emitters],
        };
        tree.add(Branch::grow(&mut lights, 0), most, &mut Vec::new());
        Some(tree)
    }

    /// Adds the nodes of a branch at the end of `way`; returns the number of the first of them.
    fn add(&mut self, branch: Branch, most: usize, way: &mut Vec<u8>) -> u32 {
        let own = self.nodes.len();
        let branches = branch.open(most);
        self.nodes.push(Node {
            lights: NodeLights::of(&branches),
            children: [Child::None; WIDTH],
        });
        for (lane, branch) in branches.into_iter().enumerate() {
            way.push(lane as u8);
            self.nodes[own].children[lane] = match branch {
                Branch::Leaf(light) => {
                    self.ways[light.emitter as usize] = Some(way.clone());
                    Child::Emitter(light.emitter)
                }
                Branch::Inner(..) => Child::Node(self.add(branch, WIDTH, way)),
            };
            way.pop();
        }
        own as u32
    }

    /// The probabilities of the children of the root; `None` where no light can arrive.
    #[inline(always)]
    pub fn root_shares(&self, receiver: &Receiver) -> Option<[f32; WIDTH]> {
        self.nodes[0].shares(receiver)
    }

    /// The lights in one of the `lanes` of the root.
    #[inline(always)]
    pub fn below_root(&self, lane: usize) -> Child {
        self.nodes[0].children[lane]
    }

    /// The ways to an emitter from the root: which child to go to from each node; `None` if it is not in the tree.
    #[inline(always)]
    pub fn way(&self, emitter: usize) -> Option<&[u8]> {
        self.ways.get(emitter)?.as_deref()
    }

    /// Goes down one node: to one of its children, for a surface.
    #[inline(always)]
    pub fn step(&self, descent: &mut Descent, receiver: &Receiver) {
        let Child::Node(node) = descent.child else {
            return;
        };
        let node = &self.nodes[node as usize];
        match &node.lights {
            NodeLights::One(light) => {
                descent.child = if can_arrive(light, receiver) {
                    node.children[0]
                } else {
                    Child::None
                };
            }
            NodeLights::Several(lights) => {
                let Some(shares) = shares(&lights.importances(receiver)) else {
                    descent.child = Child::None;
                    return;
                };
                let (lane, remainder) = pick(&shares, descent.u);
                *descent = Descent {
                    child: node.children[lane],
                    probability: descent.probability * shares[lane],
                    u: remainder,
                };
            }
        }
    }

    /// The probability with which [`Self::step`] comes to the end of the `way` from a `child`, which was itself chosen with that `probability`.
    #[inline(always)]
    pub fn probability(
        &self,
        mut child: Child,
        way: &[u8],
        mut probability: f32,
        receiver: &Receiver,
    ) -> f32 {
        for &lane in way {
            let Child::Node(node) = child else {
                return 0.0;
            };
            let node = &self.nodes[node as usize];
            let Some(shares) = node.shares(receiver) else {
                return 0.0;
            };
            probability *= shares[usize::from(lane)];
            child = node.children[usize::from(lane)];
        }
        probability
    }
}

/// A choice on its way down the tree.
#[derive(Clone, Copy, Debug)]
pub struct Descent {
    /// What was chosen so far.
    pub child: Child,
    /// The probability of that.
    pub probability: f32,
    /// What is left of the uniform number, itself uniform in [0, 1).
    pub u: f32,
}

impl Descent {
    /// Nothing can be chosen.
    pub const NONE: Self = Self {
        child: Child::None,
        probability: 0.0,
        u: 0.0,
    };

    /// Whether there are nodes to go down to.
    #[inline(always)]
    pub fn goes_on(&self) -> bool {
        matches!(self.child, Child::Node(_))
    }
}

/// The lane that `u`, uniform in [0, 1), picks with the probabilities `shares`, of which at least one is positive, and what is left of it.
#[inline(always)]
pub fn pick(shares: &[f32; WIDTH], u: f32) -> (usize, f32) {
    let (mut lane, mut before, mut end) = (0, 0.0, 0.0);
    for (child, &share) in shares.iter().enumerate() {
        // Of what rounding leaves beyond all shares, the last that has one gets the rest.
        let is_next = (share > 0.0) & (u >= end);
        lane = if is_next { child } else { lane };
        before = if is_next { end } else { before };
        end += share;
    }
    (lane, ((u - before) / shares[lane]).min(BELOW_ONE))
}

/// The sum of all lanes, in pairs: no addition waits for more than two others.
#[inline(always)]
pub fn sum(lanes: &[f32; WIDTH]) -> f32 {
    let [a, b, c, d, e, f, g, h] = lanes;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

impl NodeLights {
    fn of(branches: &[Branch]) -> Self {
        match branches {
            [one] => Self::One(lanes(std::slice::from_ref(one))),
            several => Self::Several(lanes(several)),
        }
    }
}

fn lanes<const N: usize>(branches: &[Branch]) -> LightLanes<N> {
    let mut lanes = LightLanes::none();
    for (lane, branch) in branches.iter().enumerate() {
        lanes.put(lane, branch.bounds());
    }
    lanes
}

impl Node {
    /// The probabilities of the children; `None` where none of their lights can arrive.
    #[inline(always)]
    fn shares(&self, receiver: &Receiver) -> Option<[f32; WIDTH]> {
        match &self.lights {
            NodeLights::One(light) => {
                let mut shares = [0.0; WIDTH];
                shares[0] = 1.0;
                can_arrive(light, receiver).then_some(shares)
            }
            NodeLights::Several(lights) => shares(&lights.importances(receiver)),
        }
    }
}

/// Whether anything can arrive from a light.
#[inline(always)]
fn can_arrive(light: &LightLanes<1>, receiver: &Receiver) -> bool {
    light.importances(receiver) > [0.0]
}

/// The probabilities of lights with these `importances`; `None` where all are 0.
#[inline(always)]
fn shares(importances: &[f32; WIDTH]) -> Option<[f32; WIDTH]> {
    let mut shares = *importances;
    // Of numbers up to 10^30 eight are no infinite sum.
    let total = sum(&shares);
    let possible = sum(&shares.map(|share| f32::from(u8::from(share > 0.0))));
    let per_importance = (1.0 - possible * LEAST_SHARE) / total;
    for share in &mut shares {
        let mixed = *share * per_importance + LEAST_SHARE;
        *share = if *share > 0.0 { mixed } else { 0.0 };
    }
    (total > 0.0).then_some(shares)
}
