//! Which groups of lights send more to a place, or less, than is guessed of them.
//!
//! Of a group that is chosen with probability p where the guess is g, and a look at which is worth y, the light is an estimate y p with mean square
//! E[y^2 p^2]; that of the guess is g^2. The variance of one look is least where groups are chosen in proportion to the roots of the former. So
//! what is guessed is multiplied by the root of the quotient of both, each summed over all looks with weight 1 / p.

use serde::{Deserialize, Serialize};

use super::LightObservation;
use crate::scene::{GROUPS, GroupWeights};

/// How many looks of the family the sums of a place are filled up with, for each group.
const OF_FAMILY: f32 = 4.0;

/// How many average looks those of a family are filled up with.
const OF_MEAN: f32 = 4.0;

/// The weights of groups lie between this and its reciprocal.
const LEAST_WEIGHT: f32 = 0.125;

/// The sums of all looks at the lights of each group.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LightSums {
    count: [f32; GROUPS],
    /// Of y^2 p.
    square: [f32; GROUPS],
    /// Of g^2 / p.
    guess: [f32; GROUPS],
}

impl LightSums {
    pub(super) fn add(&mut self, other: &Self, share: f32) {
        for group in 0..GROUPS {
            self.count[group] += share * other.count[group];
            self.square[group] += share * other.square[group];
            self.guess[group] += share * other.guess[group];
        }
    }

    pub(super) fn observe(&mut self, look: &LightObservation) {
        let group = usize::from(look.group) % GROUPS;
        self.count[group] += 1.0;
        self.square[group] += look.value * look.value * look.chosen;
        self.guess[group] += look.guessed * look.guessed / look.chosen;
    }

    /// What these sums say, filled up with looks like those of the `family`.
    pub(super) fn weights(&self, family: &Self) -> GroupWeights {
        let total = |sums: &[f32; GROUPS]| sums.iter().sum::<f32>();
        let [count, square, guess] = [&family.count, &family.square, &family.guess].map(total);
        if !(square > 0.0 && guess > 0.0) {
            return GroupWeights::EQUAL;
        }
        let mean = square / guess;
        let per_look = guess / count;
        let mut weights = GroupWeights::EQUAL;
        for (group, weight) in weights.0.iter_mut().enumerate() {
            let quotient = |sums: &Self, fill: f32, prior: f32| {
                let fill = fill * per_look;
                (sums.square[group] + fill * prior) / (sums.guess[group] + fill)
            };
            let of_family = quotient(family, OF_MEAN, mean);
            let own = quotient(self, OF_FAMILY, of_family);
            *weight = (own / mean).sqrt().clamp(LEAST_WEIGHT, 1.0 / LEAST_WEIGHT);
        }
        weights
    }
}
