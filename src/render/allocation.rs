//! How the camera paths of a pass are shared out among the pixels: where one path leaves much error, there are more of them.
//!
//! With n paths in a pixel, each of which leaves the variance V, an image of sum(n) paths has the least error sum(V / n) where n is in proportion to sqrt(V)
//! (Neyman 1934, "On the two different aspects of the representative method", for strata of a population; for pixels see the survey of Zwicker et al. 2015,
//! "Recent advances in adaptive sampling and reconstruction for Monte Carlo rendering").
//!
//! Counts are settled before a pass, by the passes before it, and the samples of a pass weigh together what they would weigh if there were as many
//! everywhere. So whatever was seen before, the estimate from there on is right in the mean, and images stay unbiased.

use std::ops::AddAssign;

use serde::{Deserialize, Serialize};

use crate::film::{Film, FilmTile, PixelStatistics, neighbourhood_sums};
use crate::transport::PathCounts;
use crate::walk::Objective;

/// The part of a pass that is shared out evenly: what is known of the error is uncertain, and what points that are spread evenly leave falls faster than 1 / n.
const EVEN_SHARE: f64 = 0.25;

/// A pixel gets at most about so many times the paths of others.
const LARGEST_SHARE: f64 = 16.0;

/// With so many samples a pixel it is first asked how they vary.
const FEWEST_SAMPLES: u64 = 4;

/// It is asked again with so many times the samples. Between, a sample of a pixel has the same weight in every pass, so that points that are
/// spread evenly over all of them are worth it.
const GROWTH: u64 = 4;

/// Pixels on each side of one with which its variance is averaged.
const REACH: usize = 2;

/// No pixel is taken to be darker than this part of the mean of all, as in the relative MSE.
const DARKEST: f64 = 0.01;

/// What is known of the error of every pixel, and how many camera paths each gets in the pass under way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Allocation {
    tiles: Vec<TileAllocation>,
    /// How many samples a pixel had in the mean when the shares were settled; 0 before.
    settled: u64,
    /// Whether pixels have counts of their own in the pass under way.
    is_uneven: bool,
}

/// One entry per pixel in every column.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct TileAllocation {
    /// The sum over all passes of the squared weight of its samples over their number: what the variance of one is to be multiplied by for that of their
    /// weighted sum.
    squares: Vec<f32>,
    /// How many paths it should have, relative to the mean of all.
    shares: Vec<f32>,
    /// Its camera paths in the pass under way. Of no meaning where all have as many.
    counts: Vec<u32>,
}

impl Allocation {
    /// That of a film without samples.
    pub fn new(film: &Film) -> Self {
        let tile = |tile: &FilmTile| {
            let count = tile.pixels.count();
            TileAllocation {
                squares: vec![0.0; count],
                shares: vec![1.0; count],
                counts: vec![0; count],
            }
        };
        Self {
            tiles: film.tiles().iter().map(tile).collect(),
            settled: 0,
            is_uneven: false,
        }
    }

    /// Whether this is one of `film`.
    pub fn fits(&self, film: &Film) -> bool {
        let is_like = |(mine, tile): (&TileAllocation, &FilmTile)| {
            let count = tile.pixels.count();
            [mine.squares.len(), mine.shares.len(), mine.counts.len()] == [count; 3]
        };
        self.tiles.len() == film.tiles().len() && self.tiles.iter().zip(film.tiles()).all(is_like)
    }

    /// Settles how many paths each pixel of `film` gets in a pass of `mean` a pixel, where it has had `before`; both are means over the film. All get as many
    /// where `before` is `None`, and while it is not known how they vary.
    pub fn plan(&mut self, film: &Film, objective: Objective, before: Option<u64>, mean: u32) {
        let is_known = || film.pixels().all(|pixel| pixel.units >= 2);
        let is_due =
            |&before: &u64| before >= FEWEST_SAMPLES.max(GROWTH * self.settled) && is_known();
        if let Some(before) = before.filter(is_due) {
            self.settle(film, objective);
            self.settled = before;
        }
        self.is_uneven = before.is_some() && self.settled > 0;
        if self.is_uneven {
            self.count(mean);
        }
    }

