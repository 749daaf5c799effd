//! An estimator whose variance and bias are known, for tests: images without a renderer.

use super::reference::Reference;
use crate::film::{Image, PixelStatistics};
use crate::sampling::{RandomStream, StreamKey};
use crate::scene::ImageSize;

const SIZE: ImageSize = ImageSize {
    width: 16,
    height: 16,
};

/// Every pixel is its truth times 1 + bias + deviation (E - 1), with E exponential of mean 1: noise with a skewness of 2
/// and an excess kurtosis of 6, in all channels alike.
#[derive(Clone, Copy)]
pub(super) struct Synthetic {
    pub(super) deviation: f64,
    pub(super) bias: f64,
}

impl Synthetic {
    pub(super) fn image(self, random: &mut RandomStream) -> Image {
        let mut image = Image::black(SIZE);
        for y in 0..SIZE.height {
            for x in 0..SIZE.width {
                let factor = self.factor(random);
                *image.pixel_mut(x, y) = truth(x, y).map(|t| (t * factor) as f32);
            }
        }
        image
    }

    /// The mean squared error against the truth.
    pub(super) fn mse(self) -> f64 {
        self.mean_square(|_| 1.0)
    }

    /// The relative mean squared error against the truth.
    pub(super) fn relative_mse(self) -> f64 {
        let all = pixels().flat_map(|(x, y)| truth(x, y));
        let mean = all.sum::<f64>() / (3 * SIZE.pixels()) as f64;
        let epsilon = (0.01 * mean).powi(2);
        self.mean_square(|t| 1.0 / ((t.iter().sum::<f64>() / 3.0).powi(2) + epsilon))
    }

    /// A reference of `units` samples a pixel of an unbiased estimator, with the variance that it estimates of itself.
    pub(super) fn reference(units: u32, random: &mut RandomStream) -> Reference {
        let estimator = Self {
            deviation: 0.5,
            bias: 0.0,
        };
        let (mut image, mut variance) = (Image::black(SIZE), Image::black(SIZE));
        for (x, y) in pixels() {
            let mut pixel = PixelStatistics::<f64>::default();
            for _ in 0..units {
                let factor = estimator.factor(random);
                pixel.add_unit(1, 1.0, truth(x, y).map(|t| t * factor));
            }
            *image.pixel_mut(x, y) = pixel.mean().map(|v| v as f32);
            *variance.pixel_mut(x, y) = pixel.variance_of_mean().unwrap().map(|v| v as f32);
        }
        Reference::new(image, Some(variance)).unwrap()
    }

    fn factor(self, random: &mut RandomStream) -> f64 {
        let exponential = -(1.0 - random.uniform_f64()).ln();
        1.0 + self.bias + self.deviation * (exponential - 1.0)
    }

    fn mean_square(self, weight: impl Fn([f64; 3]) -> f64) -> f64 {
        let relative = self.deviation.powi(2) + self.bias.powi(2);
        let sum: f64 = pixels()
            .map(|(x, y)| {
                let t = truth(x, y);
                weight(t) * t.iter().map(|t| t * t).sum::<f64>()
            })
            .sum();
        relative * sum / (3 * SIZE.pixels()) as f64
    }
}

/// The first row sees a light.
pub(super) fn lit() -> Vec<bool> {
    pixels().map(|(_, y)| y == 0).collect()
}

/// The random numbers of a trial.
pub(super) fn stream(trial: u32) -> RandomStream {
    RandomStream::new(StreamKey {
        seed: 2026,
        tile: trial,
        pass: 0,
    })
}

fn pixels() -> impl Iterator<Item = (u32, u32)> {
    (0..SIZE.height).flat_map(|y| (0..SIZE.width).map(move |x| (x, y)))
}

/// Linear sRGB between 0.1 and 2.
fn truth(x: u32, y: u32) -> [f64; 3] {
    let brightness = 0.25 + f64::from(x) / 16.0 + 0.5 * f64::from(y) / 16.0;
    [brightness * 1.1, brightness, brightness * 0.5]
}
