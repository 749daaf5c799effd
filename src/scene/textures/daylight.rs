//! `d65`: the light of an average day, for what lights emit.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `color` | rgb | what the light is filtered by, of any magnitude | white |
//! | `scale` | float | factor | 1 |
//! | (any name) | texture | what the light is filtered by from point to point, instead of both; for `area` only | |
//!
//! In three channels it is white. A texture is there what it is without it; by wavelength its white is that of D65 and not equal energy.

use super::{SpectrumTexture, TextureLoader};
use crate::scene::error::SceneError;
use crate::scene::shapes::SurfaceParameters;
use crate::scene::spectra::Quantity;
use crate::scene::xml::{Class, Object, SpectrumProperty};
use crate::spectrum::{Colour, SpectralCurve};

/// Daylight that a texture filters.
#[derive(Clone, Debug)]
pub struct Daylight {
    light: SpectralCurve,
    filter: SpectrumTexture,
}

impl Daylight {
    /// What `object` states, a `d65`.
    pub(super) fn load(
        object: &Object,
        loader: &mut TextureLoader,
    ) -> Result<SpectrumTexture, SceneError> {
        let filter = match object.children(Class::Texture)[..] {
            [] => return uniform(object).map(SpectrumTexture::Uniform),
            [filter] => loader.nested(&filter.object, Quantity::TextureEmission)?,
            _ => return Err(object.error("a `d65` contains one texture at most")),
        };
        for name in ["color", "scale"] {
            if object.has(name) {
                let message = format!("a `d65` has either a texture or `{name}`, not both");
                return Err(object.parameter_error(name, message));
            }
        }
        object.finish()?;
        if let SpectrumTexture::Uniform(filter) = &filter
            && let Some(filtered) = filter.filtering_d65()
        {
            return Ok(SpectrumTexture::Uniform(filtered));
        }
        let light = emission(object, [1.0; 3])?;
        Ok(SpectrumTexture::Varying(super::Pattern::Daylight(
            Box::new(Self { light, filter }),
        )))
    }

    pub(super) fn filter(&self) -> &SpectrumTexture {
        &self.filter
    }

    pub(super) fn spectrum<C: Colour>(
        &self,
        point: &SurfaceParameters,
        wavelengths: &C::Wavelengths,
    ) -> C::Spectrum {
        C::evaluate(&self.light, wavelengths) * self.filter.spectrum::<C>(point, wavelengths)
    }
}

/// The light that `object`, a `d65`, is at all points.
pub(in crate::scene) fn uniform(object: &Object) -> Result<SpectralCurve, SceneError> {
    let colour = match object.spectrum("color")? {
        None => [1.0; 3],
        Some(SpectrumProperty::Rgb(rgb)) => rgb,
        Some(_) => return Err(object.parameter_error("color", "`color` has to be an <rgb>")),
    };
    let scale = object.float_or("scale", 1.0)?;
    object.finish()?;
    emission(object, colour.map(|channel| (scale * channel) as f32))
}

fn emission(object: &Object, rgb: [f32; 3]) -> Result<SpectralCurve, SceneError> {
    SpectralCurve::rgb_emission(rgb).map_err(|error| object.error(error.to_string()))
}
