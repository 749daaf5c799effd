//! `mesh_attribute`: what the mesh of a PLY file says of its vertices or faces.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `name` | string | `vertex_` or `face_` and the name in the file, such as `vertex_color` for the properties `r`, `g`, `b` | required |
//! | `scale` | float | factor | 1 |
//!
//! Properties `NAME_x`, or `NAME_x` to `NAME_z`, are the attribute NAME, `NAME_r` to `NAME_b` are `NAME_color`. Colours are linear sRGB in
//! [0, 1]. By wavelength every one is a smooth spectrum. Where the mesh says the same everywhere, that is a colour and no texture.

use super::luminance;
use crate::scene::error::SceneError;
use crate::scene::mesh::{AttributeValues, MeshAttribute};
use crate::scene::shapes::SurfaceParameters;
use crate::scene::xml::Object;
use crate::spectrum::{Colour, CurveError, SpectralCurve, SpectrumArithmetic};

/// An attribute that textures ask for, on the mesh where they lie.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::scene) struct AskedAttribute {
    pub name: String,
    /// What the mesh says everywhere, if that is the same; a number is one in all channels.
    pub constant: Option<[f32; 3]>,
}

/// What a mesh says, as a texture.
#[derive(Clone, Debug)]
pub struct AttributeTexture {
    /// The attribute.
    pub name: String,
    scale: f32,
}

impl AttributeTexture {
    pub(super) fn load(object: &Object) -> Result<Self, SceneError> {
        let name = object
            .string("name")?
            .ok_or_else(|| object.missing("name"))?;
        let scale = object.float_or("scale", 1.0)? as f32;
        object.finish()?;
        if !(name.starts_with("vertex_") || name.starts_with("face_")) {
            let message = format!("`name` is `{name}`; it must begin with `vertex_` or `face_`");
            return Err(object.parameter_error("name", message));
        }
        Ok(Self {
            name: name.to_owned(),
            scale,
        })
    }

    /// What it shows where the mesh says `constant` everywhere.
    pub(super) fn uniform(&self, constant: [f32; 3]) -> Result<SpectralCurve, CurveError> {
        SpectralCurve::rgb_unbounded_times(constant, self.scale)
    }

    /// The mean of `value` at the corners of the triangle where a point lies, weighted by how near they are. Nothing where the mesh does
    /// not have the attribute: such scenes are refused when they are loaded.
    fn interpolated<T>(
        &self,
        point: &SurfaceParameters,
        value: impl Fn(&AttributeValues, usize) -> T,
    ) -> Option<T>
    where
        T: std::ops::Add<Output = T> + std::ops::Mul<f32, Output = T>,
    {
        let place = point.attributes?;
        let is_wanted = |attribute: &&MeshAttribute| attribute.name == self.name;
        let attribute = place.attributes.iter().find(is_wanted)?;
        let value = |entry: u32| value(&attribute.values, entry as usize);
        if attribute.is_of_faces {
            return Some(value(place.triangle) * self.scale);
        }
        let [a, b, c] = place.corners.map(value);
        let [u, v] = place.barycentric;
        Some((a * (1.0 - u - v) + b * u + c * v) * self.scale)
    }

    pub(super) fn spectrum<C: Colour>(
        &self,
        point: &SurfaceParameters,
        wavelengths: &C::Wavelengths,
    ) -> C::Spectrum {
        let value = |values: &AttributeValues, entry: usize| match values {
            AttributeValues::Numbers(numbers) => C::Spectrum::splat(numbers[entry]),
            AttributeValues::Colours(colours) => C::evaluate_entry(colours, entry, wavelengths),
        };
        self.interpolated(point, value).unwrap_or_default()
    }

    pub(super) fn rgb(&self, point: &SurfaceParameters) -> [f32; 3] {
        let value = |values: &AttributeValues, entry: usize| match values {
            AttributeValues::Numbers(numbers) => glam::Vec3::splat(numbers[entry]),
            AttributeValues::Colours(colours) => colours.rgb(entry).into(),
        };
        self.interpolated(point, value).unwrap_or_default().into()
    }

    pub(super) fn number(&self, point: &SurfaceParameters) -> f32 {
        let value = |values: &AttributeValues, entry: usize| match values {
            AttributeValues::Numbers(numbers) => numbers[entry],
            AttributeValues::Colours(colours) => luminance(colours.rgb(entry)),
        };
        self.interpolated(point, value).unwrap_or_default()
    }
}
