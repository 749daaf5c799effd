//! `hdrfilm`: what the image is made of, with the reconstruction filters `box`, `tent`, `gaussian` and `mitchell`.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `width`, `height` | integer | size in pixels | 768, 576 |
//! | `crop_offset_x`, `crop_offset_y` | integer | first column and row that are rendered | 0 |
//! | `crop_width`, `crop_height` | integer | how many columns and rows are rendered | all |
//! | `pixel_format` | string | `rgb`, or `luminance` | rgb |
//! | `component_format` | string | `float16` or `float32`, the numbers in the EXR | float32 |
//! | `file_format` | string | `openexr` | openexr |
//! | `sample_border` | boolean | also sample beyond the border, as far as the filter reaches | false |
//! | nested filter | | `box`; `tent` (`radius` 1); `gaussian` (`stddev` 0.5, cut at four of them); `mitchell` (`B`, `C` 1/3) | gaussian |

use serde::{Deserialize, Serialize};
use thiserror::Error;

use crate::scene::error::SceneError;
use crate::scene::xml::{Class, Object};

/// Size of an image in pixels; both sides are positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ImageSize {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl ImageSize {
    /// The largest side that is accepted, in pixels.
    pub const MAX_SIDE: u32 = 1 << 16;

    /// Number of pixels.
    pub fn pixels(&self) -> usize {
        self.width as usize * self.height as usize
    }
}

/// The part of the film that is rendered: it lies inside the film and is not empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CropWindow {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Its size, which is the size of the image.
    pub size: ImageSize,
}

/// Which channels the EXR has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelFormat {
    /// R, G and B, linear sRGB.
    Rgb,
    /// Y, the luminance.
    Luminance,
}

/// What cannot be a film.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum FilmError {
    /// Size out of range.
    #[error("the film is {width} x {height} pixels; each side must be from 1 to {max}", max = ImageSize::MAX_SIDE)]
    Size {
        /// Columns asked for.
        width: i64,
        /// Rows asked for.
        height: i64,
    },
    /// Crop window out of the film.
    #[error(
        "the crop window of {columns} x {rows} pixels at ({x}, {y}) must have pixels and lie inside the film of {width} x {height}"
    )]
    Crop {
        /// First column of the window.
        x: i64,
        /// First row of the window.
        y: i64,
        /// Columns of the window.
        columns: i64,
        /// Rows of the window.
        rows: i64,
        /// Columns of the film.
        width: u32,
        /// Rows of the film.
        height: u32,
    },
}

/// A film as the scene states it.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmDescription {
    /// Size of the whole film, which the field of view refers to.
    pub size: ImageSize,
    /// The part that is rendered.
    pub crop: CropWindow,
    /// How samples become pixels.
    pub filter: ReconstructionFilter,
    /// Whether samples may lie beyond the crop window, as far as the filter reaches.
    pub sample_border: bool,
    /// Channels of the EXR.
    pub pixel_format: PixelFormat,
    /// Whether the EXR stores 16-bit instead of 32-bit numbers.
    pub half_precision: bool,
}

impl Default for FilmDescription {
    /// The film of a sensor that states none.
    fn default() -> Self {
        let size = ImageSize {
            width: 768,
            height: 576,
        };
        Self {
            size,
            crop: CropWindow { x: 0, y: 0, size },
            filter: ReconstructionFilter::Gaussian { stddev: 0.5 },
            sample_border: false,
            pixel_format: PixelFormat::Rgb,
            half_precision: false,
        }
    }
}

