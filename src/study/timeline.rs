//! When competitors take turns, and when their images are looked at.

use std::num::{NonZeroU32, NonZeroU64};
use std::time::Duration;

use crate::render::Budget;

/// The longest turn, in seconds, and the least number of turns: short enough that a machine which becomes slower or
/// faster does so for all.
const LONGEST_TURN: f64 = 10.0;
const FEWEST_TURNS: u32 = 20;

/// The first snapshot is taken after so many seconds or more.
const FIRST_SNAPSHOT_SECONDS: f64 = 0.5;

/// A point of a repetition at which competitors change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// How much of the budget is used then.
    pub until: Budget,
    /// Whether the image is held against the reference.
    pub is_snapshot: bool,
}

/// The turns of a repetition, ascending. Snapshots are at the whole budget, at its half, its quarter and so on: at most
/// `snapshots` of them.
pub fn turns(budget: Budget, snapshots: u32) -> Vec<Turn> {
    let turn_count = match budget {
        Budget::Time(time) => {
            FEWEST_TURNS.max((time.as_secs_f64() / LONGEST_TURN).ceil().min(1e6) as u32)
        }
        Budget::SamplesPerPixel(samples) => FEWEST_TURNS.min(samples.get()),
        Budget::Rays(_) => FEWEST_TURNS,
    };
    let looked_at: Vec<f64> = (0..snapshots.min(60))
        .map(|halvings| 0.5_f64.powi(halvings as i32))
        .take_while(|&share| share == 1.0 || is_worth_a_look(budget, share))
        .collect();
    let mut shares: Vec<(f64, bool)> = (1..turn_count)
        .map(|turn| (f64::from(turn) / f64::from(turn_count), false))
        .chain(looked_at.into_iter().map(|share| (share, true)))
        .collect();
    shares.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut turns: Vec<Turn> = Vec::with_capacity(shares.len());
    for (share, is_snapshot) in shares {
        let until = part_of(budget, share);
        match turns.last_mut() {
            Some(last) if last.until == until => last.is_snapshot |= is_snapshot,
            _ => turns.push(Turn { until, is_snapshot }),
        }
    }
    turns
}

/// The share of a budget.
fn part_of(budget: Budget, share: f64) -> Budget {
    match budget {
        Budget::Time(time) => Budget::Time(Duration::from_secs_f64(time.as_secs_f64() * share)),
        Budget::SamplesPerPixel(samples) => {
            let part = (f64::from(samples.get()) * share).round() as u32;
            Budget::SamplesPerPixel(NonZeroU32::new(part).unwrap_or(NonZeroU32::MIN))
        }
        Budget::Rays(rays) if share < 1.0 => {
            let part = (rays.get() as f64 * share).round() as u64;
            Budget::Rays(NonZeroU64::new(part).unwrap_or(NonZeroU64::MIN))
        }
        Budget::Rays(rays) => Budget::Rays(rays),
    }
}

fn is_worth_a_look(budget: Budget, share: f64) -> bool {
    match budget {
        Budget::Time(time) => time.as_secs_f64() * share >= FIRST_SNAPSHOT_SECONDS,
        Budget::SamplesPerPixel(samples) => f64::from(samples.get()) * share >= 1.0,
        Budget::Rays(rays) => rays.get() as f64 * share >= 1e6,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_ascend_to_the_whole_budget_and_snapshots_halve_it() {
        let minute = turns(Budget::Time(Duration::from_secs(60)), 4);
        let times: Vec<f64> = minute
            .iter()
            .map(|turn| match turn.until {
                Budget::Time(time) => time.as_secs_f64(),
                _ => f64::NAN,
            })
            .collect();
        assert!(times.is_sorted_by(|a, b| a < b), "{times:?}");
        let snapshots: Vec<f64> = (minute.iter().zip(&times))
            .filter(|(turn, _)| turn.is_snapshot)
            .map(|(_, &time)| time)
            .collect();
        assert_eq!(snapshots, [7.5, 15.0, 30.0, 60.0]);
        assert!(times.len() >= 20 && times.windows(2).all(|pair| pair[1] - pair[0] <= 10.0));
    }

    #[test]
    fn long_budgets_have_short_turns_and_short_ones_few_snapshots() {
        let half_an_hour = turns(Budget::Time(Duration::from_secs(1800)), 3);
        assert!(half_an_hour.len() >= 180);
        let second = turns(Budget::Time(Duration::from_secs(1)), 9);
        assert_eq!(second.iter().filter(|turn| turn.is_snapshot).count(), 2);
        let samples = turns(Budget::SamplesPerPixel(NonZeroU32::new(4).unwrap()), 9);
        let expected = [(1, true), (2, true), (3, false), (4, true)];
        let expected = expected.map(|(samples, is_snapshot)| Turn {
            until: Budget::SamplesPerPixel(NonZeroU32::new(samples).unwrap()),
            is_snapshot,
        });
        assert_eq!(samples, expected);
        let one = turns(Budget::SamplesPerPixel(NonZeroU32::MIN), 9);
        assert_eq!(one.len(), 1);
    }
}
