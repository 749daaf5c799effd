//! Points of an Owen-scrambled Sobol sequence, any number of them in any number of dimensions.
//!
//! The points are those of Burley, "Practical Hash-based Owen Scrambling" (JCGT 9(4), 2020). The table behind them ends after 2^16
//! points and 256 dimensions; beyond, another scramble begins, which is as unbiased and only less well spread.

use sobol_burley::{NUM_DIMENSION_SETS_4D, sample, sample_4d};

/// The bits of an index that the sequence has.
const INDEX_BITS: u32 = 16;

/// The random bits of a coordinate.
pub const COORDINATE_BITS: u32 = 23;

/// A point of a scrambled sequence. Points of one scramble are spread evenly in all dimensions together; those of
/// different scrambles know nothing of each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SequencePoint {
    scramble: u32,
    index: u32,
}

impl SequencePoint {
    /// Point number `index` of the sequence of a scramble.
    #[inline(always)]
    pub fn new(scramble: u32, index: u64) -> Self {
        Self {
            scramble: hash(scramble, (index >> INDEX_BITS) as u32),
            index: index as u32 & ((1 << INDEX_BITS) - 1),
        }
    }

    /// The point for child number `child` (from 0) of the particle that has this one, after its reflection number `depth`.
    ///
    /// The first child goes on with its parent's sequence. The others would be copies of it, so they get sequences of
    /// their own, in which those of all samples of a pixel are spread evenly again.
    #[inline]
    pub fn branch(self, child: u32, depth: u32) -> Self {
        if child == 0 {
            return self;
        }
        Self {
            scramble: hash(hash(self.scramble, depth), child),
            ..self
        }
    }

    /// The point of this rank in the lattices of a scramble (see `lattice.rs`).
    #[inline]
    pub fn ranked(scramble: u32, rank: u32) -> Self {
        Self {
            scramble,
            index: rank,
        }
    }

    /// The point of the rank that follows.
    #[inline(always)]
    pub(super) fn successor(self) -> Self {
        Self {
            index: self.index.wrapping_add(1),
            ..self
        }
    }

    #[inline(always)]
    pub(super) fn scramble(self) -> u32 {
        self.scramble
    }

    #[inline(always)]
    pub(super) fn index(self) -> u32 {
        self.index
    }

    /// Four coordinates in \[0, 1), with `COORDINATE_BITS` bits each: dimensions 4 `set` to 4 `set` + 3.
    #[inline]
    pub fn coordinates(self, set: u32) -> [f32; 4] {
        let (set, scramble) = self.within_table(set);
        sample_4d(self.index, set, scramble)
    }

    /// One of the [`coordinates`](Self::coordinates) alone: number `which` (from 0 to 3) of `set`.
    #[inline]
    pub fn coordinate(self, set: u32, which: u32) -> f32 {
        let (set, scramble) = self.within_table(set);
        sample(self.index, 4 * set + which, scramble)
    }

    #[inline]
    fn within_table(self, set: u32) -> (u32, u32) {
        if set < NUM_DIMENSION_SETS_4D {
            (set, self.scramble)
        } else {
            let (repetition, set) = (set / NUM_DIMENSION_SETS_4D, set % NUM_DIMENSION_SETS_4D);
            (set, hash(self.scramble, repetition))
        }
    }
}

/// The scramble that the words of `key` name for a `pixel`.
pub(super) fn scramble(key: [u32; 4], pixel: u32) -> u32 {
    key.into_iter().chain([pixel]).fold(0, hash)
}

/// Mixes `word` into `state`: the finaliser of MurmurHash3 over both.
#[inline(always)]
pub(super) fn hash(state: u32, word: u32) -> u32 {
    let mut h = state
        .rotate_left(13)
        .wrapping_mul(5)
        .wrapping_add(0xe654_6b64)
        ^ word;
    h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
    h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
    h ^ (h >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In every dimension, of 2^k points exactly one lies in each of 2^k equal parts: also beyond the table's end.
    #[test]
    fn points_are_stratified_in_every_dimension() {
        for set in [0, 1, 63, 64, 200] {
            for first in [0, 64, 1 << 16, 1 << 40] {
                let mut parts = [[0; 64]; 4];
                for index in first..first + 64 {
                    let point = SequencePoint::new(scramble([1, 2, 3, 4], 5), index);
                    let coordinates = point.coordinates(set);
                    for (which, u) in coordinates.into_iter().enumerate() {
                        assert_eq!(u, point.coordinate(set, which as u32));
                        parts[which][(u * 64.0) as usize] += 1;
                    }
                }
                assert_eq!(parts, [[1; 64]; 4], "set {set}, from {first}");
            }
        }
    }

    #[test]
    fn keys_children_and_repetitions_have_sequences_of_their_own() {
        let point = SequencePoint::new(scramble([1, 2, 3, 4], 5), 7);
        let others = [
            SequencePoint::new(scramble([2, 2, 3, 4], 5), 7),
            SequencePoint::new(scramble([1, 2, 4, 4], 5), 7),
            SequencePoint::new(scramble([1, 2, 3, 5], 5), 7),
            SequencePoint::new(scramble([1, 2, 3, 4], 5), 7 + (1 << 16)),
            point.branch(1, 0),
            point.branch(2, 0),
            point.branch(1, 1),
            point.branch(1, 0).branch(1, 0),
        ];
        let mut all: Vec<[f32; 4]> = others.iter().map(|other| other.coordinates(1)).collect();
        all.extend([1, 65, 129].map(|set| point.coordinates(set)));
        for (index, one) in all.iter().enumerate() {
            assert!(!all[..index].contains(one), "{index}");
        }
        assert_eq!(point, point.branch(0, 5));
    }

    /// Over scrambles, a coordinate is uniform, and those of siblings are independent: chi-square over 8 x 8 cells.
    #[test]
    fn siblings_are_independent() {
        const DRAWS: u32 = 1 << 15;
        let mut cells = [0_u32; 64];
        for key in 0..DRAWS {
            let point = SequencePoint::new(scramble([0, 0, 0, key], 5), 3);
            let [a, ..] = point.coordinates(2);
            let [b, ..] = point.branch(1, 0).coordinates(2);
            cells[(a * 8.0) as usize * 8 + (b * 8.0) as usize] += 1;
        }
        let expected = f64::from(DRAWS) / 64.0;
        let terms = cells.map(|n| (f64::from(n) - expected).powi(2) / expected);
        let chi_square: f64 = terms.iter().sum();
        // 63 degrees of freedom: the 0.01 % and 99.99 % quantiles.
        assert!((27.0..114.0).contains(&chi_square), "{chi_square}");
    }
}
