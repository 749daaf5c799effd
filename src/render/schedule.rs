//! In which passes the samples of a pixel are taken.

use super::Budget;

/// Samples per pixel of a full pass. With a tile of 256 pixels a batch then has 4096 camera paths: many enough for a
/// population (a quarter and four times as many were not faster or slower beyond noise).
const FULL_PASS: u32 = 16;

/// The number of samples that every pixel gets in each pass.
///
/// It depends on the budget alone, so that the random numbers of a pass do too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Schedule {
    budget: Budget,
}

impl Schedule {
    /// The schedule for a budget.
    pub fn new(budget: Budget) -> Self {
        Self { budget }
    }

    /// Samples per pixel of pass number `pass` (from 0), or `None` after the last one.
    ///
    /// A given number of samples is divided into full passes and a rest. A time budget starts with small passes, 1, 1,
    /// 2, 4, 8, so that every pixel has its first sample soon.
    pub fn samples(&self, pass: u32) -> Option<u32> {
        match self.budget {
            Budget::SamplesPerPixel(total) => {
                let rest = total.get().saturating_sub(pass.saturating_mul(FULL_PASS));
                (rest > 0).then_some(rest.min(FULL_PASS))
            }
            Budget::Time(_) => Some(match pass {
                0 => 1,
                _ => (1 << (pass - 1).min(31)).min(FULL_PASS),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::num::NonZeroU32;
    use std::time::Duration;

    fn passes(budget: Budget, most: usize) -> Vec<u32> {
        let schedule = Schedule::new(budget);
        (0..)
            .map_while(|pass| schedule.samples(pass))
            .take(most)
            .collect()
    }

    #[test]
    fn passes_add_up_to_the_samples_asked_for() {
        for total in [1, 15, 16, 17, 100, 4096] {
            let budget = Budget::SamplesPerPixel(NonZeroU32::new(total).unwrap());
            assert_eq!(passes(budget, usize::MAX).iter().sum::<u32>(), total);
        }
    }

    #[test]
    fn a_time_budget_starts_small_and_never_ends() {
        let got = passes(Budget::Time(Duration::from_secs(1)), 8);
        assert_eq!(got, [1, 1, 2, 4, 8, 16, 16, 16]);
        assert_eq!(
            Schedule::new(Budget::Time(Duration::ZERO)).samples(u32::MAX),
            Some(16)
        );
    }
}
