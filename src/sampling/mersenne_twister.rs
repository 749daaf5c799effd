//! The Mersenne Twister MT19937, 624 numbers at a time.
//!
//! Matsumoto and Nishimura 1998, "Mersenne Twister: A 623-dimensionally equidistributed uniform pseudo-random number generator". The
//! numbers are those of every other implementation; here whole blocks are made in loops that compilers turn into vector
//! instructions, since a path takes about twenty of them.

use multiversion::multiversion;

/// Numbers that the recurrence makes from the 624 before them.
const BLOCK: usize = 624;
/// How far ahead the second operand of the recurrence lies.
const MIDDLE: usize = 397;
/// Numbers of a block that depend on the block before alone.
const AHEAD: usize = BLOCK - MIDDLE;

/// A generator and the numbers of its current block that have not been taken.
pub(super) struct MersenneTwister {
    state: [u32; BLOCK],
    /// The numbers of the block.
    numbers: [u32; BLOCK],
    /// How many of them have been taken.
    taken: usize,
}

impl MersenneTwister {
    /// Initialised by an array, `init_by_array` of the authors' `mt19937ar.c`.
    pub fn new(key: [u32; 4]) -> Self {
        let mut state = [0; BLOCK];
        state[0] = 19_650_218;
        for i in 1..BLOCK {
            state[i] = mixed(state[i - 1], 1_812_433_253).wrapping_add(i as u32);
        }
        let mut i = 1;
        let go_on = |state: &mut [u32; BLOCK], i: &mut usize| {
            *i += 1;
            if *i == BLOCK {
                state[0] = state[BLOCK - 1];
                *i = 1;
            }
        };
        for (j, word) in key.into_iter().enumerate().cycle().take(BLOCK) {
            state[i] = (state[i] ^ mixed(state[i - 1], 1_664_525))
                .wrapping_add(word)
                .wrapping_add(j as u32);
            go_on(&mut state, &mut i);
        }
        for _ in 1..BLOCK {
            state[i] = (state[i] ^ mixed(state[i - 1], 1_566_083_941)).wrapping_sub(i as u32);
            go_on(&mut state, &mut i);
        }
        state[0] = 1 << 31;
        Self {
            state,
            numbers: [0; BLOCK],
            taken: BLOCK,
        }
    }

    /// The next number.
    #[inline(always)]
    pub fn next(&mut self) -> u32 {
        if self.taken == BLOCK {
            self.refill();
        }
        let number = self.numbers[self.taken];
        self.taken += 1;
        number
    }

    /// The next `numbers.len()` numbers.
    #[inline(always)]
    pub fn fill(&mut self, mut numbers: &mut [u32]) {
        while !numbers.is_empty() {
            if self.taken == BLOCK {
                self.refill();
            }
            let left = &self.numbers[self.taken..];
            if let (Ok(all), Some(first)) = (
                <&mut [u32; 64]>::try_from(&mut *numbers),
                left.first_chunk(),
            ) {
                *all = *first;
                self.taken += 64;
                return;
            }
            let count = left.len().min(numbers.len());
            let (now, later) = numbers.split_at_mut(count);
            now.copy_from_slice(&left[..count]);
            self.taken += count;
            numbers = later;
        }
    }

    #[inline(never)]
    fn refill(&mut self) {
        let old = self.state;
        advance(&old, &mut self.state);
        temper(&self.state, &mut self.numbers);
        self.taken = 0;
    }
}

fn mixed(word: u32, factor: u32) -> u32 {
    (word ^ (word >> 30)).wrapping_mul(factor)
}

/// The recurrence for one number of the block after: from that in its place, the one behind, and the one in the `middle`.
#[inline(always)]
fn twist(here: u32, behind: u32, middle: u32) -> u32 {
    let joined = (here & 0x8000_0000) | (behind & 0x7fff_ffff);
    middle ^ (joined >> 1) ^ ((joined & 1) * 0x9908_b0df)
}

/// Makes `new` the state after `old`.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
fn advance(old: &[u32; BLOCK], new: &mut [u32; BLOCK]) {
    for i in 0..AHEAD {
        new[i] = twist(old[i], old[i + 1], old[i + MIDDLE]);
    }
    // From here on numbers depend on those of the same block, 227 before: in two halves, each on the one before.
    let (first, rest) = new.split_at_mut(AHEAD);
    let (second, third) = rest.split_at_mut(AHEAD);
    for i in 0..AHEAD {
        second[i] = twist(old[AHEAD + i], old[AHEAD + i + 1], first[i]);
    }
    let last = third.len() - 1;
    for i in 0..last {
        third[i] = twist(old[2 * AHEAD + i], old[2 * AHEAD + i + 1], second[i]);
    }
    third[last] = twist(old[BLOCK - 1], first[0], second[last]);
}

/// Makes `numbers` those of a state: its words with their bits mixed.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
fn temper(state: &[u32; BLOCK], numbers: &mut [u32; BLOCK]) {
    for (number, &word) in numbers.iter_mut().zip(state) {
        let mut x = word;
        x ^= x >> 11;
        x ^= (x << 7) & 0x9d2c_5680;
        x ^= (x << 15) & 0xefc6_0000;
        *number = x ^ (x >> 18);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEY: [u32; 4] = [0x123, 0x234, 0x345, 0x456];

    /// The first numbers of Matsumoto and Nishimura's `mt19937ar.out`.
    #[test]
    fn it_is_that_of_its_authors() {
        let mut random = MersenneTwister::new(KEY);
        let drawn = [(); 5].map(|()| random.next());
        assert_eq!(
            drawn,
            [1067595299, 955945823, 477289528, 4107218783, 4228976476]
        );
    }

    #[test]
    fn another_implementation_draws_the_same_numbers() {
        let mut other = rand_mt::Mt::new_with_key(KEY);
        let mut random = MersenneTwister::new(KEY);
        for _ in 0..5000 {
            assert_eq!(random.next(), other.next_u32());
        }
    }

    #[test]
    fn many_numbers_at_once_are_the_same_as_one_by_one() {
        let (mut at_once, mut one_by_one) = (MersenneTwister::new(KEY), MersenneTwister::new(KEY));
        for length in [1, 0, 600, 64, 2000, 3] {
            let mut numbers = vec![0; length];
            at_once.fill(&mut numbers);
            assert!(numbers.iter().all(|&number| number == one_by_one.next()));
        }
    }
}
