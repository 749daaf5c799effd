//! Whether what was learned pays: a few tiles are rendered aside, with it and without, and the render goes on with whatever makes variance times cost
//! least there.
//!
//! What is rendered aside has random numbers of its own and does not become part of the image. So the verdict is fixed before anything that
//! it is applied to, and images stay unbiased. It waits until the render has taken so long that its cost does not count.

use std::sync::Mutex;

use serde::{Deserialize, Serialize};

use super::watch::{Watch, unpoisoned};
use super::{Budget, RenderState};
use crate::film::{Film, FilmSums, FilmTile, PixelStatistics};
use crate::learning::{Knowledge, Reliance};
use crate::sampling::StreamKey;
use crate::transport::{Engine, PathCounts, TileJob, TraceBatches};
use crate::walk::Objective;

/// Camera paths of a pixel that are traced together: as many as make a sampler's points even.
const SAMPLES: u32 = 32;

/// How often, with independent random numbers: two already tell how much they vary.
const UNITS: u32 = 2;

/// One tile in so many is rendered aside, but at least [`FEWEST_TILES`].
const TILES: usize = 32;

/// See [`TILES`].
const FEWEST_TILES: usize = 8;

/// What is rendered aside costs at most this part of what was rendered before.
const MOST_COST: f64 = 1.0 / 8.0;

/// A pixel whose mean varies by more than this, relative to its brightness, counts as if it varied by this: what is rare is not told by
/// two units.
const LARGEST_VARIANCE: f64 = 4.0;

/// The time that a ray takes more where the strategy is told what was learned, and where directions are guided (`docs/strategies.md`). Measured once:
/// a verdict that depended on the clock would not be the same again.
const COST_OF_COUNTS: f64 = 1.08;
/// See [`COST_OF_COUNTS`].
const COST_OF_GUIDING: f64 = 1.13;

/// What is to be tried.
pub(super) struct Trial {
    candidates: Vec<Reliance>,
    /// The tiles to be rendered aside, by index.
    tiles: Vec<usize>,
    /// All tiles of the film.
    film_tiles: usize,
}

/// What came out for a candidate in a tile, or in all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Finding {
    /// The sum of the variances of the pixels.
    variance: f64,
    rays: u64,
}

impl Trial {
    /// The trial for a film of `film_tiles` tiles, of a render that learns for its strategy's `counts`, or for `guiding`.
    pub fn new(film_tiles: usize, counts: bool, guiding: bool) -> Self {
        let choices = |is_wanted: bool| {
            if is_wanted {
                vec![true, false]
            } else {
                vec![false]
            }
        };
        let candidates = choices(counts).into_iter().flat_map(|counts| {
            let candidate = move |guiding| Reliance { counts, guiding };
            choices(guiding).into_iter().map(candidate)
        });
        let count = (film_tiles / TILES).max(FEWEST_TILES).min(film_tiles);
        Self {
            candidates: candidates.collect(),
            tiles: (0..count)
                .map(|i| (i * film_tiles + film_tiles / 2) / count)
                .collect(),
            film_tiles,
        }
    }

    /// Whether it is worth its cost in a render with this budget in which every pixel has had `before` samples.
    pub fn is_due(&self, before: u64, budget: Budget) -> bool {
        let samples = self.candidates.len() * (UNITS * SAMPLES) as usize * self.tiles.len();
        let cost = samples as f64 / self.film_tiles as f64;
        let profits = match budget {
            Budget::SamplesPerPixel(total) => u64::from(total.get()) >= 2 * before,
            Budget::Time(_) | Budget::Rays(_) => true,
        };
        profits && cost <= MOST_COST * before as f64
    }

    /// Goes on with trying all candidates with what `state` has learned, on all threads of the pool that this is called in, each with its tracer: until
    /// there is a verdict, or until `watch` says that it is time to end. What was found until then is kept in `state`.
    pub fn advance(
        &self,
        engine: &Engine,
        state: &mut RenderState,
        tracers: &[Mutex<Box<dyn TraceBatches>>],
        watch: &Watch,
    ) {
        let Some(knowledge) = &state.knowledge else {
            return;
        };
        let mut findings = std::mem::take(&mut state.findings);
        findings.resize(self.tiles.len() * self.candidates.len(), None);
        let missing = findings.iter_mut().enumerate();
        let missing = Mutex::new(missing.filter(|(_, finding)| finding.is_none()));
        let (film, seed) = (&state.film, state.seed);
        rayon::broadcast(|context| {
            let tracer = &mut **unpoisoned(&tracers[context.index()]);
            loop {
                let next = unpoisoned(&missing).next();
                let Some((job, finding)) = next else {
                    break;
                };
                let aside = Aside {
                    engine,
                    film,
                    seed,
                    knowledge,
                    tile: self.tiles[job / self.candidates.len()],
                    reliance: self.candidates[job % self.candidates.len()],
                };
                *finding = aside.render(tracer, watch);
                if finding.is_none() {
                    break;
                }
            }
        });
        state.reliance = self.verdict(&findings);
        state.findings = findings;
    }

