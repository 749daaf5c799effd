//! How many directions are guided where a surface has lobes of its own: of a few shares, the one that would have varied least.
//!
//! A share s of directions comes from what was learned, the others from the lobes, with the density p (in which diffuse ones are guided themselves): together
//! they have q_s = s g + (1 - s) p. Which s is good depends on whether it is the light or the lobe that is narrow. A direction that was drawn with density q
//! and brought back w = f L / q tells of every share s what the second moment would be, the integral of (f L)^2 / q_s: it is the mean of w^2 q / q_s. (Müller
//! 2019, chapter 10 of the course "Path Guiding in Production", learns the probability by gradient descent; here there are few to choose from.)

use serde::{Deserialize, Serialize};

/// The shares that are chosen from.
const SHARES: [f32; 4] = [0.0, 0.25, 0.5, 0.75];

/// The density of the lobes, which is worked out from that of the mixture, is taken to be this part of the latter at least: less is lost in rounding.
const LEAST_OWN: f32 = 1e-4;

/// The part of directions that are guided where a surface has broad lobes; less of them where they are narrow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct GuidedShare(u8);

impl GuidedShare {
    /// Where nothing is known of it.
    pub const UNKNOWN: Self = Self(1);

    /// In [0, 1).
    #[inline(always)]
    pub fn value(self) -> f32 {
        SHARES[usize::from(self.0) % SHARES.len()]
    }
}

/// A direction that was drawn from a mixture.
#[derive(Clone, Copy, Debug)]
pub struct MixedDirection {
    /// The density with which it was drawn.
    pub pdf: f32,
    /// That of guided directions.
    pub guided: f32,
    /// The share of them in `pdf`; below 1.
    pub share: f32,
    /// The part of a [`GuidedShare`] that the surface makes use of.
    pub reach: f32,
}

/// For each share, how many times as likely a direction was as it would be with that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Odds([f32; SHARES.len()]);

impl Odds {
    /// Those of `direction`.
    #[inline]
    pub fn of(direction: &MixedDirection) -> Self {
        let MixedDirection {
            pdf,
            guided,
            share,
            reach,
        } = *direction;
        let own = (pdf - share * guided) / (1.0 - share);
        let own = own.max(LEAST_OWN * pdf);
        Self(SHARES.map(|other| {
            let other = reach * other;
            pdf / (other * guided + (1.0 - other) * own)
        }))
    }
}

/// For each share, what the squares of values would add up to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct MixtureSums([f32; SHARES.len()]);

impl MixtureSums {
    /// A direction with these `odds` brought back `value`.
    pub(super) fn observe(&mut self, odds: &Odds, value: f32) {
        for (sum, odds) in self.0.iter_mut().zip(odds.0) {
            *sum += value * value * odds;
        }
    }

    /// Adds a `share` of `other`.
    pub(super) fn add(&mut self, other: &Self, share: f32) {
        for (sum, other) in self.0.iter_mut().zip(other.0) {
            *sum += share * other;
        }
    }

    /// The share with the least of it.
    pub(super) fn best(&self) -> GuidedShare {
        let numbered = (0..).zip(self.0);
        match numbered.min_by(|(_, one), (_, other)| one.total_cmp(other)) {
            Some((number, sum)) if sum > 0.0 => GuidedShare(number),
            _ => GuidedShare::UNKNOWN,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On [0, 1): lobes are uniform, guided directions have the density 2u, and half of the directions are guided.
    fn observed(light: impl Fn(f32) -> f32) -> MixtureSums {
        const N: usize = 100_000;
        let mut sums = MixtureSums::default();
        for i in 0..N {
            // The distribution of the mixture is (u^2 + u) / 2.
            let fraction = (i as f32 + 0.5) / N as f32;
            let place = (2.0 * fraction + 0.25).sqrt() - 0.5;
            let direction = MixedDirection {
                pdf: 0.5 + place,
                guided: 2.0 * place,
                share: 0.5,
                reach: 1.0,
            };
            let value = light(place) / direction.pdf / (N as f32).sqrt();
            sums.observe(&Odds::of(&direction), value);
        }
        sums
    }

    /// The integral of L^2 over the density.
    #[test]
    fn sums_are_second_moments_with_other_shares() {
        let sums = observed(|_| 1.0);
        for (share, sum) in SHARES.into_iter().zip(sums.0) {
            // 1 / (1 - s + 2 s u), integrated.
            let expected = if share == 0.0 {
                1.0
            } else {
                ((1.0 + share) / (1.0 - share)).ln() / (2.0 * share)
            };
            assert!(
                (sum - expected).abs() < 1e-2 * expected,
                "{share}: {sum} {expected}"
            );
        }
    }

    #[test]
    fn the_share_that_varies_least_is_best() {
        assert_eq!(observed(|_| 1.0).best().value(), 0.0);
        assert_eq!(observed(|u| 2.0 * u).best().value(), 0.75);
        assert_eq!(observed(|u| 0.5 + u).best().value(), 0.5);
        assert_eq!(observed(|_| 0.0).best(), GuidedShare::UNKNOWN);
        let mut infinite = observed(|u| 2.0 * u);
        infinite.0[3] = f32::NAN;
        assert_eq!(infinite.best().value(), 0.5);
    }

    /// Where only guided directions go, and lobes do not, nothing is infinite.
    #[test]
    fn directions_of_no_lobe_have_finite_odds() {
        let direction = MixedDirection {
            pdf: 0.3 * 5.0,
            guided: 5.0,
            share: 0.3,
            reach: 0.4,
        };
        let Odds(odds) = Odds::of(&direction);
        assert!(
            odds.iter().all(|odds| odds.is_finite() && *odds > 0.0),
            "{odds:?}"
        );
        assert!(odds.is_sorted_by(|one, other| one > other));
    }
}