impl FilmDescription {
    pub(super) fn load(object: &Object) -> Result<Self, SceneError> {
        if object.plugin != "hdrfilm" {
            return Err(object.unsupported(&["hdrfilm"]));
        }
        let refuse = |error: FilmError| object.error(error.to_string());
        let size = (
            object.integer_or("width", 768)?,
            object.integer_or("height", 576)?,
        );
        let offset = (
            object.integer_or("crop_offset_x", 0)?,
            object.integer_or("crop_offset_y", 0)?,
        );
        let crop = (
            object.integer("crop_width")?,
            object.integer("crop_height")?,
        );
        let mut film = Self::new(size.0, size.1).map_err(refuse)?;
        let crop = (
            crop.0.unwrap_or(size.0.saturating_sub(offset.0)),
            crop.1.unwrap_or(size.1.saturating_sub(offset.1)),
        );
        film = film.cropped(offset, crop).map_err(refuse)?;
        film.filter = match object.child(Class::ReconstructionFilter)? {
            Some(child) => ReconstructionFilter::load(&child.object)?,
            None => Self::default().filter,
        };
        film.sample_border = object.boolean_or("sample_border", false)?;
        film.pixel_format = match choice(object, "pixel_format", &["rgb", "luminance"])? {
            "luminance" => PixelFormat::Luminance,
            _ => PixelFormat::Rgb,
        };
        film.half_precision =
            choice(object, "component_format", &["float32", "float16"])? == "float16";
        choice(object, "file_format", &["openexr", "exr"])?;
        object.finish()?;
        Ok(film)
    }

    /// The same film in another size, uncropped.
    pub fn resized(&self, width: i64, height: i64) -> Result<Self, FilmError> {
        let sized = Self::new(width, height)?;
        Ok(Self {
            size: sized.size,
            crop: sized.crop,
            ..self.clone()
        })
    }

    /// An uncropped film of this size with the box filter.
    pub fn new(width: i64, height: i64) -> Result<Self, FilmError> {
        let side = |n: i64| {
            u32::try_from(n)
                .ok()
                .filter(|n| (1..=ImageSize::MAX_SIDE).contains(n))
        };
        let (Some(w), Some(h)) = (side(width), side(height)) else {
            return Err(FilmError::Size { width, height });
        };
        let size = ImageSize {
            width: w,
            height: h,
        };
        Ok(Self {
            size,
            crop: CropWindow { x: 0, y: 0, size },
            filter: ReconstructionFilter::Box,
            sample_border: false,
            pixel_format: PixelFormat::Rgb,
            half_precision: false,
        })
    }

    /// The same film with a crop window: offset and size in pixels.
    pub fn cropped(mut self, offset: (i64, i64), size: (i64, i64)) -> Result<Self, FilmError> {
        let fits = |offset: i64, length: i64, side: u32| {
            offset >= 0 && length > 0 && offset.saturating_add(length) <= i64::from(side)
        };
        let ImageSize { width, height } = self.size;
        if !(fits(offset.0, size.0, width) && fits(offset.1, size.1, height)) {
            return Err(FilmError::Crop {
                x: offset.0,
                y: offset.1,
                columns: size.0,
                rows: size.1,
                width,
                height,
            });
        }
        self.crop = CropWindow {
            x: offset.0 as u32,
            y: offset.1 as u32,
            size: ImageSize {
                width: size.0 as u32,
                height: size.1 as u32,
            },
        };
        Ok(self)
    }
}

/// A separable reconstruction filter, by its profile along one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReconstructionFilter {
    /// Every sample counts for the pixel in which it lies.
    Box,
    /// Linear falloff to zero at `radius` pixels.
    Tent {
        /// Radius in pixels, positive.
        radius: f32,
    },
    /// A Gaussian, cut at four standard deviations and lowered so that it ends at zero.
    Gaussian {
        /// Standard deviation in pixels, positive.
        stddev: f32,
    },
    /// The cubic filter of Mitchell and Netravali 1988, of radius 2, with negative lobes.
    Mitchell {
        /// Blur, B in the paper.
        b: f32,
        /// Ringing, C in the paper.
        c: f32,
    },
}

/// The value of a string parameter that must be one of `choices`, the first of which is the default.
fn choice(
    object: &Object,
    name: &'static str,
    choices: &[&'static str],
) -> Result<&'static str, SceneError> {
    let given = object.string_or(name, choices[0])?;
    choices
        .iter()
        .find(|choice| choice.eq_ignore_ascii_case(given))
        .copied()
        .ok_or_else(|| {
            let message = format!(
                "`{name}` is `{given}`; it must be one of {}",
                choices.join(", ")
            );
            object.parameter_error(name, message)
        })
}

