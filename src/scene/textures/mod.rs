//! Textures: parameters of materials that vary over a surface.
//!
//! A parameter is a [`SpectrumTexture`] where it is a colour and a [`FloatTexture`] where it is a number; both are uniform
//! or show a [`Pattern`].

mod bitmap;
mod checkerboard;
mod daylight;
mod loader;
mod mesh_attribute;

pub use bitmap::Bitmap;
pub use checkerboard::Checkerboard;
pub use daylight::Daylight;
pub(super) use daylight::uniform as uniform_daylight;
pub(super) use loader::TextureLoader;
pub(super) use mesh_attribute::AskedAttribute;
pub use mesh_attribute::AttributeTexture;

use super::shapes::SurfaceParameters;
use crate::spectrum::{Colour, SpectralCurve};

/// A colour for every point of a surface.
#[derive(Clone, Debug)]
pub enum SpectrumTexture {
    /// The same everywhere.
    Uniform(SpectralCurve),
    /// One that varies.
    Varying(Pattern),
}

/// A number for every point of a surface.
#[derive(Clone, Debug)]
pub enum FloatTexture {
    /// The same everywhere.
    Uniform(f32),
    /// One that varies.
    Varying(Pattern),
}

/// What varies over a surface.
#[derive(Clone, Debug)]
pub enum Pattern {
    /// `bitmap`
    Bitmap(Bitmap),
    /// `checkerboard`
    Checkerboard(Box<Checkerboard>),
    /// `mesh_attribute`
    Attribute(AttributeTexture),
    /// `d65`
    Daylight(Box<Daylight>),
}

impl SpectrumTexture {
    /// The colour at `point` at a path's wavelengths.
    #[inline]
    pub fn spectrum<C: Colour>(
        &self,
        point: &SurfaceParameters,
        wavelengths: &C::Wavelengths,
    ) -> C::Spectrum {
        match self {
            Self::Uniform(curve) => C::evaluate(curve, wavelengths),
            Self::Varying(pattern) => pattern.spectrum::<C>(point, wavelengths),
        }
    }

    /// The colour at `point` as one number: its luminance.
    pub fn number(&self, point: &SurfaceParameters) -> f32 {
        match self {
            Self::Uniform(curve) => luminance(curve.rgb()),
            Self::Varying(pattern) => pattern.number(point),
        }
    }

    /// The colour at `point` as linear sRGB.
    pub fn rgb(&self, point: &SurfaceParameters) -> [f32; 3] {
        match self {
            Self::Uniform(curve) => curve.rgb(),
            Self::Varying(pattern) => pattern.rgb(point),
        }
    }

    /// The mean over points and channels, about.
    pub fn mean(&self) -> f32 {
        match self {
            Self::Uniform(curve) => curve.rgb().iter().sum::<f32>() / 3.0,
            Self::Varying(pattern) => pattern.mean(),
        }
    }

    /// Whether it asks for the coordinates of the point.
    pub fn varies(&self) -> bool {
        matches!(self, Self::Varying(_))
    }

    /// Makes it a grey, its [mean](Self::mean), where it varies.
    pub(super) fn make_uniform(&mut self) {
        if self.varies() {
            *self = Self::grey(self.mean());
        }
    }

    /// The same number in all channels and at all wavelengths: nothing where that is negative or infinite.
    pub(super) fn grey(number: f32) -> Self {
        Self::Uniform(SpectralCurve::rgb_unbounded([number; 3]).unwrap_or(SpectralCurve::BLACK))
    }
}

impl FloatTexture {
    /// The number at `point`.
    #[inline]
    pub fn number(&self, point: &SurfaceParameters) -> f32 {
        match self {
            Self::Uniform(value) => *value,
            Self::Varying(pattern) => pattern.number(point),
        }
    }

    /// Whether it asks for the coordinates of the point.
    pub fn varies(&self) -> bool {
        matches!(self, Self::Varying(_))
    }

    /// Whether a number from 0 on is more than 0 somewhere.
    pub(super) fn can_be_positive(&self) -> bool {
        !matches!(self, Self::Uniform(0.0))
    }

    /// The mean over points, about.
    pub fn mean(&self) -> f32 {
        match self {
            Self::Uniform(value) => *value,
            Self::Varying(pattern) => pattern.mean(),
        }
    }

    /// Makes it its [mean](Self::mean).
    pub(super) fn make_uniform(&mut self) {
        *self = Self::Uniform(self.mean());
    }
}

impl Pattern {
    fn spectrum<C: Colour>(
        &self,
        point: &SurfaceParameters,
        wavelengths: &C::Wavelengths,
    ) -> C::Spectrum {
        match self {
            Self::Bitmap(bitmap) => bitmap.spectrum::<C>(point.uv, wavelengths),
            Self::Checkerboard(board) => board.square(point).spectrum::<C>(point, wavelengths),
            Self::Attribute(attribute) => attribute.spectrum::<C>(point, wavelengths),
            Self::Daylight(daylight) => daylight.spectrum::<C>(point, wavelengths),
        }
    }

    fn number(&self, point: &SurfaceParameters) -> f32 {
        match self {
            Self::Bitmap(bitmap) => bitmap.number(point.uv),
            Self::Checkerboard(board) => board.other_square(point).number(point),
            Self::Attribute(attribute) => attribute.number(point),
            Self::Daylight(daylight) => daylight.filter().number(point),
        }
    }

    fn rgb(&self, point: &SurfaceParameters) -> [f32; 3] {
        match self {
            Self::Bitmap(bitmap) => bitmap.rgb(point.uv),
            Self::Checkerboard(board) => board.square(point).rgb(point),
            Self::Attribute(attribute) => attribute.rgb(point),
            Self::Daylight(daylight) => daylight.filter().rgb(point),
        }
    }

    fn mean(&self) -> f32 {
        match self {
            Self::Bitmap(bitmap) => bitmap.mean(),
            Self::Checkerboard(board) => board.mean(),
            // What a mesh says is not known before its shape is.
            Self::Attribute(_) => 0.5,
            Self::Daylight(daylight) => daylight.filter().mean(),
        }
    }
}

/// Luminance of linear sRGB (ITU-R BT.709).
pub(in crate::scene) fn luminance(rgb: [f32; 3]) -> f32 {
    0.212_671 * rgb[0] + 0.715_160 * rgb[1] + 0.072_169 * rgb[2]
}

#[cfg(test)]
mod tests;
