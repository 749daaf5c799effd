//! Which groups of lights send more to a place, or less, than is guessed of them.
//!
//! Of a group that is chosen with probability p where the guess is g, and a look at which is worth y, the light is an estimate y p with mean square
//! E[y^2 p^2]; that of the guess is g^2. The variance of one look is least where groups are chosen in proportion to the roots of the former. So
//! what is guessed is multiplied by the root of the quotient of both, each summed over all looks with weight 1 / p.

use serde::{Deserialize, Serialize};

use super::LightObservation;
use crate::scene::{ChosenGroup, GROUPS, GroupWeights};

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
        let ChosenGroup {
            number,
            guessed,
            chosen,
        } = look.group;
        let group = usize::from(number);
        self.count[group] += 1.0;
        self.square[group] += look.value * look.value * chosen;
        self.guess[group] += guessed * guessed / chosen;
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

#[cfg(test)]
mod tests {
    use super::*;

    /// `count` looks at a group of which `guessed` is guessed, each of which finds the same `light`, chosen with probability `chosen`.
    fn look(sums: &mut LightSums, number: u8, light: f32, [guessed, chosen]: [f32; 2], count: u32) {
        let group = ChosenGroup {
            number,
            guessed,
            chosen,
        };
        for _ in 0..count {
            sums.observe(&LightObservation {
                address: 0,
                group,
                value: light / chosen,
            });
        }
    }

    /// The weight of each group times what is guessed of it, in proportion to the first.
    fn proportions(sums: &LightSums, guessed: &[f32]) -> Vec<f32> {
        let GroupWeights(weights) = sums.weights(sums);
        let weighed = weights.iter().zip(guessed);
        let weighed: Vec<f32> = weighed.map(|(weight, guess)| weight * guess).collect();
        weighed.iter().map(|share| share / weighed[0]).collect()
    }

    #[test]
    fn without_looks_all_groups_weigh_the_same() {
        let nothing = LightSums::default();
        assert_eq!(nothing.weights(&nothing), GroupWeights::EQUAL);
        let mut dark = LightSums::default();
        look(&mut dark, 3, 0.0, [0.5, 0.5], 100);
        assert_eq!(dark.weights(&dark), GroupWeights::EQUAL);
    }

    /// Groups are to be chosen in proportion to the light that they send, however they were chosen so far.
    #[test]
    fn lights_that_are_known_are_chosen_in_proportion_to_their_light() {
        for chosen in [[0.2, 0.3, 0.5], [0.6, 0.3, 0.1]] {
            let guessed = [0.25, 0.25, 0.5];
            let mut sums = LightSums::default();
            for (number, light) in [1.0, 3.0, 2.0].into_iter().enumerate() {
                let probabilities = [guessed[number], chosen[number]];
                // As often as they are chosen.
                let count = (20_000.0 * chosen[number]) as u32;
                look(&mut sums, number as u8, light, probabilities, count);
            }
            let found = proportions(&sums, &guessed);
            for (found, light) in found.into_iter().zip([1.0, 3.0, 2.0]) {
                assert!((found / light - 1.0).abs() < 0.01, "{found}, {light}");
            }
        }
    }

    /// What is seen half of the time is chosen in proportion to the root of its mean square.
    #[test]
    fn lights_that_are_seen_at_times_are_chosen_by_their_mean_square() {
        let mut sums = LightSums::default();
        let even = [0.5, 0.5];
        look(&mut sums, 0, 1.0, even, 10_000);
        look(&mut sums, 1, 1.0, even, 5000);
        look(&mut sums, 1, 0.0, even, 5000);
        let found = proportions(&sums, &even);
        assert!((found[1] - 0.5_f32.sqrt()).abs() < 0.01, "{found:?}");
    }

    /// A group is never given up for good, and one that was hardly looked at is as bright as all are.
    #[test]
    fn weights_have_bounds_and_begin_with_the_mean() {
        let mut sums = LightSums::default();
        let even = [0.5, 0.5];
        look(&mut sums, 0, 0.0, even, 100_000);
        look(&mut sums, 1, 1.0, even, 100_000);
        let GroupWeights(weights) = sums.weights(&sums);
        assert_eq!(weights[0], LEAST_WEIGHT);
        assert!((weights[1] - 2.0_f32.sqrt()).abs() < 0.01, "{weights:?}");
        assert_eq!(weights[2..], [1.0; GROUPS - 2]);
    }

    /// A place of which little is known is taken to be like its family.
    #[test]
    fn a_place_is_filled_up_with_its_family() {
        let even = [0.5, 0.5];
        let mut family = LightSums::default();
        look(&mut family, 0, 1.0, even, 10_000);
        look(&mut family, 1, 3.0, even, 10_000);
        let ratio = |looks| {
            let mut own = LightSums::default();
            look(&mut own, 0, 3.0, even, looks);
            look(&mut own, 1, 1.0, even, looks);
            let GroupWeights(weights) = own.weights(&family);
            weights[0] / weights[1]
        };
        assert!((ratio(0) - 1.0 / 3.0).abs() < 0.01);
        // Four looks of its own weigh as much as the family: both groups have brought the same.
        assert!((ratio(OF_FAMILY as u32) - 1.0).abs() < 0.01);
        assert!((ratio(100_000) - 3.0).abs() < 0.01);
    }
}
