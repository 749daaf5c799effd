//! The safe call against the same call in plain C, turn by turn: whatever slows the machine down meets both.

use std::time::{Duration, Instant};

use cohort::embree::{Coherence, Scene};

use crate::calls::{Buffers, Call, Side};
use crate::ray_sets::{RaySet, STRETCH};

/// The rays of a set in the layout of one call, and how long either side took for them.
pub struct Duel {
    stretches: Vec<Stretch>,
    rounds: u64,
}

/// A stretch of rays and the times in seconds of all rounds.
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
    /// The rate of the safe call over that of plain C: the median over all rounds and stretches.
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
            rounds: 0,
        }
    }

    /// Traces the whole set `rounds` times by either side, and returns the time of the safe calls.
    ///
    /// The sides take turns, each with one stretch, and are half a set apart: neither finds in the cache what the other
    /// has just looked up there. Who begins changes from round to round.
    pub fn run(&mut self, scene: &Scene, coherence: Coherence, rounds: u64) -> Duration {
        let count = self.stretches.len();
        let mut safe_time = Duration::ZERO;
        for _ in 0..rounds {
            let mut sides = [Side::Safe, Side::PlainC];
            if !self.rounds.is_multiple_of(2) {
                sides.reverse();
            }
            for turn in 0..count {
                for side in sides {
                    let place = match side {
                        Side::Safe => turn,
                        Side::PlainC => (turn + count / 2) % count,
                    };
                    let time = self.stretches[place].trace(side, scene, coherence);
                    if side == Side::Safe {
                        safe_time += time;
                    }
                }
            }
            self.rounds += 1;
        }
        safe_time
    }

    /// The rates of both sides and their ratio in all rounds so far.
    pub fn speed(&self) -> Speed {
        let rays = (self.stretches.len() * STRETCH) as f64;
        let rate = |times: fn(&Stretch) -> &[f64]| {
            let medians = self.stretches.iter().map(|s| median(&sorted(times(s))));
            rays / medians.sum::<f64>() * 1e-6
        };
        let ratio = |(safe, plain_c): (&f64, &f64)| plain_c / safe;
        let stretches = self.stretches.iter();
        let ratios = stretches.flat_map(|s| s.safe.iter().zip(&s.plain_c).map(ratio));
        let ratios = sorted(&ratios.collect::<Vec<f64>>());
        Speed {
            safe: rate(|stretch| &stretch.safe),
            plain_c: rate(|stretch| &stretch.plain_c),
            ratio: median(&ratios),
            ratio_interval: median_interval(&ratios),
        }
    }
}

impl Stretch {
    fn trace(&mut self, side: Side, scene: &Scene, coherence: Coherence) -> Duration {
        self.buffers.restore();
        let start = Instant::now();
        self.buffers.trace(side, scene, coherence);
        let time = start.elapsed();
        match side {
            Side::Safe => self.safe.push(time.as_secs_f64()),
            Side::PlainC => self.plain_c.push(time.as_secs_f64()),
        }
        time
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
