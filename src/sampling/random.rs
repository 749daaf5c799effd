//! Random streams keyed by what is computed, never by who computes it.

use rand_mt::Mt;

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
pub struct RandomStream(Mt);

impl RandomStream {
    /// The stream of `key`. Keys that differ in any part give unrelated streams.
    pub fn new(key: StreamKey) -> Self {
        // MT19937's own initialisation by an array mixes every word of the key into the whole state.
        let words = [key.seed as u32, (key.seed >> 32) as u32, key.tile, key.pass];
        Self(Mt::new_with_key(words))
    }

    /// A uniform number in [0, 1) with 24 random bits, so that every value is exact in `f32`.
    #[inline]
    pub fn uniform(&mut self) -> f32 {
        (self.0.next_u32() >> 8) as f32 * (1.0 / (1u32 << 24) as f32)
    }

    /// A uniform number in [0, 1) with 53 random bits.
    #[inline]
    pub fn uniform_f64(&mut self) -> f64 {
        let high = u64::from(self.0.next_u32() >> 5);
        let low = u64::from(self.0.next_u32() >> 6);
        ((high << 26) | low) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Two independent uniform numbers in [0, 1).
    #[inline]
    pub fn uniform_2d(&mut self) -> [f32; 2] {
        [self.uniform(), self.uniform()]
    }
}
