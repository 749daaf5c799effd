//! `bitmap`: an image on a surface.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `filename` | string | the image (PNG, JPEG, BMP, Radiance HDR, OpenEXR or PFM), beside the scene or in a `<path>` | required |
//! | `raw` | boolean | take the numbers of the file as they are, not as encoded by sRGB | false |
//! | `filter_type` | string | `bilinear` or `nearest`: what lies between texels | `bilinear` |
//! | `wrap_mode` | string | `repeat`, `mirror` or `clamp`: what lies outside of [0, 1] | `repeat` |
//! | `to_uv` | transform | applied to the texture coordinates first | identity |
//!
//! v goes down from the image's upper edge. By wavelength every texel is a smooth spectrum of its colour.

use std::sync::Arc;

use glam::{Affine2, IVec2, UVec2, Vec2};

use super::luminance;
use crate::scene::error::SceneError;
use crate::scene::image_file::ImageFile;
use crate::scene::xml::Object;
use crate::spectrum::{Colour, Reflectances, SpectrumArithmetic};

/// An image and how it lies on a surface.
#[derive(Clone, Debug)]
pub struct Bitmap {
    texels: Arc<Texels>,
    filter: Filter,
    wrap: Wrap,
    to_uv: Affine2,
}

/// The texels of an image, row by row from the top.
#[derive(Debug)]
pub(super) struct Texels {
    size: UVec2,
    values: Values,
}

#[derive(Debug)]
enum Values {
    Grey(Vec<f32>),
    Colour(Reflectances),
}

/// What lies between texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Filter {
    Bilinear,
    Nearest,
}

/// What lies outside of the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Wrap {
    Repeat,
    Mirror,
    Clamp,
}

/// The four texels around a point and where it lies between them.
struct Neighbours {
    /// Upper left, upper right, lower left, lower right.
    texels: [usize; 4],
    /// From the centres of the left to those of the right, and from the upper to the lower, in [0, 1].
    fraction: Vec2,
}

impl Texels {
    pub fn new(image: &ImageFile) -> Self {
        Self {
            size: UVec2::new(image.size.width, image.size.height),
            values: if image.channels.colours() == 1 {
                Values::Grey(image.rgb().map(|[grey, ..]| grey).collect())
            } else {
                Values::Colour(Reflectances::new(image.rgb().collect()))
            },
        }
    }

    /// The colour of all texels, if they have one.
    fn uniform(&self) -> Option<[f32; 3]> {
        let first = self.rgb(0);
        let count = self.size.x as usize * self.size.y as usize;
        (1..count)
            .all(|texel| self.rgb(texel) == first)
            .then_some(first)
    }

    fn rgb(&self, texel: usize) -> [f32; 3] {
        match &self.values {
            Values::Grey(values) => [values[texel]; 3],
            Values::Colour(values) => values.rgb(texel),
        }
    }

    fn number(&self, texel: usize) -> f32 {
        match &self.values {
            Values::Grey(values) => values[texel],
            Values::Colour(values) => luminance(values.rgb(texel)),
        }
    }
}

impl Bitmap {
    /// The image `texels` as `object` lays it on a surface.
    pub(super) fn load(object: &Object, texels: Arc<Texels>) -> Result<Self, SceneError> {
        let filter = match object.string_or("filter_type", "bilinear")? {
            "bilinear" => Filter::Bilinear,
            "nearest" => Filter::Nearest,
            other => {
                let message =
                    format!("`filter_type` is `{other}`; it must be `bilinear` or `nearest`");
                return Err(object.parameter_error("filter_type", message));
            }
        };
        let wrap = match object.string_or("wrap_mode", "repeat")? {
            "repeat" => Wrap::Repeat,
            "mirror" => Wrap::Mirror,
            "clamp" => Wrap::Clamp,
            other => {
                let message =
                    format!("`wrap_mode` is `{other}`; it must be `repeat`, `mirror` or `clamp`");
                return Err(object.parameter_error("wrap_mode", message));
            }
        };
        let bitmap = Self {
            texels,
            filter,
            wrap,
            to_uv: super::loader::to_uv(object)?,
        };
        object.finish()?;
        Ok(bitmap)
    }

