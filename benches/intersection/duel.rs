//! The safe call against the same call in plain C, turn by turn: whatever slows the machine down meets both.

use std::time::{Duration, Instant};

use cohort::embree::{Coherence, Scene};

use crate::calls::{Buffers, Call, Side};
use crate::ray_sets::{RaySet, STRETCH};

/// An interval of a ratio that needs no further bouts.
const NARROW: f64 = 0.01;

/// Rounds of a bout, of which the shortest times count: interruptions do not.
const BOUT: usize = 3;

/// The rays of a set in the layout of one call, and what was measured with them.
pub struct Duel {
    stretches: Vec<Stretch>,
    /// Of every bout and pair of stretches, the time of plain C over the time of the safe call.
    ratios: Vec<f64>,
}

/// A stretch of rays, and the times in seconds that either side took for it in all rounds.
struct Stretch {
    buffers: Box<dyn Buffers>,
    safe: Vec<f64>,
    plain_c: Vec<f64>,
}

/// What a duel showed.
#[derive(Clone, Copy, Debug)]
pub struct Speed {
    /// Million rays a second through the safe call.
    pub safe: f64,
    /// Million rays a second through plain C.
    pub plain_c: f64,
    /// The rate of the safe call over that of plain C: the median over all bouts and pairs of
    /// stretches.
    pub ratio: f64,
    /// Where the ratio lies with 95 % confidence.
    pub ratio_interval: [f64; 2],
}

impl Duel {
    /// Lays the rays of `set` out for `call`.
    pub fn new(call: &Call, set: &RaySet) -> Self {
        let stretch = |rays| Stretch {
            buffers: (call.lay_out)(rays),
            safe: Vec::new(),
            plain_c: Vec::new(),
        };
        Self {
            stretches: set.stretches.iter().map(stretch).collect(),
            ratios: Vec::new(),
        }
    }

    /// Traces the whole set `rounds` times by either side, and returns the time of the safe calls.
    ///
    /// The sides take turns, each with one stretch, and are half a set apart: as in a render, rays come after other
    /// rays, and neither side finds what the other has just looked up.
    pub fn run(&mut self, scene: &Scene, coherence: Coherence, rounds: usize) -> Duration {
        if self.stretches.iter().all(|s| s.safe.is_empty()) {
            for stretch in &mut self.stretches {
                stretch.time(Side::Safe, scene, coherence);
            }
        }
        let count = self.stretches.len();
        let mut safe_time = 0.0;
        for _ in 0..rounds {
            for turn in 0..count {
                let stretch = &mut self.stretches[turn];
                let time = stretch.time(Side::Safe, scene, coherence);
                stretch.safe.push(time);
                safe_time += time;
                let stretch = &mut self.stretches[(turn + count / 2) % count];
                let time = stretch.time(Side::PlainC, scene, coherence);
                stretch.plain_c.push(time);
            }
        }
        Duration::from_secs_f64(safe_time)
    }

    /// Measures the ratio, bout by bout, until its interval is narrow enough or `at_most` so much time has passed.
    ///
    /// The more often rays were traced, the faster they are. In each round safe calls are first with the first half of
    /// the stretches, and plain C with the second: the geometric mean over one of each favours neither.
    pub fn compare(&mut self, scene: &Scene, coherence: Coherence, at_most: Duration) {
        let start = Instant::now();
        loop {
            self.run(scene, coherence, BOUT);
            let (first, second) = self.stretches.split_at(self.stretches.len() / 2);
            let pairs = first.iter().zip(second);
            let ratios = pairs.map(|(a, b)| (a.latest_ratio() * b.latest_ratio()).sqrt());
            self.ratios.extend(ratios);
            let [low, high] = self.speed().ratio_interval;
            if high - low <= NARROW || start.elapsed() >= at_most {
                return;
            }
        }
    }

    /// What was measured so far.
    pub fn speed(&self) -> Speed {
        let rays = (self.stretches.len() * STRETCH) as f64;
        let rate = |times: fn(&Stretch) -> &[f64]| {
            let medians = self.stretches.iter().map(|s| median(&sorted(times(s))));
            rays / medians.sum::<f64>() * 1e-6
        };
        let ratios = sorted(&self.ratios);
        Speed {
            safe: rate(|stretch| &stretch.safe),
            plain_c: rate(|stretch| &stretch.plain_c),
            ratio: median(&ratios),
            ratio_interval: median_interval(&ratios),
        }
    }
}

impl Stretch {
    /// The shortest time of plain C over the shortest of the safe call in the latest bout.
    fn latest_ratio(&self) -> f64 {
        let shortest = |times: &[f64]| {
            let latest = times.iter().rev().take(BOUT);
            latest.copied().fold(f64::INFINITY, f64::min)
        };
        shortest(&self.plain_c) / shortest(&self.safe)
    }

    /// Traces all rays; returns seconds.
    fn time(&mut self, side: Side, scene: &Scene, coherence: Coherence) -> f64 {
        self.buffers.restore();
        let start = Instant::now();
        self.buffers.trace(side, scene, coherence);
        start.elapsed().as_secs_f64()
    }
}

fn sorted(numbers: &[f64]) -> Vec<f64> {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// The median of sorted numbers; NaN of none.
fn median(sorted: &[f64]) -> f64 {
    let middle = sorted.len() / 2;
    match sorted.len() {
        0 => f64::NAN,
        len if len.is_multiple_of(2) => 0.5 * (sorted[middle - 1] + sorted[middle]),
        _ => sorted[middle],
    }
}

/// The 95 % confidence interval of the median of what the sorted numbers were drawn from: the order statistics
/// n/2 ± 1.96 √n/2, by the binomial distribution of how many lie below the median. NaN of none.
fn median_interval(sorted: &[f64]) -> [f64; 2] {
    let Some(last) = sorted.len().checked_sub(1) else {
        return [f64::NAN; 2];
    };
    let (middle, reach) = (0.5 * last as f64, 0.98 * (sorted.len() as f64).sqrt());
    [
        sorted[(middle - reach).floor().max(0.0) as usize],
        sorted[((middle + reach).ceil() as usize).min(last)],
    ]
}
