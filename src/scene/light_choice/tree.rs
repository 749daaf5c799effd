//! A tree of lights: the way down goes to each side in proportion to its importance.
//!
//! Conty Estevez and Kulla 2018, "Importance Sampling of Many Lights with Adaptive Tree Splitting" (without the splitting). Their tree is binary; here every node takes
//! the place of several of theirs and has up to [`WIDTH`] children, which are looked at together, as lanes.

use super::branch::{Branch, PlacedLight};
use super::importance::LightLanes;
use super::{BELOW_ONE, ChosenLight, Receiver};

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
    /// The lane is empty: it has no power, and is never chosen.
    None,
    Node(u32),
    Emitter(u32),
}

/// A child whose light can arrive gets at least this probability: importances are guesses.
const LEAST_SHARE: f32 = 1e-3;

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
        for (lane, branch) in branch.open(WIDTH).into_iter().enumerate() {
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
    pub fn choose(&self, receiver: &Receiver, mut u: f32) -> Option<ChosenLight> {
        let (mut node, mut probability) = (&self.nodes[0], 1.0);
        loop {
            let shares = node.shares(receiver)?;
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
    pub fn probability(&self, receiver: &Receiver, emitter: usize) -> f32 {
        let Some(Some(way)) = self.ways.get(emitter) else {
            return 0.0;
        };
        let (mut node, mut probability) = (&self.nodes[0], 1.0);
        for &lane in way {
            let Some(shares) = node.shares(receiver) else {
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
    fn shares(&self, receiver: &Receiver) -> Option<[f32; WIDTH]> {
        let mut shares = self.lights.importances(receiver);
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