    /// The colour of the whole image, linear sRGB or as in the file, if it has one.
    pub fn uniform(&self) -> Option<[f32; 3]> {
        self.texels.uniform()
    }

    /// Columns and rows of the image.
    pub fn size(&self) -> UVec2 {
        self.texels.size
    }

    /// The texels around the texture coordinates `uv`.
    fn neighbours(&self, uv: Vec2) -> Neighbours {
        let position = self.to_uv.transform_point2(uv) * self.texels.size.as_vec2();
        let shifted = match self.filter {
            Filter::Bilinear => position - 0.5,
            Filter::Nearest => position,
        };
        let corner = shifted.floor();
        let fraction = match self.filter {
            Filter::Bilinear => shifted - corner,
            Filter::Nearest => Vec2::ZERO,
        };
        let texel = |x: i32, y: i32| {
            let place = self.wrapped(corner.as_ivec2().wrapping_add(IVec2::new(x, y)));
            place.x as usize + place.y as usize * self.texels.size.x as usize
        };
        Neighbours {
            texels: [texel(0, 0), texel(1, 0), texel(0, 1), texel(1, 1)],
            fraction,
        }
    }

    /// The texel that stands at `place`.
    fn wrapped(&self, place: IVec2) -> IVec2 {
        let size = self.texels.size.as_ivec2();
        match self.wrap {
            Wrap::Clamp => place.clamp(IVec2::ZERO, size - 1),
            Wrap::Repeat => place.rem_euclid(size),
            Wrap::Mirror => {
                let there_and_back = place.rem_euclid(2 * size);
                there_and_back.min(2 * size - 1 - there_and_back)
            }
        }
    }

    /// The texels' `value`s between which `uv` lies, mixed.
    fn mixed<T>(&self, uv: Vec2, value: impl Fn(usize) -> T) -> T
    where
        T: std::ops::Add<Output = T> + std::ops::Mul<f32, Output = T>,
    {
        let Neighbours { texels, fraction } = self.neighbours(uv);
        if self.filter == Filter::Nearest {
            return value(texels[0]);
        }
        let [upper_left, upper_right, lower_left, lower_right] = texels.map(value);
        let (right, lower) = (fraction.x, fraction.y);
        (upper_left * (1.0 - right) + upper_right * right) * (1.0 - lower)
            + (lower_left * (1.0 - right) + lower_right * right) * lower
    }

    /// The colour at the texture coordinates `uv` at a path's wavelengths: a reflectance.
    pub fn spectrum<C: Colour>(&self, uv: Vec2, wavelengths: &C::Wavelengths) -> C::Spectrum {
        self.mixed(uv, |texel| match &self.texels.values {
            Values::Grey(values) => C::Spectrum::splat(values[texel]),
            Values::Colour(values) => C::evaluate_entry(values, texel, wavelengths),
        })
    }

    pub(super) fn rgb(&self, uv: Vec2) -> [f32; 3] {
        self.mixed(uv, |texel| glam::Vec3::from(self.texels.rgb(texel)))
            .into()
    }

    pub(super) fn number(&self, uv: Vec2) -> f32 {
        self.mixed(uv, |texel| self.texels.number(texel))
    }

    /// The derivatives of [`Self::number`] by u and v.
    pub(in crate::scene) fn gradient(&self, uv: Vec2) -> Vec2 {
        if self.filter == Filter::Nearest {
            return Vec2::ZERO;
        }
        let Neighbours { texels, fraction } = self.neighbours(uv);
        let [upper_left, upper_right, lower_left, lower_right] =
            texels.map(|texel| self.texels.number(texel));
        let by_x = (upper_right - upper_left) * (1.0 - fraction.y)
            + (lower_right - lower_left) * fraction.y;
        let by_y = (lower_left - upper_left) * (1.0 - fraction.x)
            + (lower_right - upper_right) * fraction.x;
        let by_place = Vec2::new(by_x, by_y) * self.texels.size.as_vec2();
        self.to_uv.matrix2.transpose() * by_place
    }

    /// The mean luminance of all texels.
    pub fn mean(&self) -> f32 {
        let count = self.texels.size.x as usize * self.texels.size.y as usize;
        let sum: f64 = (0..count)
            .map(|texel| f64::from(self.texels.number(texel)))
            .sum();
        (sum / count as f64) as f32
    }
}
