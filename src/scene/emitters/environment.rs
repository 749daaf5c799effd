//! `envmap`: surroundings whose radiance is an image in latitude and longitude.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `filename` | string | the image, at least 2 x 3 pixels; integers in it are taken as sRGB, floating-point numbers as linear | required |
//! | `scale` | float | factor for its radiance, at least 0 | 1 |
//! | `to_world` | transform | turns or mirrors the surroundings | identity |
//! | `mis_compensation` | boolean | leave what is darker than the mean to other sampling techniques (Karlík et al. 2019) | false |
//!
//! The image shows latitude and longitude: its middle lies in direction +z, its left and right edges in -z, +x is a quarter
//! from the left, and the highest and lowest row of pixels are the poles +y and -y. Directions are drawn by luminance, and
//! their density is interpolated like the radiance.

use std::f32::consts::{FRAC_1_PI, PI};

use glam::{DMat3, DMat4, Mat3, Vec2, Vec3};

use super::{ConstantLight, Emitter, LightSample};
use crate::sampling::{PiecewiseBilinear, SolidAnglePdf};
use crate::scene::error::SceneError;
use crate::scene::image_file::{self, ImageFile};
use crate::scene::load::Loader;
use crate::scene::xml::Object;
use crate::spectrum::{BetweenTexels, Colour, EmissionImage, SpectralCurve, SpectrumArithmetic};

/// The greatest radiance of a pixel: far above all that is real, and far from the overflow of `f32`.
const MAX_RADIANCE: f32 = 1e30;

/// The luminance of linear sRGB.
const LUMINANCE: Vec3 = Vec3::new(0.212_671, 0.715_160, 0.072_169);

/// Surroundings that are an image.
#[derive(Clone, Debug)]
pub struct EnvironmentMap {
    radiance: EmissionImage,
    columns: usize,
    rows: usize,
    /// Draws from the ring of columns, which starts at the middle of the first, and the rows. `None` where all is black.
    distribution: Option<PiecewiseBilinear>,
    /// From world space to that of the image: orthogonal.
    to_local: Mat3,
}

impl EnvironmentMap {
    /// The surroundings; a constant light where the image has one colour.
    pub(super) fn load(object: &Object, loader: &Loader) -> Result<Emitter, SceneError> {
        let image = image_file::load(object, loader.document)?.into_linear();
        let scale = object.float_or("scale", 1.0)?;
        let to_world = object.transform("to_world")?.unwrap_or(DMat4::IDENTITY);
        let compensates = object.boolean_or("mis_compensation", false)?;
        object.finish()?;
        if scale < 0.0 {
            let message = format!("`scale` is {scale}; it must be at least 0");
            return Err(object.parameter_error("scale", message));
        }
        let rotation = rotation(object, to_world)?;
        let wrong = |message: String| object.parameter_error("filename", message);
        let map = Self::new(&image, scale as f32, compensates, rotation).map_err(wrong)?;
        Ok(match map.uniform() {
            Some(rgb) => Emitter::Constant(ConstantLight {
                radiance: SpectralCurve::rgb_emission(rgb)
                    .map_err(|error| wrong(error.to_string()))?,
            }),
            None => Emitter::Environment(map),
        })
    }

    fn new(
        image: &ImageFile,
        scale: f32,
        compensates: bool,
        to_local: Mat3,
    ) -> Result<Self, String> {
        let (columns, rows) = (image.size.width as usize, image.size.height as usize);
        if columns < 2 || rows < 3 {
            return Err(format!(
                "the image of surroundings has {columns} x {rows} pixels; it needs at least 2 x 3"
            ));
        }
        let fits = |value: f32| (0.0..=MAX_RADIANCE).contains(&(scale * value));
        if let Some(pixel) = image.find_unfit(fits) {
            return Err(format!(
                "{pixel}; times `scale`, a radiance must be from 0 to {MAX_RADIANCE:e}"
            ));
        }
        let texels: Vec<[f32; 3]> = image.rgb().map(|rgb| rgb.map(|v| scale * v)).collect();
        Ok(Self {
            distribution: distribution(&texels, columns, rows, compensates),
            radiance: EmissionImage::new(texels),
            columns,
            rows,
            to_local,
        })
    }

    /// The radiance that arrives from everywhere, linear sRGB, if it is the same.
    fn uniform(&self) -> Option<[f32; 3]> {
        let texels = self.radiance.texels();
        let (first, rest) = texels.split_first()?;
        rest.iter().all(|rgb| rgb == first).then_some(*first)
    }

    /// Whether no light arrives from anywhere.
    pub fn is_black(&self) -> bool {
        self.radiance.texels().iter().all(|rgb| *rgb == [0.0; 3])
    }

    /// The radiance that arrives from `direction` (unit, world space).
    #[inline]
    pub fn radiance<C: Colour>(
        &self,
        direction: Vec3,
        wavelengths: &C::Wavelengths,
    ) -> C::Spectrum {
        let position = self.position_of(self.to_local * direction);
        C::evaluate_emission(&self.radiance, &self.texels_at(position), wavelengths)
    }

    /// The density with which `sample` draws `direction` (unit, world space).
    #[inline]
    pub fn pdf(&self, direction: Vec3) -> SolidAnglePdf {
        let Some(distribution) = &self.distribution else {
            return SolidAnglePdf(0.0);
        };
        let local = self.to_local * direction;
        let density = distribution.density(self.position_of(local));
        per_solid_angle(density, sine_of(local))
    }

