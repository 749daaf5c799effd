//! In which passes the samples of a pixel are taken.

use super::Budget;
use crate::sampling::SamplerKind;

/// Samples per pixel of a full pass. With a tile of 256 pixels a batch then has 4096 camera paths: many enough for a
/// population (a quarter and four times as many were not faster or slower beyond noise).
const FULL_PASS: u32 = 16;

/// The most samples per pixel from which a render learns, and the fewest.
const LESSONS: [u32; 2] = [32, 2];

/// With so many camera paths, an image of many pixels has learned enough. Four times as many are worth no more by rays, and what they teach takes longer
/// to look up; half as many are too few (`docs/tried.md`).
const TEACHING_PATHS: usize = 1 << 19;

/// The weight of a sample of which others learn, for it has not learned enough itself.
const LESSON_WEIGHT: f64 = 0.5;

/// The most samples per pixel of a pass that grows.
const LARGEST_PASS: u32 = 256;

/// The number of samples that every pixel gets in each pass.
///
/// It depends on the budget of the settings and on numbers of samples, never on time, so that the random numbers of a
/// pass do too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Schedule {
    budget: Budget,
    sampler: SamplerKind,
    learns: bool,
    /// Samples per pixel before which passes teach.
    lessons: u32,
}

impl Schedule {
    /// The schedule for a budget, in an image of so many pixels, of a render that `learns` from its first samples or not.
    pub fn new(budget: Budget, sampler: SamplerKind, learns: bool, pixels: usize) -> Self {
        Self {
            budget,
            sampler,
            learns,
            lessons: if learns { lessons(budget, pixels) } else { 0 },
        }
    }

    /// The same, with the [lessons](Self::lessons) that were settled when the render began, for another budget.
    pub fn with_lessons(self, lessons: u32) -> Self {
        Self { lessons, ..self }
    }

    /// From how many samples of every pixel the render learns.
    pub fn lessons(&self) -> u32 {
        self.lessons
    }

    /// Samples per pixel of pass number `pass` (from 0), where every pixel has `before` of the passes before and the
    /// render goes on `until` then; 0 after the last pass.
    ///
    /// A given number of samples is divided into full passes and a rest. Other budgets have no end of their own, and
    /// start with small passes, 1, 1, 2, 4, 8, so that every pixel has its first sample soon. So do renders that learn: what a sample
    /// has taught is of use to all that follow.
    ///
    /// Where the samples of a pass gain by being many ([`SamplerKind::ArrayQmc`]), passes grow with the samples that a pixel has: to a
    /// quarter of them, so that pixels that the last pass does not reach any more lack little.
    pub fn samples(&self, pass: u32, before: u64, until: Budget) -> u32 {
        let full = self.full_pass(match self.budget {
            Budget::SamplesPerPixel(total) => u64::from(total.get()),
            Budget::Time(_) | Budget::Rays(_) => before,
        });
        let starts_small = self.learns || !matches!(self.budget, Budget::SamplesPerPixel(_));
        let most = match pass {
            _ if !starts_small => full,
            0 => 1,
            _ => 1 << (pass - 1).min(31),
        };
        let most = if self.learns && !self.teaches(before) {
            most.min(self.weight_so_far(before))
        } else {
            most
        };
        full.min(most)
            .min(missing(self.budget, before))
            .min(missing(until, before))
    }

    /// Whether a render that learns does so from a pass before which every pixel has had so many samples: from all that begin in the first quarter of a
    /// given number, and never from more than `LESSONS` and `TEACHING_PATHS` allow.
    pub fn teaches(&self, before: u64) -> bool {
        before < u64::from(self.lessons)
    }

    /// The weight of every sample of a pass before which every pixel has had so many samples. It depends on the pass alone, so images stay unbiased.
    pub fn weight(&self, before: u64) -> f64 {
        if self.learns && self.teaches(before) {
            LESSON_WEIGHT
        } else {
            1.0
        }
    }

    /// What all samples together weigh, rounded down, where every pixel has had so many, with all lessons among them; at least 1. A pass that weighed more would
    /// leave pixels that it does not reach far behind, and the film could not tell its noise from that of the lessons.
    fn weight_so_far(&self, before: u64) -> u32 {
        // Passes of lessons double what there is.
        let taught = match self.lessons {
            0 => 0,
            lessons => u64::from(lessons.next_power_of_two()),
        };
        let weight = before.saturating_sub(taught.div_ceil(2));
        u32::try_from(weight).unwrap_or(u32::MAX).max(1)
    }

    /// The size of a full pass for pixels of so many samples.
    fn full_pass(&self, samples: u64) -> u32 {
        let grown = match self.sampler {
            SamplerKind::ArrayQmc => (samples / 4).clamp(1, u64::from(LARGEST_PASS)),
            SamplerKind::Independent | SamplerKind::Sobol => 1,
        };
        // A power of two, and it fits.
        (1 << grown.ilog2()).max(FULL_PASS)
    }
}

/// From how many samples of each of so many pixels a render learns that begins with this budget.
fn lessons(budget: Budget, pixels: usize) -> u32 {
    let [most, fewest] = LESSONS;
    // It fits, being small.
    let enough = (TEACHING_PATHS / pixels.max(1)).clamp(fewest as usize, most as usize) as u32;
    match budget {
        Budget::SamplesPerPixel(total) => enough.min(total.get() / 4),
        Budget::Time(_) | Budget::Rays(_) => enough,
    }
}

