//! What is known of the image: how bright its pixels are, and what variance costs there.

use serde::{Deserialize, Serialize};

use super::PixelObservation;
use crate::scene::ImageSize;

/// Pixels on each side of one with which it is averaged.
const REACH: usize = 2;

/// No pixel is taken to be darker than this part of the mean of all.
const DARKEST: f32 = 0.01;

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
        let [width, height] = [size.width as usize, size.height as usize];
        if pixels.len() != width * height {
            return Self::default();
        }
        let mut rows = vec![Sum::default(); pixels.len()];
        let mut both = rows.clone();
        for (i, row) in rows.iter_mut().enumerate() {
            let (x, start) = (i % width, i / width * width);
            let (first, last) = (x.saturating_sub(REACH), (x + REACH).min(width - 1));
            for pixel in &pixels[start + first..=start + last] {
                row.add(&Sum::of(pixel));
            }
        }
        for (i, sum) in both.iter_mut().enumerate() {
            let (x, y) = (i % width, i / width);
            let (first, last) = (y.saturating_sub(REACH), (y + REACH).min(height - 1));
            (first..=last).for_each(|y| sum.add(&rows[y * width + x]));
        }
        let all = rows
            .iter()
            .zip(pixels)
            .fold(Sum::default(), |mut all, (_, pixel)| {
                all.add(&Sum::of(pixel));
                all
            });
        let darkest = DARKEST * all.mean();
        let brightness: Vec<f32> = both.iter().map(|sum| sum.mean().max(darkest)).collect();
        let (mut rays, mut relative, mut absolute) = (0.0, 0.0, 0.0);
        for (pixel, &brightness) in pixels.iter().zip(&brightness) {
            let brightness = f64::from(brightness);
            if pixel.paths > 0 && brightness > 0.0 {
                let variance = f64::from(pixel.paths) * pixel.variance(brightness);
                absolute += variance;
                relative += variance / (brightness * brightness);
                rays += f64::from(pixel.rays);
            }
        }
        let factor = |variance: f64| {
            if variance > 0.0 {
                (rays / variance).sqrt() as f32
            } else {
                1.0
            }
        };
        Self {
            brightness,
            relative_factor: factor(relative),
            absolute_factor: factor(absolute),
        }
    }

    /// The mean radiance about pixel number `pixel`; 0 while nothing is known.
    #[inline]
    pub fn brightness(&self, pixel: u32) -> f32 {
        self.brightness.get(pixel as usize).copied().unwrap_or(0.0)
    }

    /// The square root of the mean cost of a path, in rays, over the mean of its variance relative to the brightness of its pixel.
    pub fn relative_factor(&self) -> f32 {
        self.relative_factor
    }

    /// The square root of the mean cost of a path, in rays, over the mean of its variance.
    pub fn absolute_factor(&self) -> f32 {
        self.absolute_factor
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

    fn add(&mut self, other: &Self) {
        self.radiance += other.radiance;
        self.paths += other.paths;
    }

    fn mean(&self) -> f32 {
        if self.paths > 0.0 {
            (self.radiance / self.paths) as f32
        } else {
            0.0
        }
    }
}