impl ReconstructionFilter {
    fn load(object: &Object) -> Result<Self, SceneError> {
        let positive = |name, default| -> Result<f32, SceneError> {
            let value = object.float_or(name, default)? as f32;
            // A filter wider than this is a mistake, and its tables would be large; a far narrower one is lost to rounding.
            if (0.001..=64.0).contains(&value) {
                return Ok(value);
            }
            Err(object.parameter_error(
                name,
                format!("`{name}` is {value}; it must be from 0.001 to 64"),
            ))
        };
        // Mitchell and Netravali study both in [0, 1]; far beyond, the filter's lobes cancel it.
        let cubic = |name| -> Result<f32, SceneError> {
            let value = object.float_or(name, 1.0 / 3.0)?;
            if (0.0..=1.0).contains(&value) {
                return Ok(value as f32);
            }
            let message = format!("`{name}` is {value}; it must be from 0 to 1");
            Err(object.parameter_error(name, message))
        };
        let filter = match object.plugin.as_str() {
            "box" => Self::Box,
            "tent" => Self::Tent {
                radius: positive("radius", 1.0)?,
            },
            "gaussian" => Self::Gaussian {
                stddev: positive("stddev", 0.5)?,
            },
            "mitchell" => Self::Mitchell {
                b: cubic("B")?,
                c: cubic("C")?,
            },
            _ => return Err(object.unsupported(&["box", "tent", "gaussian", "mitchell"])),
        };
        object.finish()?;
        Ok(filter)
    }

    /// How far from its centre the filter reaches, in pixels.
    pub fn radius(&self) -> f32 {
        match *self {
            Self::Box => 0.5,
            Self::Tent { radius } => radius,
            Self::Gaussian { stddev } => 4.0 * stddev,
            Self::Mitchell { .. } => 2.0,
        }
    }

    /// The profile at `x` pixels from the centre, not normalised.
    pub fn profile(&self, x: f64) -> f64 {
        let x = x.abs();
        if x > f64::from(self.radius()) {
            return 0.0;
        }
        match *self {
            Self::Box => 1.0,
            Self::Tent { radius } => 1.0 - x / f64::from(radius),
            Self::Gaussian { stddev } => {
                let bell = |x: f64| (-0.5 * (x / f64::from(stddev)).powi(2)).exp();
                bell(x) - bell(f64::from(self.radius()))
            }
            Self::Mitchell { b, c } => {
                let (b, c) = (f64::from(b), f64::from(c));
                let (x2, x3) = (x * x, x * x * x);
                (if x < 1.0 {
                    (12.0 - 9.0 * b - 6.0 * c) * x3 + (-18.0 + 12.0 * b + 6.0 * c) * x2 + 6.0
                        - 2.0 * b
                } else {
                    (-b - 6.0 * c) * x3
                        + (6.0 * b + 30.0 * c) * x2
                        + (-12.0 * b - 48.0 * c) * x
                        + 8.0 * b
                        + 24.0 * c
                }) / 6.0
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profiles_end_at_their_radius() {
        let filters = [
            ReconstructionFilter::Tent { radius: 1.0 },
            ReconstructionFilter::Gaussian { stddev: 0.5 },
            ReconstructionFilter::Mitchell {
                b: 1.0 / 3.0,
                c: 1.0 / 3.0,
            },
        ];
        for filter in filters {
            let edge = f64::from(filter.radius());
            assert!(filter.profile(edge).abs() < 1e-12, "{filter:?}");
            assert!(filter.profile(0.0) > 0.5 && filter.profile(-0.3) == filter.profile(0.3));
        }
    }

    #[test]
    fn films_that_cannot_be_are_refused() {
        assert!(FilmDescription::new(0, 5).is_err());
        assert!(FilmDescription::new(5, 1 << 40).is_err());
        let film = FilmDescription::new(10, 10).unwrap();
        assert!(film.clone().cropped((5, 5), (5, 5)).is_ok());
        assert!(film.clone().cropped((5, 5), (6, 5)).is_err());
        assert!(film.clone().cropped((-1, 0), (5, 5)).is_err());
        assert!(film.clone().cropped((i64::MAX, 0), (i64::MAX, 5)).is_err());
        assert!(film.cropped((0, 0), (0, 5)).is_err());
    }
}
