//! Indices of refraction, of what lies in front of an interface and behind it.
//!
//! | parameter | type | meaning |
//! |---|---|---|
//! | `int_ior` | float, string or spectrum | index on the inner side, where the surface's normal does not point |
//! | `ext_ior` | float, string or spectrum | index on the outer side; default `air` |
//!
//! A string names a material of [`MATERIALS`], as in Mitsuba. A spectrum, which Mitsuba does not have here, is a dispersive glass: a list
//! or a file of wavelengths and indices, or the plugin [`sellmeier`](super::sellmeier). Light of one wavelength is refracted by
//! its own index; in three channels all have the index at the sodium D line.

use super::Side;
use super::sellmeier;
use crate::scene::error::{SceneError, list};
use crate::scene::xml::{NamedSpectrum, Object, SpectrumProperty};
use crate::spectrum::{Colour, SpectralCurve, SpectrumArithmetic};

/// Indices at 589.3 nm and about 20 degrees Celsius, many after Hecht, "Optics", fourth edition: Mitsuba's table.
const MATERIALS: [(&str, f32); 23] = [
    ("vacuum", 1.0),
    ("helium", 1.000036),
    ("hydrogen", 1.000132),
    ("air", 1.000277),
    ("carbon dioxide", 1.00045),
    ("water", 1.3330),
    ("acetone", 1.36),
    ("ethanol", 1.361),
    ("carbon tetrachloride", 1.461),
    ("glycerol", 1.4729),
    ("benzene", 1.501),
    ("silicone oil", 1.52045),
    ("bromine", 1.661),
    ("water ice", 1.31),
    ("fused quartz", 1.458),
    ("pyrex", 1.470),
    ("acrylic glass", 1.49),
    ("polypropylene", 1.49),
    ("bk7", 1.5046),
    ("sodium chloride", 1.544),
    ("amber", 1.55),
    ("pet", 1.5750),
    ("diamond", 2.419),
];

/// The indices on both sides of an interface.
#[derive(Clone, Debug)]
pub struct Indices {
    /// Behind the front.
    pub interior: SpectralCurve,
    /// Before the front.
    pub exterior: SpectralCurve,
}

impl Indices {
    /// The parameters `int_ior`, whose default is the material `interior`, and `ext_ior`.
    pub(super) fn load(object: &Object, interior: &str) -> Result<Self, SceneError> {
        Ok(Self {
            interior: index(object, "int_ior", interior)?,
            exterior: index(object, "ext_ior", "air")?,
        })
    }

    /// As [`Self::load`] for materials that need one index, of the inner side over the outer, for all wavelengths.
    pub(super) fn load_relative(object: &Object, interior: &str) -> Result<f32, SceneError> {
        let indices = Self::load(object, interior)?;
        for (name, index) in [
            ("int_ior", &indices.interior),
            ("ext_ior", &indices.exterior),
        ] {
            if !index.is_constant() {
                let message = format!("`{name}` of `{}` has to be one number", object.plugin);
                return Err(object.parameter_error(name, message));
            }
        }
        Ok(indices.interior.rgb()[0] / indices.exterior.rgb()[0])
    }

    /// The index behind the surface over the one before it, as `side` sees it.
    #[inline]
    pub(super) fn at<C: Colour>(&self, side: Side, wavelengths: &C::Wavelengths) -> C::Spectrum {
        let interior = C::evaluate(&self.interior, wavelengths);
        let exterior = C::evaluate(&self.exterior, wavelengths);
        match side {
            Side::Front => interior.zip(exterior, |behind, before| behind / before),
            Side::Back => exterior.zip(interior, |behind, before| behind / before),
        }
    }

    /// Whether wavelengths are refracted differently.
    pub(super) fn disperse(&self) -> bool {
        !(self.interior.is_constant() && self.exterior.is_constant())
    }

    /// The same for wavelengths that are all refracted as the one of 589.3 nm.
    pub(super) fn undispersed(&self) -> Self {
        let at_sodium_d = |curve: &SpectralCurve| {
            // An index that a curve has is one that a constant can have.
            SpectralCurve::constant_index(curve.rgb()[0]).unwrap_or_else(|_| curve.clone())
        };
        Self {
            interior: at_sodium_d(&self.interior),
            exterior: at_sodium_d(&self.exterior),
        }
    }

    /// Whether there is no interface.
    pub(super) fn are_equal(&self) -> bool {
        self.interior == self.exterior
    }
}

/// The index that `object` has under `name`, or that of the material `default`.
fn index(object: &Object, name: &'static str, default: &str) -> Result<SpectralCurve, SceneError> {
    let curve = match object.named_spectrum(name)? {
        None => SpectralCurve::constant_index(named(object, name, default)?),
        Some(NamedSpectrum::Name(material)) => {
            SpectralCurve::constant_index(named(object, name, material)?)
        }
        Some(NamedSpectrum::Spectrum(property)) => match property {
            SpectrumProperty::Number(value) | SpectrumProperty::Constant(value) => {
                SpectralCurve::constant_index(value as f32)
            }
            SpectrumProperty::List(entries) => {
                let entries: Vec<(f32, f32)> = entries
                    .iter()
                    .map(|&[nm, value]| (nm as f32, value as f32))
                    .collect();
                SpectralCurve::glass_index(&entries)
            }
            SpectrumProperty::Texture(plugin) => return sellmeier::load(&plugin),
            SpectrumProperty::Rgb(_) => {
                let message =
                    format!("`{name}` cannot be a colour: an index goes with a wavelength");
                return Err(object.parameter_error(name, message));
            }
        },
    };
    let curve =
        curve.map_err(|error| object.parameter_error(name, format!("`{name}`: {error}")))?;
    if curve.is_positive_in_light() {
        return Ok(curve);
    }
    let message =
        format!("`{name}` has to be positive at all wavelengths of light (360 to 830 nm)");
    Err(object.parameter_error(name, message))
}

fn named(object: &Object, name: &str, material: &str) -> Result<f32, SceneError> {
    let known = MATERIALS
        .iter()
        .find(|(known, _)| known.eq_ignore_ascii_case(material));
    known.map(|&(_, index)| index).ok_or_else(|| {
        let names: Vec<&str> = MATERIALS.iter().map(|&(name, _)| name).collect();
        let message = format!(
            "no index of refraction is known of `{material}`, only of: {}; <spectrum name=\"{name}\" type=\"sellmeier\"> knows glasses",
            list(&names)
        );
        object.parameter_error(name, message)
    })
}
