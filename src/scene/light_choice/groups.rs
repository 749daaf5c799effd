//! Groups of lights, of which each is chosen by what is guessed of it and by what was learned where the surface is.

use serde::{Deserialize, Serialize};

use super::branch::PlacedLight;
use super::tree::{Leaf, LightTree, WIDTH, pick};
use super::{BELOW_ONE, ChosenLight, Receiver};

/// How many groups there are at the most: the children of the tree's root, and what is infinitely far away.
pub const GROUPS: usize = WIDTH;

/// The most groups of lights that are infinitely far away.
const DISTANT_GROUPS: usize = 4;

/// By how much the light of each group differs from what is guessed: positive factors, of which only the proportions matter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GroupWeights(pub [f32; GROUPS]);

impl GroupWeights {
    /// Nothing was learned.
    pub const EQUAL: Self = Self([1.0; GROUPS]);
}

/// A group as it was chosen for a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChosenGroup {
    /// Its number, below [`GROUPS`].
    pub number: u8,
    /// Its probability by what is guessed alone.
    pub guessed: f32,
    /// That with which it was chosen, positive.
    pub chosen: f32,
}

impl ChosenGroup {
    /// What is chosen where there is no choice.
    pub const ONLY: Self = Self {
        number: 0,
        guessed: 1.0,
        chosen: 1.0,
    };
}

/// All lights, in groups.
#[derive(Clone, Debug)]
pub struct LightGroups {
    tree: Option<LightTree>,
    /// Those that are infinitely far away: one group each, the last ones the last group together.
    distant: Vec<usize>,
    /// The first group of those.
    first_distant: usize,
    /// The probability of each of those, and of the tree, by what is guessed alone.
    each: f32,
    /// That of the groups of those.
    of_distant: [f32; GROUPS],
}

/// The probabilities of all groups for a surface.
struct Shares {
    /// By what is guessed alone; these add up to less than 1 where no light of the tree can arrive.
    guessed: [f32; GROUPS],
    /// Those that groups are chosen with.
    chosen: [f32; GROUPS],
}

impl LightGroups {
    /// The groups of `distant` emitters and of the `placed` ones; there is at least one.
    pub fn new(distant: Vec<usize>, placed: Vec<PlacedLight>) -> Self {
        let first_distant = GROUPS - distant.len().min(DISTANT_GROUPS);
        let tree = LightTree::new(placed, first_distant);
        let choices = distant.len() + usize::from(tree.is_some());
        let each = 1.0 / choices as f32;
        let mut of_distant = [0.0; GROUPS];
        for index in 0..distant.len() {
            of_distant[(first_distant + index).min(GROUPS - 1)] += each;
        }
        Self {
            tree,
            distant,
            first_distant,
            each,
            of_distant,
        }
    }

    /// The probabilities of the groups; `None` where no light can arrive.
    #[inline(always)]
    fn shares(&self, receiver: &Receiver, weights: &GroupWeights) -> Option<Shares> {
        let mut guessed = self.of_distant;
        if let Some(tree) = &self.tree
            && let Some(shares) = tree.root_shares(receiver)
        {
            for (guessed, share) in guessed.iter_mut().zip(shares) {
                *guessed += self.each * share;
            }
        }
        let mut chosen = guessed;
        for (share, weight) in chosen.iter_mut().zip(weights.0) {
            *share *= weight;
        }
        let sum: f32 = chosen.iter().sum();
        let per_sum = 1.0 / sum;
        for share in &mut chosen {
            *share *= per_sum;
        }
        (sum > 0.0).then_some(Shares { guessed, chosen })
    }

    /// See [`LightChoice::choose`](super::LightChoice::choose).
    #[inline(always)]
    pub fn choose(
        &self,
        receiver: &Receiver,
        weights: &GroupWeights,
        u: f32,
    ) -> Option<ChosenLight> {
        let shares = self.shares(receiver, weights)?;
        let (group, u) = pick(&shares.chosen, u);
        let of_group = shares.chosen[group];
        let leaf = if group >= self.first_distant {
            let lights = self.distant_group(group);
            let scaled = u * lights.len() as f32;
            let index = (scaled as usize).min(lights.len() - 1);
            Leaf {
                emitter: lights[index],
                probability: of_group / lights.len() as f32,
                remainder: (scaled - index as f32).min(BELOW_ONE),
            }
        } else {
            let tree = self.tree.as_ref()?;
            tree.choose_below(group, of_group, receiver, u)?
        };
        Some(ChosenLight {
            emitter: leaf.emitter,
            probability: leaf.probability,
            remainder: leaf.remainder,
            group: ChosenGroup {
                number: group as u8,
                guessed: shares.guessed[group],
                chosen: of_group,
            },
        })
    }

    /// The lights of a group of those that are infinitely far away.
    fn distant_group(&self, group: usize) -> &[usize] {
        let index = group - self.first_distant;
        if group == GROUPS - 1 {
            &self.distant[index..]
        } else {
            &self.distant[index..=index]
        }
    }

    /// See [`LightChoice::probability`](super::LightChoice::probability).
    #[inline]
    pub fn probability(&self, receiver: &Receiver, weights: &GroupWeights, emitter: usize) -> f32 {
        let Some(shares) = self.shares(receiver, weights) else {
            return 0.0;
        };
        if let Some(index) = self.distant.iter().position(|&light| light == emitter) {
            let group = (self.first_distant + index).min(GROUPS - 1);
            return shares.chosen[group] / self.distant_group(group).len() as f32;
        }
        let Some(tree) = &self.tree else {
            return 0.0;
        };
        tree.probability(&shares.chosen, receiver, emitter)
    }
}
