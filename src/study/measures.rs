//! How far images are from a reference: the measures of [`Errors`], by their definitions there.

use super::flip::mean_flip;
use super::reference::Reference;
use super::results::{ErrorIntervals, Errors, RegionErrors, VarianceIntervals};
use super::statistics::{Interval, products};
use crate::film::Image;

/// Luminance of linear sRGB (ITU-R BT.709): the weights of R, G and B.
pub(super) const LUMINANCE: [f64; 3] = [0.212_671, 0.715_160, 0.072_169];

/// The errors of `image` against `reference`.
///
/// `lit` says of every pixel, row by row from the top, whether it sees a light directly. A region without pixels has errors
/// of 0. With `flip`, the mean LDR-FLIP is computed too, which takes longer than all else.
///
/// # Panics
/// Where the images and `lit` differ in size.
pub fn errors(image: &Image, reference: &Reference, lit: &[bool], flip: bool) -> Errors {
    assert_eq!(image.size(), reference.image().size());
    assert_eq!(image.pixels().len(), lit.len());
    let (mut in_light, mut elsewhere) = (Sums::default(), Sums::default());
    for (index, &lit) in lit.iter().enumerate() {
        let region = if lit { &mut in_light } else { &mut elsewhere };
        let variance = reference
            .variance_image()
            .map(|image| image.pixels()[index]);
        region.add(
            image.pixels()[index],
            reference.image().pixels()[index],
            variance.unwrap_or_default(),
            reference.epsilon(),
        );
    }
    let all = in_light.plus(elsewhere).means();
    Errors {
        mse: all.mse,
        relative_mse: all.relative_mse,
        bias: mean_luminance(image) / reference.mean_luminance() - 1.0,
        lit: in_light.means(),
        reflected: elsewhere.means(),
        flip: flip.then(|| mean_flip(image, reference.image())),
    }
}

/// The relative squared error of every pixel, row by row from the top: the mean over its channels, without the
/// subtraction of the reference's variance, so that no value is negative.
///
/// # Panics
/// Where the images differ in size.
pub fn relative_error_map(image: &Image, reference: &Reference) -> Vec<f32> {
    assert_eq!(image.size(), reference.image().size());
    let pixels = image.pixels().iter().zip(reference.image().pixels());
    pixels
        .map(|(x, r)| {
            let mut pixel = Sums::default();
            pixel.add(*x, *r, [0.0; 3], reference.epsilon());
            pixel.means().relative_mse as f32
        })
        .collect()
}

/// The variance of one image, estimated between independent repetitions, in the mean over pixels and channels; `None`
/// with fewer than two of them.
///
/// The estimate is the mean of what each image has to do with it: n / (n - 1) times its mean squared distance from the
/// mean of the n images. The intervals come from how these differ. `lit` is as for [`errors`].
///
/// # Panics
/// Where the images and `lit` differ in size.
pub fn variance_between(images: &[Image], lit: &[bool]) -> Option<VarianceIntervals> {
    let [_, _, ..] = images else {
        return None;
    };
    let mut regions = vec![[RegionSquares::default(); 2]; images.len()];
    for (index, &lit) in lit.iter().enumerate() {
        for channel in 0..3 {
            let value = |image: &Image| f64::from(image.pixels()[index][channel]);
            let mean = images.iter().map(value).sum::<f64>() / images.len() as f64;
            for (image, regions) in images.iter().zip(&mut regions) {
                let region = &mut regions[usize::from(lit)];
                region.squares += (value(image) - mean).powi(2);
                region.channels += 1;
            }
        }
    }
    let unbiased = images.len() as f64 / (images.len() - 1) as f64;
    let interval = |squares: fn(&[RegionSquares; 2]) -> RegionSquares| {
        let shares = regions.iter().map(|regions| {
            let RegionSquares { squares, channels } = squares(regions);
            unbiased * squares / channels.max(1) as f64
        });
        Interval::of_positive(&shares.collect::<Vec<_>>())
    };
    Some(VarianceIntervals {
        all: interval(|[reflected, lit]| RegionSquares {
            squares: reflected.squares + lit.squares,
            channels: reflected.channels + lit.channels,
        }),
        lit: interval(|[_, lit]| *lit),
        reflected: interval(|[reflected, _]| *reflected),
    })
}

