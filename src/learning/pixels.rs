//! What is known of the image: how bright its pixels are, and what variance costs there.

use std::ops::AddAssign;

use serde::{Deserialize, Serialize};

use super::PixelObservation;
use crate::film::neighbourhood_sums;
use crate::scene::ImageSize;

/// Pixels on each side of one with which it is averaged.
const REACH: usize = 2;

/// No pixel is taken to be darker than this part of the mean of all.
const DARKEST: f32 = 0.01;

/// Of so many pixels at the most, those that vary most, nothing is learned of what variance costs: a single path that found a rare bright light would
/// speak for the whole image (Rath et al. 2022, the authors' implementation).
const OUTLIERS: usize = 10;

/// In small images, one pixel of so many.
const FEWEST_PER_OUTLIER: usize = 100;

/// The brightness of every pixel, and what relative variance costs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PixelKnowledge {
    /// Of every pixel, row by row: the mean radiance of it and its neighbours.
    brightness: Vec<f32>,
    relative_factor: f32,
    absolute_factor: f32,
}

impl PixelKnowledge {
    /// What the observations of all pixels of a film of `size` say.
    pub(super) fn new(pixels: &[PixelObservation], size: ImageSize) -> Self {
        if pixels.len() != size.pixels() {
            return Self::default();
        }
        let sums: Vec<Sum> = pixels.iter().map(Sum::of).collect();
        let near = neighbourhood_sums(&sums, size, REACH);
        let mut all = Sum::default();
        sums.into_iter().for_each(|sum| all += sum);
        let darkest = DARKEST * all.mean();
        let brightness: Vec<f32> = near.iter().map(|sum| sum.mean().max(darkest)).collect();
        let mut relative = Vec::with_capacity(pixels.len());
        let mut absolute = Vec::with_capacity(pixels.len());
        for (pixel, &brightness) in pixels.iter().zip(&brightness) {
            let brightness = f64::from(brightness);
            if pixel.paths > 0 && brightness > 0.0 {
                let variance = f64::from(pixel.paths) * pixel.variance(brightness);
                let cost = f64::from(pixel.cost);
                absolute.push(Price { variance, cost });
                let variance = variance / (brightness * brightness);
                relative.push(Price { variance, cost });
            }
        }
        Self {
            brightness,
            relative_factor: factor(&mut relative),
            absolute_factor: factor(&mut absolute),
        }
    }

    /// The mean radiance about pixel number `pixel`; 0 while nothing is known.
    #[inline]
    pub fn brightness(&self, pixel: u32) -> f32 {
        self.brightness.get(pixel as usize).copied().unwrap_or(0.0)
    }

    /// The square root of the mean cost of a path, in bounces, over the mean of its variance relative to the brightness of its pixel.
    pub fn relative_factor(&self) -> f32 {
        self.relative_factor
    }

    /// The square root of the mean cost of a path, in bounces, over the mean of its variance.
    pub fn absolute_factor(&self) -> f32 {
        self.absolute_factor
    }
}

/// What the paths of a pixel leave in variance, and what they cost in bounces.
#[derive(Clone, Copy, Debug)]
struct Price {
    variance: f64,
    cost: f64,
}

/// The square root of all cost over all variance, without those of the pixels that vary most; 1 where nothing varies.
fn factor(prices: &mut [Price]) -> f32 {
    let outliers = OUTLIERS.min(prices.len() / FEWEST_PER_OUTLIER);
    let kept = prices.len() - outliers;
    if outliers > 0 {
        prices.select_nth_unstable_by(kept, |one, other| one.variance.total_cmp(&other.variance));
    }
    let kept = &prices[..kept];
    let sum = |number: fn(&Price) -> f64| kept.iter().map(number).sum::<f64>();
    let [variance, cost] = [sum(|price| price.variance), sum(|price| price.cost)];
    if variance > 0.0 {
        (cost / variance).sqrt() as f32
    } else {
        1.0
    }
}

#[derive(Clone, Copy, Default)]
struct Sum {
    radiance: f64,
    paths: f64,
}

impl Sum {
    fn of(pixel: &PixelObservation) -> Self {
        Self {
            radiance: f64::from(pixel.radiance),
            paths: f64::from(pixel.paths),
        }
    }