    /// How many camera paths the pixels of tile number `tile` get in a pass of `mean` in the mean.
    pub fn counts(&self, tile: usize, mean: u32) -> PathCounts<'_> {
        if self.is_uneven {
            PathCounts::Each(&self.tiles[tile].counts)
        } else {
            PathCounts::Even(mean)
        }
    }

    /// Takes note of a pass of `mean` samples a pixel in the mean that is over, where those of a pixel had this `weight` together.
    pub fn finish(&mut self, weight: f64, mean: u32) {
        for tile in &mut self.tiles {
            for (square, &count) in tile.squares.iter_mut().zip(&tile.counts) {
                let count = if self.is_uneven { count } else { mean };
                *square += (weight * weight / f64::from(count)) as f32;
            }
        }
    }

    /// Shares out `mean` paths a pixel: at least one each.
    fn count(&mut self, mean: u32) {
        let even = (EVEN_SHARE * f64::from(mean)).max(1.0);
        let shared_out = f64::from(mean) - even;
        // Sums are rounded, not numbers: so none is lost.
        let mut sum = 0.0;
        for tile in &mut self.tiles {
            for (count, &share) in tile.counts.iter_mut().zip(&tile.shares) {
                let next = sum + even + shared_out * f64::from(share);
                *count = ((next.round() - sum.round()) as u32).max(1);
                sum = next;
            }
        }
    }

    /// Settles the shares, by how the samples of `film` vary. They stay as they are where nothing does.
    fn settle(&mut self, film: &Film, objective: Objective) {
        let size = film.size();
        let place = |tile: &FilmTile, index: usize| {
            let (x, y) = tile.position(index);
            y as usize * size.width as usize + x as usize
        };
        let brightness = mean(film.pixels().map(|pixel| mean(pixel.mean())));
        let darkest = (DARKEST * brightness).powi(2);
        let mut errors = vec![Average::default(); size.pixels()];
        for (mine, tile) in self.tiles.iter().zip(film.tiles()) {
            let both = tile.pixels.iter().zip(&mine.squares).enumerate();
            for (index, (pixel, &square)) in both {
                let error = Known::of(&pixel, f64::from(square)).error(objective, darkest);
                errors[place(tile, index)] = Average::of(error);
            }
        }
        let errors = neighbourhood_sums(&errors, size, REACH);
        let share = |error: &Average| error.mean().sqrt();
        let most = LARGEST_SHARE * mean(errors.iter().map(share));
        let share = |error: &Average| share(error).min(most);
        let all = mean(errors.iter().map(share));
        if all > 0.0 && all.is_finite() {
            for (mine, tile) in self.tiles.iter_mut().zip(film.tiles()) {
                for (index, own) in mine.shares.iter_mut().enumerate() {
                    *own = (share(&errors[place(tile, index)]) / all) as f32;
                }
            }
        }
    }
}

/// What is known of a pixel, as a mean over its channels.
#[derive(Clone, Copy, Debug)]
struct Known {
    mean: f64,
    variance_of_mean: f64,
    /// The variance of one path.
    variance: f64,
}

impl Known {
    /// What the film knows of `pixel`, where the variance of its weighted sum is `squares` times that of one path.
    fn of(pixel: &PixelStatistics, squares: f64) -> Self {
        let variance_of_mean = mean(pixel.variance_of_mean().unwrap_or_default());
        Self {
            mean: mean(pixel.mean()),
            variance_of_mean,
            variance: variance_of_mean * pixel.weight * pixel.weight / squares,
        }
    }

    /// The error that one path leaves. A pixel that varies so much that its mean says nothing is not taken to be as dark as that.
    fn error(&self, objective: Objective, darkest: f64) -> f64 {
        let squared = self.mean * self.mean + self.variance_of_mean + darkest;
        match objective {
            Objective::Mse => self.variance,
            Objective::Relative if squared > 0.0 => self.variance / squared,
            Objective::Relative => 0.0,
        }
    }
}

/// A sum of so many numbers.
#[derive(Clone, Copy, Debug, Default)]
struct Average {
    sum: f64,
    count: f64,
}

impl Average {
    fn of(value: f64) -> Self {
        Self {
            sum: value,
            count: 1.0,
        }
    }

    fn mean(self) -> f64 {
        self.sum / self.count
    }
}

impl AddAssign for Average {
    fn add_assign(&mut self, other: Self) {
        self.sum += other.sum;
        self.count += other.count;
    }
}

