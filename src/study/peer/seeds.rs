//! Seeds for chunks of samples that are independent of each other.

use serde::{Deserialize, Serialize};

use crate::scene::ImageSize;

/// A sequence of seeds for `mitsuba.render`.
///
/// Mitsuba's scalar variants multiply the seed by the number of pixels, in 32 bits, and start the generator of the i-th
/// pixel, counted in square blocks of at most 64 x 64, from that number plus i. So seeds are taken so far apart that no
/// two images of a study start a generator from the same number, as long as there are numbers: 2^32 over the pixels.
/// They come in a random order, for generators that start from evenly spaced numbers are related to each other.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SeedSequence {
    /// Distance of neighbouring seeds.
    spacing: u32,
    /// How many seeds there are until they repeat.
    count: u32,
    /// Which random order.
    key: u32,
    /// Place in the order of the next seed.
    next: u64,
    /// By how many places it advances: the number of repetitions that share the order.
    stride: u32,
}

/// The side of the largest block in which Mitsuba renders.
const BLOCK: u64 = 64;

impl SeedSequence {
    /// The seeds of one of `repetitions`, counted from 0, of a study with this seed. The repetitions share no seed.
    pub fn new(size: ImageSize, study_seed: u64, repetition: u32, repetitions: u32) -> Self {
        let pixels = size.pixels() as u64;
        let blocks = u64::from(size.width).div_ceil(BLOCK) * u64::from(size.height).div_ceil(BLOCK);
        let spacing = (blocks * BLOCK * BLOCK).div_ceil(pixels);
        // Blocks have 2^12 pixels, so that there are at most 2^20 seeds.
        let count = ((1 << 32) / (pixels * spacing)).max(1);
        Self {
            spacing: spacing as u32,
            count: count as u32,
            key: (study_seed ^ (study_seed >> 32)) as u32,
            next: u64::from(repetition),
            stride: repetitions.max(1),
        }
    }
}

impl Iterator for SeedSequence {
    type Item = u32;

    /// The next seed. The sequence never ends; it repeats in another order.
    fn next(&mut self) -> Option<u32> {
        let round = (self.next / u64::from(self.count)) as u32;
        let place = (self.next % u64::from(self.count)) as u32;
        self.next += u64::from(self.stride);
        let key = self.key.wrapping_add(round);
        Some(permuted(place, self.count, key) * self.spacing)
    }
}

/// The element at `place` of a random permutation of 0..`count`: Kensler, Correlated Multi-Jittered Sampling (Pixar
/// Technical Memo 13-01, 2013), function `permute`. `place` is below `count`, and that at most 2^31.
fn permuted(place: u32, count: u32, key: u32) -> u32 {
    let mask = count.next_power_of_two() - 1;
    let mut i = place;
    loop {
        i ^= key;
        i = i.wrapping_mul(0xe170_893d);
        i ^= key >> 16;
        i ^= (i & mask) >> 4;
        i ^= key >> 8;
        i = i.wrapping_mul(0x0929_eb3f);
        i ^= key >> 23;
        i ^= (i & mask) >> 1;
        i = i.wrapping_mul(1 | key >> 27);
        i = i.wrapping_mul(0x6935_fa69);
        i ^= (i & mask) >> 11;
        i = i.wrapping_mul(0x74dc_b303);
        i ^= (i & mask) >> 2;
        i = i.wrapping_mul(0x9e50_1cc3);
        i ^= (i & mask) >> 2;
        i = i.wrapping_mul(0xc860_a3df);
        i &= mask;
        i ^= i >> 5;
        if i < count {
            return ((u64::from(i) + u64::from(key)) % u64::from(count)) as u32;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    #[test]
    fn generators_never_start_from_the_same_number() {
        for (width, height) in [(800, 800), (400, 400), (333, 217), (4096, 2048)] {
            let size = ImageSize { width, height };
            let pixels = size.pixels() as u64;
            let repetitions = 3;
            let taken: Vec<u32> = (0..repetitions)
                .flat_map(|r| {
                    let seeds = SeedSequence::new(size, 7, r, repetitions);
                    let each = seeds.count / repetitions;
                    seeds.take(each as usize)
                })
                .collect();
            assert!(taken.len() as u64 >= (1 << 32) / pixels / 3, "{size:?}");
            let distinct: HashSet<_> = taken.iter().collect();
            assert_eq!(distinct.len(), taken.len(), "{size:?}");
            let mut starts: Vec<u64> = taken.iter().map(|&s| u64::from(s) * pixels).collect();
            starts.sort_unstable();
            let blocks = u64::from(width).div_ceil(64) * u64::from(height).div_ceil(64) * 4096;
            assert!(starts.windows(2).all(|pair| pair[0] + blocks <= pair[1]));
            assert!(starts.iter().all(|start| start + pixels <= 1 << 32));
        }
    }

    #[test]
    fn the_order_is_random_and_depends_on_the_seed_of_the_study() {
        let size = ImageSize {
            width: 128,
            height: 128,
        };
        let first = |seed| {
            SeedSequence::new(size, seed, 0, 1)
                .take(50)
                .collect::<Vec<_>>()
        };
        assert_eq!(first(1), first(1));
        assert_ne!(first(1), first(2));
        let rises = first(1).windows(2).filter(|pair| pair[0] < pair[1]).count();
        assert!((10..40).contains(&rises), "{rises}");
        let mean = first(1).iter().map(|&s| f64::from(s)).sum::<f64>() / 50.0;
        assert!((mean / 2f64.powi(17) - 1.0).abs() < 0.4, "{mean}");
    }
}
