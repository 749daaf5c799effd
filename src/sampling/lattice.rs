//! Points of randomly shifted lattices, by rank: coordinate k of point i is the fraction of i a_k + s_k.
//!
//! Whatever the rank, a coordinate is uniform, for the shift s_k is; and consecutive ranks are spread evenly. The first two
//! multipliers are those of the plane for which that holds best (Roberts 2018, "The unreasonable effectiveness of quasirandom
//! sequences", R2), the others those of the golden ratio and of the square root of 2. A point costs a few integer operations, all of which
//! go over lanes.

use super::sobol::{SequencePoint, hash};

/// a_k in units of 2^-32: the plastic number's first two powers, the golden ratio's first, and that of sqrt(2) - 1.
const MULTIPLIERS: [u32; 4] = [0xc13f_a9a9, 0x91e1_0da5, 0x9e37_79b9, 0x6a09_e667];

/// The coordinates of a point in the lattice that is dimension set number `set`, in units of 2^-32: two that are spread evenly together,
/// and two more.
#[inline(always)]
pub fn lattice_coordinates<const N: usize>(point: SequencePoint, set: u32) -> [u32; N] {
    const { assert!(N <= MULTIPLIERS.len()) }
    std::array::from_fn(|k| lattice_coordinate(point, set, k))
}

/// One of the [`lattice_coordinates`] alone.
#[inline(always)]
pub fn lattice_coordinate(point: SequencePoint, set: u32, which: usize) -> u32 {
    let shift = hash(point.scramble(), 4 * set + which as u32);
    point
        .index()
        .wrapping_mul(MULTIPLIERS[which])
        .wrapping_add(shift)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of consecutive ranks, no part of the unit interval gets much more than its share, and those of the unit square get theirs far more
    /// evenly than by chance, where chi-square would be about 15.
    #[test]
    fn consecutive_ranks_are_spread_evenly() {
        for scramble in 0..50 {
            let points = (100..100 + 256).map(|rank| {
                let point = SequencePoint::ranked(scramble, rank);
                lattice_coordinates::<4>(point, 3).map(|u| f64::from(u) / 4_294_967_296.0)
            });
            let points: Vec<[f64; 4]> = points.collect();
            for k in 0..4 {
                let mut parts = [0; 16];
                points
                    .iter()
                    .for_each(|u| parts[(u[k] * 16.0) as usize] += 1);
                assert!(
                    parts.iter().all(|&n| (14..=18).contains(&n)),
                    "{k}: {parts:?}"
                );
            }
            let mut cells = [0; 16];
            for u in &points {
                cells[(u[0] * 4.0) as usize * 4 + (u[1] * 4.0) as usize] += 1;
            }
            let terms = cells.map(|n: i32| f64::from(n - 16).powi(2) / 16.0);
            let chi_square: f64 = terms.iter().sum();
            assert!(chi_square < 6.5, "{scramble}: {cells:?}");
        }
    }

    /// Over scrambles a coordinate of one point is uniform, and independent of the others: chi-square over 8 x 8 cells.
    #[test]
    fn shifts_make_coordinates_uniform() {
        const DRAWS: u32 = 1 << 15;
        for pair in [[0, 1], [0, 2], [1, 3]] {
            let mut cells = [0_u32; 64];
            for scramble in 0..DRAWS {
                let point = SequencePoint::ranked(hash(scramble, 9), 77);
                let [a, b] = pair.map(|k| lattice_coordinate(point, 2, k) >> 29);
                cells[(a * 8 + b) as usize] += 1;
            }
            let expected = f64::from(DRAWS) / 64.0;
            let terms = cells.map(|n| (f64::from(n) - expected).powi(2) / expected);
            let chi_square: f64 = terms.iter().sum();
            // 63 degrees of freedom: the 0.01 % and 99.99 % quantiles.
            assert!((27.0..114.0).contains(&chi_square), "{chi_square}");
        }
    }
}