    /// What is best by the findings of all jobs; `None` while one is missing. They are added up in their order, for sums depend on it.
    fn verdict(&self, findings: &[Option<Finding>]) -> Option<Reliance> {
        let mut sums = vec![Finding::default(); self.candidates.len()];
        for (job, finding) in findings.iter().enumerate() {
            let (sum, finding) = (&mut sums[job % self.candidates.len()], (*finding)?);
            sum.variance += finding.variance;
            sum.rays += finding.rays;
        }
        let inefficiency = |(reliance, finding): &(&Reliance, Finding)| {
            finding.variance * finding.rays as f64 * cost_of_ray(**reliance)
        };
        let judged = self.candidates.iter().zip(sums);
        let best = judged.min_by(|one, other| inefficiency(one).total_cmp(&inefficiency(other)));
        best.map(|(reliance, _)| *reliance)
    }
}

/// The time that a ray takes, relative to one of a render that relies on nothing.
fn cost_of_ray(reliance: Reliance) -> f64 {
    let cost = |is_on: bool, cost: f64| if is_on { cost } else { 1.0 };
    cost(reliance.counts, COST_OF_COUNTS) * cost(reliance.guiding, COST_OF_GUIDING)
}

/// One tile, rendered aside.
struct Aside<'a> {
    engine: &'a Engine,
    film: &'a Film,
    seed: u64,
    knowledge: &'a Knowledge,
    tile: usize,
    reliance: Reliance,
}

impl Aside<'_> {
    /// `None` if it is time to end.
    fn render(&self, tracer: &mut dyn TraceBatches, watch: &Watch) -> Option<Finding> {
        let mut tile = self.film.tiles()[self.tile].without_samples(FilmSums::Double);
        let mut rays = 0;
        if !watch.allows(&tile, PathCounts::Even(UNITS * SAMPLES)) {
            return None;
        }
        for unit in 0..UNITS {
            let job = TileJob {
                key: StreamKey {
                    // No pass of the render has such a number, nor its sequences this seed.
                    seed: self.seed ^ (u64::MAX - u64::from(unit)),
                    tile: self.tile as u32,
                    pass: u32::MAX - unit,
                },
                counts: PathCounts::Even(SAMPLES),
                weight: f64::from(SAMPLES),
                knowledge: Some(self.knowledge),
                learns: false,
                reliance: self.reliance,
            };
            rays += watch.trace_aside(self.engine, &job, &mut tile, tracer);
        }
        Some(Finding {
            variance: self.variance(&tile),
            rays,
        })
    }

    /// The sum of the variances of the pixels of `tile`, relative to their brightness if the strategy's objective is.
    fn variance(&self, tile: &FilmTile) -> f64 {
        let width = self.film.size().width;
        let variance = |(index, pixel): (usize, PixelStatistics)| {
            let (x, y) = tile.position(index);
            let brightness = f64::from(self.knowledge.pixels().brightness(y * width + x));
            let channels = pixel.variance_of_mean().unwrap_or_default();
            let variance = channels.iter().sum::<f64>() / channels.len() as f64;
            let squared = brightness * brightness;
            let variance = variance.min(LARGEST_VARIANCE * squared);
            match self.engine.strategy().objective() {
                Objective::Mse => variance,
                Objective::Relative if squared > 0.0 => variance / squared,
                Objective::Relative => 0.0,
            }
        };
        tile.pixels.iter().enumerate().map(variance).sum()
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU32;
    use std::time::Duration;

    use super::*;

    #[test]
    fn what_nobody_asked_for_is_not_tried() {
        let tried = |counts, guiding| {
            let trial = Trial::new(100, counts, guiding);
            let names = trial.candidates.iter().map(Reliance::to_string);
            names.collect::<Vec<_>>().join(", ")
        };
        assert_eq!(
            tried(true, true),
            "counts and guiding, counts, guiding, nothing"
        );
        assert_eq!(tried(true, false), "counts, nothing");
        assert_eq!(tried(false, true), "guiding, nothing");
    }

    #[test]
    fn tiles_are_spread_over_the_film() {
        let tiles = |count| Trial::new(count, true, false).tiles;
        assert_eq!(tiles(1), [0]);
        assert_eq!(tiles(8), [0, 1, 2, 3, 4, 5, 6, 7]);
        assert_eq!(tiles(64), [4, 12, 20, 28, 36, 44, 52, 60]);
        let of_many = tiles(2500);
        assert_eq!(of_many.len(), 78);
        assert!(of_many.windows(2).all(|pair| pair[0] < pair[1]) && of_many[77] < 2500);
    }

    #[test]
    fn a_trial_costs_little_of_what_it_can_save() {
        let spp = |count| Budget::SamplesPerPixel(NonZeroU32::new(count).unwrap());
        let time = Budget::Time(Duration::from_secs(1));
        // Two candidates, twice 32 samples, of 20 tiles of 640: four samples of every pixel.
        let trial = Trial::new(640, true, false);
        assert_eq!(
            [31, 32].map(|before| trial.is_due(before, time)),
            [false, true]
        );
        assert_eq!(
            [63, 64].map(|total| trial.is_due(32, spp(total))),
            [false, true]
        );
    }
}
