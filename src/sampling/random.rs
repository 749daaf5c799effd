//! Random streams keyed by what is computed, never by who computes it.

use super::mersenne_twister::MersenneTwister;

/// Names one stream: two renders with the same key draw the same numbers, whatever the number of threads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StreamKey {
    /// The seed that the user chose.
    pub seed: u64,
    /// The tile of the image.
    pub tile: u32,
    /// The pass over that tile.
    pub pass: u32,
}

/// A Mersenne Twister (MT19937), the generator of the paper's renders.
pub struct RandomStream(MersenneTwister);

impl RandomStream {
    /// The stream of `key`. Keys that differ in any part give unrelated streams.
    pub fn new(key: StreamKey) -> Self {
        // MT19937's own initialisation by an array mixes every word of the key into the whole state.
        let words = [key.seed as u32, (key.seed >> 32) as u32, key.tile, key.pass];
        Self(MersenneTwister::new(words))
    }

    /// A uniform 32-bit integer.
    #[inline(always)]
    pub fn bits(&mut self) -> u32 {
        self.0.next()
    }

    /// A uniform number in [0, 1) with 24 random bits, so that every value is exact in `f32`.
    #[inline(always)]
    pub fn uniform(&mut self) -> f32 {
        to_uniform(self.0.next())
    }

    /// As many numbers as there are in `lanes`, each as [`Self::uniform`].
    #[inline(always)]
    pub fn fill_uniform(&mut self, lanes: &mut [f32]) {
        let mut bits = [0; 64];
        for lanes in lanes.chunks_mut(bits.len()) {
            let bits = &mut bits[..lanes.len()];
            self.0.fill(bits);
            for (lane, bits) in lanes.iter_mut().zip(bits) {
                *lane = to_uniform(*bits);
            }
        }
    }

    /// A uniform number in [0, 1) with 53 random bits.
    #[inline]
    pub fn uniform_f64(&mut self) -> f64 {
        let high = u64::from(self.0.next() >> 5);
        let low = u64::from(self.0.next() >> 6);
        ((high << 26) | low) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Two independent uniform numbers in [0, 1).
    #[inline]
    pub fn uniform_2d(&mut self) -> [f32; 2] {
        [self.uniform(), self.uniform()]
    }
}

/// The upper 24 bits as a number in [0, 1).
#[inline(always)]
pub(super) fn to_uniform(bits: u32) -> f32 {
    (bits >> 8) as i32 as f32 * (1.0 / (1u32 << 24) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stream(seed: u64, tile: u32, pass: u32) -> RandomStream {
        RandomStream::new(StreamKey { seed, tile, pass })
    }

    #[test]
    fn many_uniform_numbers_are_the_same_as_one_by_one() {
        let (mut at_once, mut one_by_one) = (stream(1, 2, 3), stream(1, 2, 3));
        let mut lanes = [0.0; 1000];
        at_once.fill_uniform(&mut lanes);
        assert!(lanes.iter().all(|&u| u == one_by_one.uniform()));
    }

    #[test]
    fn every_part_of_the_key_counts() {
        let first = |mut random: RandomStream| [random.bits(), random.bits()];
        let reference = first(stream(1, 2, 3));
        assert_eq!(reference, first(stream(1, 2, 3)));
        for other in [
            stream(2, 2, 3),
            stream(1 + (1 << 32), 2, 3),
            stream(1, 3, 3),
            stream(1, 2, 4),
        ] {
            assert_ne!(reference, first(other));
        }
    }

    /// Both kinds of uniform numbers stay in [0, 1) and fill it evenly: chi-square over 64 cells.
    #[test]
    fn uniform_numbers_are_uniform() {
        const CELLS: usize = 64;
        const DRAWS: usize = 1 << 18;
        let mut random = stream(7, 0, 0);
        let mut cells = [[0_u32; CELLS]; 2];
        for _ in 0..DRAWS {
            cells[0][(random.uniform() * CELLS as f32) as usize] += 1;
            cells[1][(random.uniform_f64() * CELLS as f64) as usize] += 1;
        }
        let expected = (DRAWS / CELLS) as f64;
        for cells in cells {
            let chi_square: f64 = cells
                .iter()
                .map(|&n| (f64::from(n) - expected).powi(2) / expected)
                .sum();
            // 63 degrees of freedom: the 0.01 % and 99.99 % quantiles.
            assert!((27.0..114.0).contains(&chi_square), "{chi_square}");
        }
    }
}