    fn mean(&self) -> f32 {
        if self.paths > 0.0 {
            (self.radiance / self.paths) as f32
        } else {
            0.0
        }
    }
}

impl AddAssign for Sum {
    fn add_assign(&mut self, other: Self) {
        self.radiance += other.radiance;
        self.paths += other.paths;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: ImageSize = ImageSize {
        width: 7,
        height: 6,
    };

    fn observed(radiance: impl Fn(u32, u32) -> f32) -> Vec<PixelObservation> {
        let pixel = |index: u32| {
            let radiance = radiance(index % SIZE.width, index / SIZE.width);
            PixelObservation {
                pixel: index,
                paths: 2,
                // One path brought it all.
                radiance,
                noisy: radiance,
                square: radiance * radiance,
                cost: 10.0,
            }
        };
        (0..SIZE.width * SIZE.height).map(pixel).collect()
    }

    #[test]
    fn brightness_is_the_mean_of_the_neighbours() {
        let radiance = |x: u32, y: u32| (1 + x * x + 10 * y) as f32;
        let knowledge = PixelKnowledge::new(&observed(radiance), SIZE);
        for (x, y) in (0..SIZE.width).flat_map(|x| (0..SIZE.height).map(move |y| (x, y))) {
            let near = |a: u32, b: u32| a.abs_diff(b) <= REACH as u32;
            let columns = (0..SIZE.width).filter(|&column| near(column, x));
            let neighbours = columns.flat_map(|column| {
                let rows = (0..SIZE.height).filter(|&row| near(row, y));
                rows.map(move |row| 0.5 * radiance(column, row))
            });
            let count = neighbours.clone().count() as f32;
            let expected = neighbours.sum::<f32>() / count;
            let brightness = knowledge.brightness(y * SIZE.width + x);
            assert!((brightness - expected).abs() < 1e-4 * expected, "{x} {y}");
        }
    }

    #[test]
    fn no_pixel_is_taken_to_be_black() {
        let corner = |x, y| if (x, y) == (0, 0) { 84.0 } else { 0.0 };
        let knowledge = PixelKnowledge::new(&observed(corner), SIZE);
        // 84 in 42 pixels of two paths: the mean is 1.
        assert_eq!(knowledge.brightness(0), 84.0 / 18.0);
        assert_eq!(knowledge.brightness(41), DARKEST);
    }

    #[test]
    fn the_factor_is_that_of_cost_and_relative_variance() {
        // Of two paths one brings 2 and the other nothing: mean 1, variance 2, at a cost of five each.
        let knowledge = PixelKnowledge::new(&observed(|_, _| 2.0), SIZE);
        assert!((knowledge.relative_factor() - 2.5_f32.sqrt()).abs() < 1e-5);
        let brighter = PixelKnowledge::new(&observed(|_, _| 2000.0), SIZE);
        assert!((brighter.relative_factor() - knowledge.relative_factor()).abs() < 1e-5);
        let dearer = brighter.absolute_factor() * 1000.0;
        assert!((dearer - knowledge.absolute_factor()).abs() < 1e-4);
    }

    /// Ten fireflies among a thousand pixels, or eleven.
    #[test]
    fn a_few_bright_paths_do_not_speak_for_the_image() {
        let prices = |fireflies: usize| {
            let price = |i| Price {
                variance: if i < fireflies { 1e9 } else { 4.0 },
                cost: 9.0,
            };
            (0..1000).map(price).collect::<Vec<_>>()
        };
        assert_eq!(factor(&mut prices(0)), 1.5);
        assert_eq!(factor(&mut prices(10)), 1.5);
        assert!(factor(&mut prices(11)) < 0.01);
        assert!(factor(&mut prices(1)[..99]) < 0.01);
        assert_eq!(factor(&mut []), 1.0);
    }

    #[test]
    fn where_nothing_was_seen_nothing_is_known() {
        for pixels in [Vec::new(), observed(|_, _| 1.0).split_off(1)] {
            let knowledge = PixelKnowledge::new(&pixels, SIZE);
            assert_eq!(knowledge.brightness(0), 0.0);
        }
        let black = PixelKnowledge::new(&observed(|_, _| 0.0), SIZE);
        assert_eq!((black.brightness(0), black.relative_factor()), (0.0, 1.0));
        assert_eq!(black.brightness(1000), 0.0);
    }
}
