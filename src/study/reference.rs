//! What errors are measured against: an image, and how far it may itself be off.

use std::path::{Path, PathBuf};

use thiserror::Error;

use super::measures::{LUMINANCE, relative_weight};
use crate::film::{FilmFileError, Image, read_exr, read_exr_variance};
use crate::scene::ImageSize;

/// A reference image of linear sRGB values, with the estimated variance of its pixels where it is known.
#[derive(Clone, Debug)]
pub struct Reference {
    image: Image,
    variance: Option<Image>,
    /// The constant e of relative errors; see [`super::results::Errors`].
    epsilon: f64,
}

/// Why an image cannot be a reference.
#[derive(Debug, Error)]
pub enum ReferenceError {
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] FilmFileError),
    /// It is of another size than the images that it would be compared with.
    #[error(
        "the reference {} has {} x {} pixels, but the scene's images have {} x {}: render it at the same size",
        path.display(), found.width, found.height, wanted.width, wanted.height
    )]
    Size {
        /// The file.
        path: PathBuf,
        /// Its size.
        found: ImageSize,
        /// The size of the scene's images.
        wanted: ImageSize,
    },
    /// The variance is of another size than the image.
    #[error(
        "the reference's variance has {} x {} pixels, but the image has {} x {}",
        variance.width, variance.height, image.width, image.height
    )]
    VarianceSize {
        /// Size of the image.
        image: ImageSize,
        /// Size of the variance.
        variance: ImageSize,
    },
    /// A value is infinite or not a number.
    #[error("the reference's pixel in column {x}, row {y} (from 0) is not finite: {value:?}")]
    NotFinite {
        /// Column.
        x: u32,
        /// Row.
        y: u32,
        /// Its channels.
        value: [f32; 3],
    },
    /// A variance is negative, infinite or not a number.
    #[error(
        "the reference's variance in column {x}, row {y} (from 0) is {value:?}; it must be 0 or more"
    )]
    Variance {
        /// Column.
        x: u32,
        /// Row.
        y: u32,
        /// Its channels.
        value: [f32; 3],
    },
    /// Nothing can be relative to it.
    #[error("the reference is black, and errors cannot be relative to it")]
    Black,
}

impl Reference {
    /// A reference whose pixels are means with the variances `variance`, if they are known.
    pub fn new(image: Image, variance: Option<Image>) -> Result<Self, ReferenceError> {
        if let Some((x, y, value)) = find(&image, |value| !value.is_finite()) {
            return Err(ReferenceError::NotFinite { x, y, value });
        }
        if let Some(variance) = &variance {
            if variance.size() != image.size() {
                return Err(ReferenceError::VarianceSize {
                    image: image.size(),
                    variance: variance.size(),
                });
            }
            let wrong = |value: f32| !(value >= 0.0 && value.is_finite());
            if let Some((x, y, value)) = find(variance, wrong) {
                return Err(ReferenceError::Variance { x, y, value });
            }
        }
        let mean = image.mean();
        let (mean, luminance) = (mean.iter().sum::<f64>() / 3.0, luminance(mean));
        if !(mean > 0.0 && luminance > 0.0) {
            return Err(ReferenceError::Black);
        }
        Ok(Self {
            image,
            variance,
            epsilon: (0.01 * mean).powi(2),
        })
    }

    /// An EXR of the size `wanted`, with its variance where it has the channels `variance.R`, `variance.G` and `variance.B`.
    pub fn from_file(path: &Path, wanted: ImageSize) -> Result<Self, ReferenceError> {
        let image = read_exr(path)?;
        if image.size() != wanted {
            return Err(ReferenceError::Size {
                path: path.to_owned(),
                found: image.size(),
                wanted,
            });
        }
        Self::new(image, read_exr_variance(path)?)
    }

    /// The image.
    pub fn image(&self) -> &Image {
        &self.image
    }

    /// The estimated variance of every pixel, if it is known.
    pub fn variance_image(&self) -> Option<&Image> {
        self.variance.as_ref()
    }

    /// The constant e of relative errors: a hundredth of the mean over all pixels and channels, squared.
    pub fn epsilon(&self) -> f64 {
        self.epsilon
    }

    /// The mean luminance.
    pub fn mean_luminance(&self) -> f64 {
        luminance(self.image.mean())
    }

    /// The mean variance over pixels and channels, if it is known: what is subtracted from squared errors.
    pub fn variance(&self) -> Option<f64> {
        self.mean_of_variance(|_| 1.0)
    }

    /// The same for the relative squared error.
    pub fn relative_variance(&self) -> Option<f64> {
        self.mean_of_variance(|pixel| relative_weight(pixel, self.epsilon))
    }

