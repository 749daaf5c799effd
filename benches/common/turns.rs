//! Two renders in turns.

use cohort::{Render, StopFlag};

use super::effort::Effort;
use super::rates::Rates;

/// The runs of each render, one a round. Who begins alternates, so that a machine that slows down or speeds up favours
/// nobody.
pub fn in_turns(renders: &[Render; 2], effort: Effort) -> [Vec<Rates>; 2] {
    let mut runs = [Vec::new(), Vec::new()];
    for round in 0..effort.choose(1, 3, 7) {
        for turn in 0..2 {
            let index = (round + turn) % 2;
            let outcome = renders[index].run(&StopFlag::new(), &());
            runs[index].push(Rates::new(&outcome.statistics, outcome.duration));
        }
    }
    runs
}