/// How many samples per pixel a budget has left, as far as it counts them.
fn missing(budget: Budget, before: u64) -> u32 {
    match budget {
        // It fits, being at most the total.
        Budget::SamplesPerPixel(total) => u64::from(total.get()).saturating_sub(before) as u32,
        Budget::Time(_) | Budget::Rays(_) => u32::MAX,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::num::{NonZeroU32, NonZeroU64};
    use std::time::Duration;

    const TIME: Budget = Budget::Time(Duration::from_secs(1));
    const RAYS: Budget = Budget::Rays(NonZeroU64::MIN);

    fn spp(samples: u32) -> Budget {
        Budget::SamplesPerPixel(NonZeroU32::new(samples).unwrap())
    }

    fn passes(budget: Budget, until: Budget, most: usize) -> Vec<u32> {
        let schedule = Schedule::new(budget, SamplerKind::Independent, false, 1);
        let mut before = 0;
        let pass = |pass| {
            let samples = schedule.samples(pass, before, until);
            before += u64::from(samples);
            (samples > 0).then_some(samples)
        };
        (0..).map_while(pass).take(most).collect()
    }

    #[test]
    fn passes_add_up_to_the_samples_asked_for() {
        for total in [1, 15, 16, 17, 100, 4096] {
            for (budget, until) in [(spp(total), TIME), (RAYS, spp(total))] {
                let got = passes(budget, until, usize::MAX);
                assert_eq!(got.iter().sum::<u32>(), total);
            }
        }
        assert_eq!(passes(spp(100), spp(40), usize::MAX), [16, 16, 8]);
    }

    #[test]
    fn passes_grow_for_samplers_that_gain_by_it() {
        let sizes = |budget| {
            let schedule = Schedule::new(budget, SamplerKind::ArrayQmc, false, 1);
            let mut before = 0;
            let next = |pass| {
                let samples = schedule.samples(pass, before, spp(2000));
                before += u64::from(samples);
                (samples > 0).then_some(samples)
            };
            (0..).map_while(next).collect::<Vec<u32>>()
        };
        let timed = sizes(TIME);
        assert_eq!(timed[..8], [1, 1, 2, 4, 8, 16, 16, 16]);
        assert_eq!(timed.iter().sum::<u32>(), 2000);
        assert_eq!(timed.iter().max(), Some(&256));
        assert_eq!(sizes(spp(256)), [64; 4]);
        assert_eq!(sizes(spp(20)), [16, 4]);
    }

    #[test]
    fn renders_that_learn_start_small() {
        let schedule = Schedule::new(spp(50), SamplerKind::Independent, true, 1);
        let mut before = 0;
        let passes: Vec<u32> = (0..8)
            .map(|pass| {
                let samples = schedule.samples(pass, before, TIME);
                before += u64::from(samples);
                samples
            })
            .collect();
        assert_eq!(passes, [1, 1, 2, 4, 8, 8, 16, 10]);
        assert_eq!([8, 16].map(|before| schedule.weight(before)), [0.5, 1.0]);
    }

    /// From the third on: of two, nobody knows which is the noisier.
    #[test]
    fn no_pass_weighs_more_than_all_before_it() {
        for (budget, pixels) in [
            (TIME, 1),
            (TIME, 400 * 400),
            (TIME, 4096 * 4096),
            (spp(20), 1),
            (spp(5), 1),
        ] {
            let schedule = Schedule::new(budget, SamplerKind::ArrayQmc, true, pixels);
            let (mut before, mut weight) = (0, 0.0);
            for pass in 0..16 {
                let samples = schedule.samples(pass, before, TIME);
                let new = f64::from(samples) * schedule.weight(before);
                assert!(
                    pass < 2 || new <= weight,
                    "{budget:?}: pass {pass} weighs {new} after {weight}"
                );
                before += u64::from(samples);
                weight += new;
            }
        }
    }

    #[test]
    fn large_images_have_learned_enough_from_few_samples() {
        let lessons = |budget, side: usize| {
            let schedule = Schedule::new(budget, SamplerKind::Independent, true, side * side);
            (0..).find(|&before| !schedule.teaches(before)).unwrap_or(0)
        };
        let timed = [1, 256, 400, 4096].map(|side| lessons(TIME, side));
        assert_eq!(timed, [32, 8, 3, 2]);
        let counted = [3, 64, 4096].map(|samples| lessons(spp(samples), 1));
        assert_eq!(counted, [0, 16, 32]);
    }

    /// What was taught is forgotten with the last lesson: a larger budget does not begin again.
    #[test]
    fn lessons_stay_as_they_were_settled() {
        let of = |budget| Schedule::new(budget, SamplerKind::Independent, true, 1);
        let gone_on = of(spp(400)).with_lessons(of(spp(8)).lessons());
        assert!(gone_on.teaches(1) && !gone_on.teaches(2) && of(spp(400)).teaches(2));
        assert_eq!([1, 2].map(|before| gone_on.weight(before)), [0.5, 1.0]);
    }

    #[test]
    fn time_and_rays_start_small_and_never_end() {
        for budget in [TIME, RAYS] {
            assert_eq!(passes(budget, TIME, 8), [1, 1, 2, 4, 8, 16, 16, 16]);
            let schedule = Schedule::new(budget, SamplerKind::Independent, false, 1);
            assert_eq!(schedule.samples(u32::MAX, u64::MAX, RAYS), 16);
        }
        assert_eq!(passes(TIME, spp(13), usize::MAX), [1, 1, 2, 4, 5]);
    }
}