    /// Standard error of the mean luminance as a share of it, if variances are known.
    ///
    /// Pixels are independent. The channels of a pixel, whose correlation is not known, are taken to err together, as they
    /// nearly do where light is white: that is the upper limit.
    pub fn mean_error(&self) -> Option<f64> {
        let variance = self.variance.as_ref()?;
        let deviation = |pixel: &[f32; 3]| luminance(pixel.map(|v| f64::from(v).sqrt()));
        let squares: f64 = variance.pixels().iter().map(|p| deviation(p).powi(2)).sum();
        let pixels = variance.pixels().len() as f64;
        Some(squares.sqrt() / pixels / self.mean_luminance())
    }

    /// The mean of the variance, weighted by a function of the image's pixel.
    fn mean_of_variance(&self, weight: impl Fn([f32; 3]) -> f64) -> Option<f64> {
        let variance = self.variance.as_ref()?;
        let pixels = self.image.pixels().iter().zip(variance.pixels());
        let sum: f64 = pixels
            .map(|(&pixel, variance)| {
                weight(pixel) * variance.iter().map(|v| f64::from(*v)).sum::<f64>()
            })
            .sum();
        Some(sum / (3 * variance.pixels().len()) as f64)
    }
}

/// Luminance of linear sRGB.
fn luminance(rgb: [f64; 3]) -> f64 {
    rgb.iter()
        .zip(LUMINANCE)
        .map(|(c, weight)| c * weight)
        .sum()
}

/// The first pixel with a channel of which `wrong` holds: column, row and value.
fn find(image: &Image, wrong: impl Fn(f32) -> bool) -> Option<(u32, u32, [f32; 3])> {
    let pixels = image.pixels();
    let index = pixels
        .iter()
        .position(|pixel| pixel.iter().any(|&value| wrong(value)))?;
    let width = image.size().width as usize;
    let (x, y) = ((index % width) as u32, (index / width) as u32);
    Some((x, y, pixels[index]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{ExrOptions, write_exr};

    const SIZE: ImageSize = ImageSize {
        width: 2,
        height: 1,
    };

    fn image(pixels: [[f32; 3]; 2]) -> Image {
        let mut image = Image::black(SIZE);
        *image.pixel_mut(0, 0) = pixels[0];
        *image.pixel_mut(1, 0) = pixels[1];
        image
    }

    #[test]
    fn its_own_error_is_that_of_its_pixels() {
        let variance = image([[0.03; 3], [0.01; 3]]);
        let reference = Reference::new(image([[2.0; 3], [4.0; 3]]), Some(variance)).unwrap();
        let near = |a: Option<f64>, b: f64| (a.unwrap() / b - 1.0).abs() < 1e-5;
        assert!(near(reference.variance(), 0.02));
        let e = 0.03_f64 * 0.03;
        let relative = (0.03 / (4.0 + e) + 0.01 / (16.0 + e)) / 2.0;
        assert!(near(reference.relative_variance(), relative));
        // The mean of two pixels of variance 0.03 and 0.01 has variance 0.04 / 4.
        assert!(near(reference.mean_error(), 0.1 / 3.0));
    }

    #[test]
    fn files_have_a_variance_or_not() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("reference.exr");
        let mut options = ExrOptions::default();
        write_exr(&path, &image([[1.0; 3]; 2]), &options).unwrap();
        let plain = Reference::from_file(&path, SIZE).unwrap();
        assert_eq!((plain.variance(), plain.mean_error()), (None, None));
        options.variance = Some(image([[0.25; 3]; 2]));
        write_exr(&path, &image([[1.0; 3]; 2]), &options).unwrap();
        let known = Reference::from_file(&path, SIZE).unwrap();
        assert_eq!(known.variance(), Some(0.25));
        let wanted = ImageSize {
            width: 4,
            height: 3,
        };
        let error = Reference::from_file(&path, wanted).unwrap_err().to_string();
        assert!(
            error.contains("2 x 1") && error.contains("4 x 3"),
            "{error}"
        );
    }

    #[test]
    fn what_cannot_be_a_reference_is_refused() {
        let message = |pixels, variance: Option<[[f32; 3]; 2]>| {
            let error = Reference::new(image(pixels), variance.map(image)).unwrap_err();
            error.to_string()
        };
        let ones = [[1.0; 3]; 2];
        assert!(message([[0.0; 3]; 2], None).contains("black"));
        assert!(message([[1.0; 3], [1.0, f32::NAN, 0.0]], None).contains("column 1, row 0"));
        assert!(message(ones, Some([[-1.0; 3], [0.0; 3]])).contains("column 0, row 0"));
    }
}
