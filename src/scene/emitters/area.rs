//! `area`: makes the shape in which it stands glow, on its outer side, with the same radiance in every direction.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `radiance` | spectrum or texture | emitted radiance in W/(m^2 sr nm), or in linear sRGB | required |
//!
//! By wavelength a texture has the spectra of reflectances, as in Mitsuba: its white is equal energy, not the white of sRGB. Unlike those
//! of reflectances, its numbers may be greater than 1. In a [`d65`](crate::scene::textures::Daylight) its white is that of sRGB.

use glam::Vec3;

use super::LightSample;
use crate::sampling::SolidAnglePdf;
use crate::scene::error::SceneError;
use crate::scene::load::Loader;
use crate::scene::shapes::{Geometry, SurfaceParameters, SurfacePoint};
use crate::scene::textures::{AskedAttribute, SpectrumTexture, luminance};
use crate::scene::xml::Object;
use crate::scene::{Shape, ShapeId};
use crate::spectrum::{Colour, SpectralCurve, SpectrumArithmetic};

/// Points along each of two axes by which [`AreaLight::mean_luminance`] knows a texture.
const POINTS: u16 = 64;

/// A shape that glows.
#[derive(Clone, Debug)]
pub struct AreaLight {
    /// The shape.
    pub shape: ShapeId,
    /// The radiance it emits.
    pub radiance: SpectrumTexture,
    /// The mesh attributes that the radiance asks for.
    attributes: Vec<AskedAttribute>,
}

impl AreaLight {
    pub(super) fn load(
        object: &Object,
        shape: ShapeId,
        loader: &mut Loader,
    ) -> Result<Self, SceneError> {
        let radiance = loader
            .textures
            .emission(object, "radiance")?
            .ok_or_else(|| object.missing("radiance"))?;
        object.finish()?;
        let attributes = loader.textures.take_attributes();
        Ok(Self {
            shape,
            radiance,
            attributes,
        })
    }

    /// The mesh attributes that it asks for.
    pub(in crate::scene) fn attributes(&self) -> &[AskedAttribute] {
        &self.attributes
    }

    /// The radiance, if it is the same everywhere.
    pub fn uniform_radiance(&self) -> Option<&SpectralCurve> {
        match &self.radiance {
            SpectrumTexture::Uniform(curve) => Some(curve),
            SpectrumTexture::Varying(_) => None,
        }
    }

    /// Whether it emits nothing.
    pub fn is_black(&self) -> bool {
        self.uniform_radiance().is_some_and(SpectralCurve::is_black)
    }

    /// The luminance of the radiance, on average over the shape, whose form is `geometry`: where it varies, that of a grid
    /// of points.
    pub fn mean_luminance(&self, geometry: &Geometry) -> f32 {
        if let Some(curve) = self.uniform_radiance() {
            return luminance(curve.rgb());
        }
        let at = |i: u16| (f32::from(i) + 0.5) / f32::from(POINTS);
        let points = (0..POINTS).flat_map(|i| (0..POINTS).map(move |j| [at(i), at(j)]));
        let luminances = points.map(|u| {
            let (_, parameters) = geometry.uniform_point(u);
            f64::from(luminance(self.radiance.rgb(&parameters)))
        });
        (luminances.sum::<f64>() / f64::from(POINTS).powi(2)) as f32
    }

    /// Makes a radiance that varies over the shape, whose form is `geometry`, the grey of its mean luminance.
    pub(in crate::scene) fn make_uniform(&mut self, geometry: &Geometry) {
        if self.radiance.varies() {
            self.radiance = SpectrumTexture::grey(self.mean_luminance(geometry));
        }
    }

    /// The radiance that leaves `point` of the shape in `direction` (unit, world space, away from the surface).
    /// `parameters` finds where the point lies on the shape; only textures want to know.
    #[inline]
    pub fn radiance<'s, C: Colour>(
        &self,
        point: &SurfacePoint,
        parameters: impl FnOnce() -> SurfaceParameters<'s>,
        direction: Vec3,
        wavelengths: &C::Wavelengths,
    ) -> C::Spectrum {
        if point.shading_normal.dot(direction) <= 0.0 {
            return C::Spectrum::ZERO;
        }
        match &self.radiance {
            SpectrumTexture::Uniform(curve) => C::evaluate(curve, wavelengths),
            texture => texture.spectrum::<C>(&parameters(), wavelengths),
        }
    }

    /// The density with which `sample` draws the direction from `reference` to `point`.
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
        let geometry = &shapes[self.shape.index()].geometry;
        let sample = geometry.sample(reference, u);
        // A point seen edge-on, or one that coincides with the reference, has no finite density.
        if !(sample.pdf.0 > 0.0 && sample.pdf.0.is_finite()) {
            return None;
        }
        let parameters = || geometry.parameters_of_sample(u, &sample.point);
        let radiance =
            self.radiance::<C>(&sample.point, parameters, -sample.direction, wavelengths);
        (!radiance.is_black()).then(|| LightSample {
            direction: sample.direction,
            distance: sample.distance,
            surface: Some(sample.point),
            weight: radiance / sample.pdf.0,
            pdf: Some(sample.pdf),
        })
    }
}

#[cfg(test)]
mod tests;