/// Squared distances of one image from the mean of all, summed over the pixels of a region.
#[derive(Clone, Copy, Default)]
struct RegionSquares {
    squares: f64,
    channels: u64,
}

/// The measures of a competitor at one point of its budget, by repetition; all slices have one value for each.
#[derive(Clone, Copy, Debug)]
pub struct Repetitions<'a> {
    /// Errors of the images.
    pub errors: &'a [Errors],
    /// Seconds that the images took.
    pub seconds: &'a [f64],
    /// Rays that they took, where they are counted.
    pub rays: Option<&'a [f64]>,
    /// The variance between the images ([`variance_between`]).
    pub variance: Option<VarianceIntervals>,
}

impl Repetitions<'_> {
    /// Means with their 95 % intervals. That of the bias includes the standard error of the reference, if it is known.
    pub fn intervals(&self, reference: &Reference) -> ErrorIntervals {
        let of = |value: fn(&Errors) -> f64| Interval::of_positive(&self.column(value));
        let mse = of(|e| e.mse);
        let flip: Option<Vec<f64>> = self.errors.iter().map(|e| e.flip).collect();
        ErrorIntervals {
            mse,
            rmse: mse.square_root(),
            relative_mse: of(|e| e.relative_mse),
            bias: bias(&self.column(|e| e.bias), reference),
            lit_mse: of(|e| e.lit.mse),
            reflected_mse: of(|e| e.reflected.mse),
            lit_relative_mse: of(|e| e.lit.relative_mse),
            reflected_relative_mse: of(|e| e.reflected.relative_mse),
            variance: self.variance,
            efficiency: efficiency(&self.column(|e| e.mse), self.seconds),
            relative_efficiency: efficiency(&self.column(|e| e.relative_mse), self.seconds),
            ray_efficiency: self
                .rays
                .map(|rays| efficiency(&self.column(|e| e.relative_mse), rays)),
            flip: flip
                .filter(|values| !values.is_empty())
                .map(|values| Interval::of_positive(&values)),
        }
    }

    /// One measure of all repetitions.
    pub(super) fn column(&self, value: fn(&Errors) -> f64) -> Vec<f64> {
        self.errors.iter().map(value).collect()
    }
}

/// The weight of squared errors in a pixel that has the value `reference`: 1 / (m^2 + e).
pub(super) fn relative_weight(reference: [f32; 3], epsilon: f64) -> f64 {
    let mean = reference.iter().map(|c| f64::from(*c)).sum::<f64>() / 3.0;
    1.0 / (mean * mean + epsilon)
}

fn efficiency(errors: &[f64], costs: &[f64]) -> Interval {
    Interval::of_positive(&products(errors, costs)).reciprocal()
}

/// The mean of `biases` against a reference whose mean, below the fraction, is off by a known standard error.
pub(super) fn bias(biases: &[f64], reference: &Reference) -> Interval {
    let fraction = 1.0 + biases.iter().sum::<f64>() / biases.len() as f64;
    // The error of the fraction x / r is that of r times the fraction.
    let shared = reference.mean_error().map_or(0.0, |error| error * fraction);
    Interval::of_mean_with_error(biases, shared)
}

fn mean_luminance(image: &Image) -> f64 {
    let mean = image.mean();
    mean.iter()
        .zip(LUMINANCE)
        .map(|(c, weight)| c * weight)
        .sum()
}

/// Sums over the pixels of a region.
#[derive(Clone, Copy, Default)]
struct Sums {
    squares: f64,
    relative: f64,
    channels: u64,
}

impl Sums {
    fn add(&mut self, x: [f32; 3], r: [f32; 3], variance: [f32; 3], epsilon: f64) {
        let mut squares = 0.0;
        for channel in 0..3 {
            let difference = f64::from(x[channel]) - f64::from(r[channel]);
            squares += difference * difference - f64::from(variance[channel]);
        }
        self.squares += squares;
        self.relative += squares * relative_weight(r, epsilon);
        self.channels += 3;
    }

    fn plus(self, other: Self) -> Self {
        Self {
            squares: self.squares + other.squares,
            relative: self.relative + other.relative,
            channels: self.channels + other.channels,
        }
    }

    fn means(self) -> RegionErrors {
        let n = self.channels.max(1) as f64;
        RegionErrors {
            mse: self.squares / n,
            relative_mse: self.relative / n,
        }
    }
}