fn mean(values: impl IntoIterator<Item = f64>) -> f64 {
    let mut all = Average::default();
    values
        .into_iter()
        .for_each(|value| all += Average::of(value));
    all.mean()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{FilmSums, TilePixels};
    use crate::scene::ImageSize;

    const SIZE: ImageSize = ImageSize {
        width: 40,
        height: 20,
    };

    /// A film of four passes of one sample, in whose right half they are `noise` times as far from `brightness(x)`, and what keeps count of it.
    fn seen(noise: f64, brightness: impl Fn(u32) -> f64) -> (Film, Allocation) {
        let mut film = Film::new(SIZE, FilmSums::Double);
        let mut allocation = Allocation::new(&film);
        for pass in 0..4 {
            for tile in film.tiles_mut() {
                for index in 0..tile.pixels.count() {
                    let (x, _) = tile.position(index);
                    let off = if x < SIZE.width / 2 { 0.1 } else { 0.1 * noise };
                    let off = if pass % 2 == 0 { off } else { -off };
                    let TilePixels::Double(pixels) = &mut tile.pixels else {
                        panic!("the film is one of doubles");
                    };
                    pixels[index].add_unit(1, 1.0, [brightness(x) * (1.0 + off); 3]);
                }
            }
            allocation.finish(1.0, 1);
        }
        (film, allocation)
    }

    /// The counts in a column away from the borders of the halves, and the sum of all.
    fn counted(film: &Film, allocation: &Allocation, mean: u32) -> ([u32; 2], u64) {
        let tiles = || film.tiles().iter().enumerate();
        let total =
            tiles().map(|(i, tile)| allocation.counts(i, mean).of_pixels(0..tile.pixels.count()));
        let at = |column: u32| {
            let here = tiles().find_map(|(i, tile)| {
                let is_here = |&index: &usize| tile.position(index) == (column, 9);
                let index = (0..tile.pixels.count()).find(is_here)?;
                Some(allocation.counts(i, mean).of_pixel(index))
            });
            here.expect("there is such a pixel")
        };
        ([at(8), at(31)], total.sum())
    }

    #[test]
    fn paths_go_where_they_vary() {
        let (film, mut allocation) = seen(3.0, |_| 1.0);
        allocation.plan(&film, Objective::Relative, Some(4), 40);
        let ([left, right], total) = counted(&film, &allocation, 40);
        assert_eq!(total, 40 * SIZE.pixels() as u64);
        // A quarter is even; of the rest, deviations of 1 and 3 take half and one and a half, but for the seam.
        assert!((24..=26).contains(&left), "{left}");
        assert!((53..=56).contains(&right), "{right}");
    }

    #[test]
    fn the_objective_decides_what_error_is() {
        for (objective, is_even) in [(Objective::Relative, true), (Objective::Mse, false)] {
            let (film, mut allocation) = seen(1.0, |x| if x < 20 { 1.0 } else { 5.0 });
            allocation.plan(&film, objective, Some(4), 32);
            let ([left, right], _) = counted(&film, &allocation, 32);
            assert_eq!(left.abs_diff(right) <= 2, is_even, "{left} {right}");
        }
    }

    #[test]
    fn every_pixel_gets_a_path_and_none_is_lost() {
        let (film, mut allocation) = seen(1e6, |_| 1.0);
        for mean in [1, 2, 3, 16, 256] {
            allocation.plan(&film, Objective::Mse, Some(4), mean);
            let ([left, right], total) = counted(&film, &allocation, mean);
            assert!(left >= 1 && right >= left, "{left} {right}");
            assert_eq!(total, u64::from(mean) * SIZE.pixels() as u64);
        }
    }

    #[test]
    fn shares_are_kept_until_there_is_much_more_to_go_by() {
        let (film, mut allocation) = seen(3.0, |_| 1.0);
        let counts = |allocation: &mut Allocation, film: &Film, before| {
            allocation.plan(film, Objective::Relative, before, 16);
            counted(film, allocation, 16).0
        };
        assert_eq!(counts(&mut allocation, &film, Some(3)), [16; 2]);
        let first = counts(&mut allocation, &film, Some(4));
        assert!(first[0] < first[1]);
        let (even, _) = seen(1.0, |_| 1.0);
        assert_eq!(counts(&mut allocation, &even, Some(15)), first);
        assert_eq!(counts(&mut allocation, &even, None), [16; 2]);
        assert_eq!(counts(&mut allocation, &even, Some(16)), [16; 2]);
    }

    #[test]
    fn without_noise_all_get_as_many() {
        let (film, mut allocation) = seen(0.0, |_| 0.0);
        allocation.plan(&film, Objective::Relative, Some(4), 16);
        assert_eq!(
            counted(&film, &allocation, 16),
            ([16; 2], 16 * SIZE.pixels() as u64)
        );
    }
}
