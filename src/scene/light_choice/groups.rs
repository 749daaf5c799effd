//! Groups of lights, of which each is chosen by what is guessed of it and by what was learned where the surface is.

use serde::{Deserialize, Serialize};

use super::branch::PlacedLight;
use super::tree::{Child, Descent, LightTree, WIDTH, pick, sum};
use super::{BELOW_ONE, ChosenLight, LightQuestion, Receiver};
use crate::lanes::{CHUNK, KeptLanes};

/// How many groups there are at the most: the children of the tree's root, and what is infinitely far away.
pub const GROUPS: usize = WIDTH;

/// The most groups of lights that are infinitely far away.
const DISTANT_GROUPS: usize = 4;

/// By how much the light of each group differs from what is guessed: positive factors, of which only the proportions matter.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[repr(align(32))]
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

/// All lights, in groups.
#[derive(Clone, Debug)]
pub struct LightGroups {
    tree: Option<LightTree>,
    /// Those that are infinitely far away: one group each, the last ones the last group together.
    distant: Vec<u32>,
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
    pub fn new(distant: Vec<u32>, placed: Vec<PlacedLight>) -> Self {
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
        let total = sum(&chosen);
        let per_sum = 1.0 / total;
        for share in &mut chosen {
            *share *= per_sum;
        }
        (total > 0.0).then_some(Shares { guessed, chosen })
    }

    /// See [`LightChoice::choose`](super::LightChoice::choose), for at most [`CHUNK`] surfaces.
    ///
    /// All go down the tree side by side, node by node: how many nodes each has to go is not foreseen, but no other waits for it.
    #[inline(always)]
    pub fn choose(&self, questions: &[LightQuestion<'_>], chosen: &mut [Option<ChosenLight>]) {
        let mut descents = [Descent::NONE; CHUNK];
        let mut groups = [None; CHUNK];
        for (i, question) in questions.iter().enumerate() {
            match question.weights {
                Some(weights) => {
                    (descents[i], groups[i]) = self.enter_weighed(question, weights);
                }
                None => descents[i] = self.enter(question.u),
            }
        }
        if let Some(tree) = &self.tree {
            let mut going = KeptLanes::none();
            for (i, descent) in descents[..questions.len()].iter().enumerate() {
                going.add_if(i, descent.goes_on());
            }
            while going.len() > 0 {
                let mut left = KeptLanes::none();
                for i in going.iter() {
                    tree.step(&mut descents[i], &questions[i].receiver);
                    left.add_if(i, descents[i].goes_on());
                }
                going = left;
            }
        }
        for (i, chosen) in chosen.iter_mut().enumerate() {
            let descent = descents[i];
            *chosen = match descent.child {
                Child::Emitter(emitter) => Some(ChosenLight {
                    emitter: emitter as usize,
                    probability: descent.probability,
                    remainder: descent.u,
                    group: groups[i],
                }),
                _ => None,
            };
        }
    }

    /// Chooses by what is guessed alone; the tree need not be asked for that.
    #[inline(always)]
    fn enter(&self, u: f32) -> Descent {
        let choices = self.distant.len() + usize::from(self.tree.is_some());
        let (index, u) = pick_evenly(choices, u);
        let distant = self.distant.get(index);
        Descent {
            child: distant.map_or(LightTree::ROOT, |&light| Child::Emitter(light)),
            probability: self.each,
            u,
        }
    }

    /// Chooses a group by what is guessed and learned.
    #[inline(always)]
    fn enter_weighed(
        &self,
        question: &LightQuestion<'_>,
        weights: &GroupWeights,
    ) -> (Descent, Option<ChosenGroup>) {
        let Some(shares) = self.shares(&question.receiver, weights) else {
            return (Descent::NONE, None);
        };
        let (number, u) = pick(&shares.chosen, question.u);
        let group = ChosenGroup {
            number: number as u8,
            guessed: shares.guessed[number],
            chosen: shares.chosen[number],
        };
        let descent = match &self.tree {
            Some(tree) if number < self.first_distant => Descent {
                child: tree.below_root(number),
                probability: group.chosen,
                u,
            },
            _ => {
                let lights = self.distant_group(number);
                let (index, u) = pick_evenly(lights.len(), u);
                Descent {
                    child: Child::Emitter(lights[index]),
                    probability: group.chosen / lights.len() as f32,
                    u,
                }
            }
        };
        (descent, Some(group))
    }

    /// The lights of a group of those that are infinitely far away.
    fn distant_group(&self, group: usize) -> &[u32] {
        let index = group - self.first_distant;
        if group == GROUPS - 1 {
            &self.distant[index..]
        } else {
            &self.distant[index..=index]
        }
    }

    /// See [`LightChoice::probability`](super::LightChoice::probability).
    #[inline(always)]
    pub fn probability(
        &self,
        receiver: &Receiver,
        weights: Option<&GroupWeights>,
        emitter: usize,
    ) -> f32 {
        let shares = match weights.map(|weights| self.shares(receiver, weights)) {
            Some(None) => return 0.0,
            Some(Some(shares)) => Some(shares.chosen),
            None => None,
        };
        let way = self
            .tree
            .as_ref()
            .and_then(|tree| Some((tree, tree.way(emitter)?)));
        match (way, shares) {
            (Some((tree, way)), None) => {
                tree.probability(LightTree::ROOT, way, self.each, receiver)
            }
            (Some((tree, [first, way @ ..])), Some(shares)) => {
                let first = usize::from(*first);
                tree.probability(tree.below_root(first), way, shares[first], receiver)
            }
            _ => self.distant_probability(emitter, shares.as_ref()),
        }
    }

    /// The same for what is not in the tree.
    fn distant_probability(&self, emitter: usize, shares: Option<&[f32; GROUPS]>) -> f32 {
        let Some(index) = self
            .distant
            .iter()
            .position(|&light| light as usize == emitter)
        else {
            return 0.0;
        };
        let group = (self.first_distant + index).min(GROUPS - 1);
        let in_group =
            |shares: &[f32; GROUPS]| shares[group] / self.distant_group(group).len() as f32;
        shares.map_or(self.each, in_group)
    }
}

/// One of `count` things, all of which are as likely, by `u`, uniform in [0, 1), and what is left of that.
#[inline(always)]
fn pick_evenly(count: usize, u: f32) -> (usize, f32) {
    let scaled = u * count as f32;
    let index = (scaled as usize).min(count - 1);
    (index, (scaled - index as f32).min(BELOW_ONE))
}
