//! Colours in scene files.

use std::sync::Arc;

use super::error::SceneError;
use super::textures::uniform_daylight;
use super::xml::{Class, Object, SpectrumProperty};
use crate::spectrum::{CurveError, SpectralCurve};

/// What a colour is the colour of: it decides how numbers become spectra.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Quantity {
    /// A share of light, in [0, 1].
    Reflectance,
    /// Radiance, intensity and the like.
    Emission,
    /// What a texture of a lamp emits: it has the spectra of reflectances, as in Mitsuba, but no upper bound.
    TextureEmission,
    /// An index of refraction or absorption of a conductor.
    Index,
}

/// The colour that `object` has under `name`, or `None` if it has none.
pub(super) fn spectrum(
    object: &Object,
    name: &'static str,
    quantity: Quantity,
) -> Result<Option<SpectralCurve>, SceneError> {
    let Some(property) = object.spectrum(name)? else {
        return Ok(None);
    };
    match stated(property, quantity) {
        Stated::Texture(texture)
            if quantity == Quantity::Emission
                && texture.plugin == "d65"
                && texture.children(Class::Texture).is_empty() =>
        {
            uniform_daylight(&texture).map(Some)
        }
        Stated::Texture(texture) => Err(texture.error(format!(
            "`{name}` of the {object} is the same everywhere: it can be a colour or a spectrum, not a texture"
        ))),
        Stated::Curve(curve) => curve
            .map(Some)
            .map_err(|error| object.parameter_error(name, format!("`{name}`: {error}"))),
    }
}

/// What a colour of a scene file states.
pub(super) enum Stated {
    /// One colour, or what is wrong with it.
    Curve(Result<SpectralCurve, CurveError>),
    /// A texture.
    Texture(Arc<Object>),
}

/// What `property` states as a colour of `quantity`.
pub(super) fn stated(property: SpectrumProperty, quantity: Quantity) -> Stated {
    Stated::Curve(match property {
        SpectrumProperty::Texture(texture) => return Stated::Texture(texture),
        SpectrumProperty::Number(value) => number(value as f32, quantity),
        SpectrumProperty::Constant(value) => constant(value as f32, quantity),
        SpectrumProperty::Rgb(rgb) => {
            let rgb = rgb.map(|value| value as f32);
            match quantity {
                Quantity::Reflectance => SpectralCurve::rgb_reflectance(rgb),
                Quantity::Emission => SpectralCurve::rgb_emission(rgb),
                Quantity::TextureEmission => SpectralCurve::rgb_unbounded(rgb),
                Quantity::Index => SpectralCurve::rgb_index(rgb),
            }
        }
        SpectrumProperty::List(list) => {
            let list: Vec<(f32, f32)> = list
                .iter()
                .map(|&[nm, value]| (nm as f32, value as f32))
                .collect();
            match quantity {
                Quantity::Reflectance => SpectralCurve::tabulated_reflectance(&list),
                Quantity::Emission => SpectralCurve::tabulated_emission(&list),
                Quantity::TextureEmission => SpectralCurve::tabulated_unbounded(&list),
                Quantity::Index => SpectralCurve::tabulated_index(&list),
            }
        }
    })
}

fn constant(value: f32, quantity: Quantity) -> Result<SpectralCurve, CurveError> {
    match quantity {
        Quantity::Reflectance => SpectralCurve::constant_reflectance(value),
        Quantity::Emission => SpectralCurve::constant_emission(value),
        Quantity::TextureEmission => SpectralCurve::rgb_unbounded([value; 3]),
        Quantity::Index => SpectralCurve::constant_index(value),
    }
}

/// What a plain number means: as in Mitsuba, a number for an emission is the white of sRGB (D65) of that luminance,
/// unlike a constant `<spectrum>`, whose colour is a little warmer.
pub(super) fn number(value: f32, quantity: Quantity) -> Result<SpectralCurve, CurveError> {
    match quantity {
        Quantity::Emission => SpectralCurve::rgb_emission([value; 3]),
        Quantity::Reflectance | Quantity::TextureEmission | Quantity::Index => {
            constant(value, quantity)
        }
    }
}

/// The colour under `name`, or what the number `default` means.
pub(super) fn spectrum_or(
    object: &Object,
    name: &'static str,
    quantity: Quantity,
    default: f32,
) -> Result<SpectralCurve, SceneError> {
    match spectrum(object, name, quantity)? {
        Some(curve) => Ok(curve),
        None => {
            number(default, quantity).map_err(|error| object.error(format!("`{name}`: {error}")))
        }
    }
}
