//! `area`: makes the shape in which it stands glow, on its outer side, with the same radiance in every direction.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `radiance` | spectrum | emitted radiance in W/(m^2 sr nm), or in linear sRGB | required |

use glam::Vec3;

use super::LightSample;
use crate::sampling::SolidAnglePdf;
use crate::scene::error::SceneError;
use crate::scene::shapes::SurfacePoint;
use crate::scene::spectra::{Quantity, spectrum};
use crate::scene::xml::Object;
use crate::scene::{Shape, ShapeId};
use crate::spectrum::{Colour, SpectralCurve, SpectrumArithmetic};

/// A shape that glows.
#[derive(Clone, Debug)]
pub struct AreaLight {
    /// The shape.
    pub shape: ShapeId,
    /// The radiance it emits.
    pub radiance: SpectralCurve,
}

impl AreaLight {
    pub(super) fn load(object: &Object, shape: ShapeId) -> Result<Self, SceneError> {
        let radiance = spectrum(object, "radiance", Quantity::Emission)?
            .ok_or_else(|| object.missing("radiance"))?;
        object.finish()?;
        Ok(Self { shape, radiance })
    }

    /// The radiance that leaves `point` of the shape in `direction` (unit, world space, away from the surface).
    #[inline]
    pub fn radiance<C: Colour>(
        &self,
        point: &SurfacePoint,
        direction: Vec3,
        wavelengths: &C::Wavelengths,
    ) -> C::Spectrum {
        if point.shading_normal.dot(direction) > 0.0 {
            C::evaluate(&self.radiance, wavelengths)
        } else {
            C::Spectrum::ZERO
        }
    }

    /// The density with which [`Self::sample`] draws the direction from `reference` to `point`.
    #[inline]
    pub fn pdf(&self, shapes: &[Shape], reference: Vec3, point: &SurfacePoint) -> SolidAnglePdf {
        shapes[self.shape.index()].geometry.pdf(reference, point)
    }

    #[inline(always)]
    pub(super) fn sample<C: Colour>(
        &self,
        shapes: &[Shape],
        reference: Vec3,
        wavelengths: &C::Wavelengths,
        u: [f32; 2],
    ) -> Option<LightSample<C::Spectrum>> {
        let sample = shapes[self.shape.index()].geometry.sample(reference, u);
        // A point seen edge-on, or one that coincides with the reference, has no finite density.
        if !(sample.pdf.0 > 0.0 && sample.pdf.0.is_finite()) {
            return None;
        }
        let radiance = self.radiance::<C>(&sample.point, -sample.direction, wavelengths);
        (!radiance.is_black()).then(|| LightSample {
            direction: sample.direction,
            distance: sample.distance,
            surface: Some(sample.point),
            weight: radiance / sample.pdf.0,
            pdf: Some(sample.pdf),
        })
    }
}