    #[inline]
    pub(super) fn sample<C: Colour>(
        &self,
        wavelengths: &C::Wavelengths,
        u: [f32; 2],
    ) -> Option<LightSample<C::Spectrum>> {
        let point = self.distribution.as_ref()?.sample(u);
        let longitude = 2.0 * PI * (point.position.x + self.first_middle());
        let (sine, cosine) = (PI * point.position.y).sin_cos();
        let pdf = per_solid_angle(point.density, sine);
        if !(pdf.0 > 0.0 && pdf.0.is_finite()) {
            return None;
        }
        let local = Vec3::new(longitude.sin() * sine, cosine, -longitude.cos() * sine);
        let texels = self.texels_at(point.position);
        let radiance = C::evaluate_emission(&self.radiance, &texels, wavelengths);
        (!radiance.is_black()).then(|| LightSample {
            direction: self.to_local.transpose() * local,
            distance: f32::INFINITY,
            surface: None,
            weight: radiance / pdf.0,
            pdf: Some(pdf),
        })
    }

    /// Where the middle of the first column is, as a share of the way around.
    #[inline]
    fn first_middle(&self) -> f32 {
        0.5 / self.columns as f32
    }

    /// Where a local direction is: how far around from the middle of the first column and how far down, both in [0, 1].
    #[inline]
    fn position_of(&self, local: Vec3) -> Vec2 {
        let around = local.x.atan2(-local.z) * (0.5 * FRAC_1_PI) - self.first_middle();
        // Unlike the arc cosine it is exact near the poles, where the density per solid angle depends on it.
        let down = sine_of(local).atan2(local.y) * FRAC_1_PI;
        Vec2::new(around - around.floor(), down)
    }

    #[inline]
    fn texels_at(&self, position: Vec2) -> BetweenTexels {
        let x = position.x * self.columns as f32;
        let y = position.y * (self.rows - 1) as f32;
        let left = (x as usize).min(self.columns - 1);
        let above = (y as usize).min(self.rows - 2);
        let right = if left + 1 == self.columns {
            0
        } else {
            left + 1
        };
        let (upper, lower) = (above * self.columns, (above + 1) * self.columns);
        BetweenTexels {
            corners: [upper + left, upper + right, lower + left, lower + right],
            across: x - left as f32,
            down: y - above as f32,
        }
    }
}

/// The sine of a local direction's polar angle.
#[inline]
fn sine_of(local: Vec3) -> f32 {
    (local.x * local.x + local.z * local.z).sqrt()
}

/// A density over the image, both sides of length 1, as one over the sphere, at the polar angle of this sine.
#[inline]
fn per_solid_angle(density: f32, sine: f32) -> SolidAnglePdf {
    SolidAnglePdf(density / (2.0 * PI * PI * sine.max(1e-7)))
}

/// The transform of directions from world space, of a `to_world` that turns, mirrors and scales uniformly.
fn rotation(object: &Object, to_world: DMat4) -> Result<Mat3, SceneError> {
    let axes = DMat3::from_mat4(to_world);
    let axes = axes * (1.0 / axes.determinant().abs().cbrt());
    let deviation = axes.transpose() * axes - DMat3::IDENTITY;
    if deviation
        .abs()
        .to_cols_array()
        .into_iter()
        .all(|deviation| deviation < 1e-4)
    {
        return Ok(axes.transpose().as_mat3());
    }
    let message = "`to_world` can turn and mirror surroundings; it cannot stretch or shear them";
    Err(object.parameter_error("to_world", message))
}

/// Luminance times the sine of the polar angle: the first column stands again at the end of every row.
fn distribution(
    texels: &[[f32; 3]],
    columns: usize,
    rows: usize,
    compensates: bool,
) -> Option<PiecewiseBilinear> {
    let luminances: Vec<f32> = texels
        .iter()
        .map(|&rgb| LUMINANCE.dot(rgb.into()))
        .collect();
    let offset = if compensates {
        compensation(&luminances)
    } else {
        0.0
    };
    let mut values = Vec::with_capacity((columns + 1) * rows);
    for (row, luminances) in luminances.chunks_exact(columns).enumerate() {
        // Zero at both poles, of which the sine of pi would miss one.
        let sine = match row {
            0 => 0.0,
            _ if row + 1 == rows => 0.0,
            _ => (PI * row as f32 / (rows - 1) as f32).sin(),
        };
        let ring = luminances.iter().chain(&luminances[..1]);
        values.extend(ring.map(|luminance| (luminance - offset).max(0.0) * sine));
    }
    PiecewiseBilinear::new(values, columns + 1)
}

/// What Karlík et al. 2019 ("MIS compensation", section 4) subtract from luminances: their mean; nothing where they are
/// all alike.
fn compensation(luminances: &[f32]) -> f32 {
    let sum: f64 = luminances
        .iter()
        .map(|&luminance| f64::from(luminance))
        .sum();
    let mean = (sum / luminances.len() as f64) as f32;
    let least = luminances.iter().copied().fold(f32::INFINITY, f32::min);
    if mean - least > 0.01 * mean {
        mean
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests;
