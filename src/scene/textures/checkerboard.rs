//! `checkerboard`: squares of two colours, four to the unit square of texture coordinates.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `color0` | spectrum or texture | colour of the squares at the origin and diagonally from it | 0.4 |
//! | `color1` | spectrum or texture | colour of the others | 0.2 |
//! | `to_uv` | transform | applied to the texture coordinates first | identity |
//!
//! Where it stands for a number, such as an opacity, the colours are exchanged, as in Mitsuba.

use glam::{Affine2, Vec2};

use super::{SpectrumTexture, TextureLoader};
use crate::scene::error::SceneError;
use crate::scene::shapes::SurfaceParameters;
use crate::scene::spectra::Quantity;
use crate::scene::xml::Object;
use crate::spectrum::SpectralCurve;

/// Squares of two colours.
#[derive(Clone, Debug)]
pub struct Checkerboard {
    colours: [SpectrumTexture; 2],
    to_uv: Affine2,
}

impl Checkerboard {
    pub(super) fn load(
        object: &Object,
        loader: &mut TextureLoader,
        quantity: Quantity,
    ) -> Result<Self, SceneError> {
        let board = Self {
            colours: [
                loader.colour_or(object, "color0", quantity, 0.4)?,
                loader.colour_or(object, "color1", quantity, 0.2)?,
            ],
            to_uv: super::loader::to_uv(object)?,
        };
        object.finish()?;
        Ok(board)
    }

    /// The colour of all squares, if they have one.
    pub(super) fn uniform(&self) -> Option<&SpectralCurve> {
        match &self.colours {
            [
                SpectrumTexture::Uniform(first),
                SpectrumTexture::Uniform(second),
            ] => (first == second).then_some(first),
            _ => None,
        }
    }

    /// The colour of the square that a point lies in.
    pub(super) fn square(&self, point: &SurfaceParameters) -> &SpectrumTexture {
        &self.colours[usize::from(self.is_odd(point))]
    }

    /// The other colour, which Mitsuba has there where it asks for a number and not for a colour.
    pub(super) fn other_square(&self, point: &SurfaceParameters) -> &SpectrumTexture {
        &self.colours[usize::from(!self.is_odd(point))]
    }

    /// Whether the square of a point is one of the second colour.
    fn is_odd(&self, point: &SurfaceParameters) -> bool {
        let uv = self.to_uv.transform_point2(point.uv);
        let beyond_half = (uv - uv.floor()).cmpgt(Vec2::splat(0.5));
        beyond_half.x != beyond_half.y
    }

    pub(super) fn mean(&self) -> f32 {
        0.5 * (self.colours[0].mean() + self.colours[1].mean())
    }
}
