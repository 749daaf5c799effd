//! Parameters of scene files that may be textures.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use glam::{Affine2, DMat4, Mat2, Vec2};

use super::bitmap::Texels;
use super::{
    AskedAttribute, AttributeTexture, Bitmap, Checkerboard, Daylight, FloatTexture, Pattern,
    SpectrumTexture, luminance,
};
use crate::scene::error::SceneError;
use crate::scene::image_file::{ImageFile, ImageFileError};
use crate::scene::spectra::{Quantity, Stated, number, stated};
use crate::scene::xml::{Document, Object, SpectrumProperty};
use crate::spectrum::{MAX_EMISSION, MAX_INDEX, SpectralCurve};

/// Loads textures, each file once.
pub(in crate::scene) struct TextureLoader<'d> {
    document: &'d Document,
    /// Images by file, by whether they are raw, and by what they are images of.
    images: HashMap<(PathBuf, bool, Quantity), Arc<Texels>>,
    /// The attributes of the mesh on which the textures lie that are the same everywhere.
    constants: HashMap<String, [f32; 3]>,
    /// Mesh attributes that textures asked for since they were [taken](Self::take_attributes).
    attributes: Vec<AskedAttribute>,
}

/// What a texture turned out to be.
enum Loaded {
    Pattern(Pattern),
    /// The same everywhere.
    Uniform(SpectralCurve),
}

impl<'d> TextureLoader<'d> {
    pub fn new(document: &'d Document) -> Self {
        Self {
            document,
            images: HashMap::new(),
            constants: HashMap::new(),
            attributes: Vec::new(),
        }
    }

    /// The textures loaded from now on lie on a mesh whose attributes `constants` are the same everywhere.
    pub fn lie_on(&mut self, constants: HashMap<String, [f32; 3]>) {
        self.constants = constants;
    }

    /// Whether a texture that asks for `asked` would be told the same now.
    pub fn still_says(&self, asked: &AskedAttribute) -> bool {
        self.constants.get(&asked.name) == asked.constant.as_ref()
    }

    /// The mesh attributes that the textures loaded since the last call ask for.
    pub fn take_attributes(&mut self) -> Vec<AskedAttribute> {
        std::mem::take(&mut self.attributes)
    }

    /// The reflectance or transmittance that `object` has under `name`, or the grey `default`.
    pub fn reflectance(
        &mut self,
        object: &Object,
        name: &'static str,
        default: f32,
    ) -> Result<SpectrumTexture, SceneError> {
        self.colour_or(object, name, Quantity::Reflectance, default)
    }

    /// The index of a conductor that `object` has under `name`, or the number `default`.
    pub fn index(
        &mut self,
        object: &Object,
        name: &'static str,
        default: f32,
    ) -> Result<SpectrumTexture, SceneError> {
        self.colour_or(object, name, Quantity::Index, default)
    }

    /// The emission that `object` has under `name`, if it has one.
    pub fn emission(
        &mut self,
        object: &Object,
        name: &'static str,
    ) -> Result<Option<SpectrumTexture>, SceneError> {
        let colours_of_textures = Quantity::TextureEmission;
        self.colour(object, name, Quantity::Emission, colours_of_textures)
    }

    /// The colour of `quantity` that `object` has under `name`, or what the number `default` means.
    pub(super) fn colour_or(
        &mut self,
        object: &Object,
        name: &'static str,
        quantity: Quantity,
        default: f32,
    ) -> Result<SpectrumTexture, SceneError> {
        if let Some(colour) = self.colour(object, name, quantity, quantity)? {
            return Ok(colour);
        }
        number(default, quantity)
            .map(SpectrumTexture::Uniform)
            .map_err(|error| object.error(format!("`{name}`: {error}")))
    }

    /// The colour of `quantity` that `object` has under `name`; that of a texture is one `of_textures`.
    fn colour(
        &mut self,
        object: &Object,
        name: &'static str,
        quantity: Quantity,
        of_textures: Quantity,
    ) -> Result<Option<SpectrumTexture>, SceneError> {
        let Some(property) = object.spectrum(name)? else {
            return Ok(None);
        };
        let curve = match stated(property, quantity) {
            Stated::Texture(texture) => match self.texture(&texture, of_textures)? {
                Loaded::Pattern(pattern) => return Ok(Some(SpectrumTexture::Varying(pattern))),
                Loaded::Uniform(curve) => Ok(curve),
            },
            Stated::Curve(curve) => curve,
        };
        curve
            .map(|curve| Some(SpectrumTexture::Uniform(curve)))
            .map_err(|error| object.parameter_error(name, format!("`{name}`: {error}")))
    }

    /// The number that `object` has under `name`, or `default`. A colour stands for its luminance.
    pub fn number(
        &mut self,
        object: &Object,
        name: &'static str,
        default: f32,
    ) -> Result<FloatTexture, SceneError> {
        let value = match object.spectrum(name)? {
            None => default,
            Some(SpectrumProperty::Number(value) | SpectrumProperty::Constant(value)) => {
                value as f32
            }
            Some(SpectrumProperty::Rgb(rgb)) => luminance(rgb.map(|channel| channel as f32)),
            Some(SpectrumProperty::List(_)) => {
                let message = format!("`{name}` has to be a number or a texture, not a spectrum");
                return Err(object.parameter_error(name, message));
            }
            Some(SpectrumProperty::Texture(texture)) => {
                match self.texture(&texture, Quantity::Reflectance)? {
                    Loaded::Pattern(pattern) => return Ok(FloatTexture::Varying(pattern)),
                    Loaded::Uniform(curve) => luminance(curve.rgb()),
                }
            }
        };
        Ok(FloatTexture::Uniform(value))
    }

    /// The image that `object` is.
    pub fn bitmap(&mut self, object: &Object) -> Result<Bitmap, SceneError> {
        if object.plugin != "bitmap" {
            return Err(object.unsupported(&["bitmap"]));
        }
        let texels = self.texels(object, Quantity::Reflectance)?;
        Bitmap::load(object, texels)
    }

    /// The texture `object` as a colour of `quantity`, for one that contains it.
    pub(super) fn nested(
        &mut self,
        object: &Object,
        quantity: Quantity,
    ) -> Result<SpectrumTexture, SceneError> {
        Ok(match self.texture(object, quantity)? {
            Loaded::Uniform(curve) => SpectrumTexture::Uniform(curve),
            Loaded::Pattern(pattern) => SpectrumTexture::Varying(pattern),
        })
    }

    /// The texture that `object` is, whose colours are ones of `quantity`.
    fn texture(&mut self, object: &Object, quantity: Quantity) -> Result<Loaded, SceneError> {
        match object.plugin.as_str() {
            "bitmap" => {
                let texels = self.texels(object, quantity)?;
                let bitmap = Bitmap::load(object, texels)?;
                match bitmap.uniform() {
                    Some(rgb) => SpectralCurve::rgb_unbounded(rgb)
                        .map(Loaded::Uniform)
                        .map_err(|error| object.error(error.to_string())),
                    None => Ok(Loaded::Pattern(Pattern::Bitmap(bitmap))),
                }
            }
            "checkerboard" => {
                let board = Checkerboard::load(object, self, quantity)?;
                Ok(match board.uniform() {
                    Some(colour) => Loaded::Uniform(colour.clone()),
                    None => Loaded::Pattern(Pattern::Checkerboard(Box::new(board))),
                })
            }
            "mesh_attribute" => {
                let attribute = AttributeTexture::load(object)?;
                let constant = self.constants.get(&attribute.name).copied();
                self.attributes.push(AskedAttribute {
                    name: attribute.name.clone(),
                    constant,
                });
                // What is no colour, such as a number below 0, stays a texture.
                let uniform = constant.and_then(|constant| attribute.uniform(constant).ok());
                Ok(match uniform {
                    Some(curve) => Loaded::Uniform(curve),
                    None => Loaded::Pattern(Pattern::Attribute(attribute)),
                })
            }
            "d65" if quantity == Quantity::TextureEmission => {
                Ok(match Daylight::load(object, self)? {
                    SpectrumTexture::Uniform(curve) => Loaded::Uniform(curve),
                    SpectrumTexture::Varying(pattern) => Loaded::Pattern(pattern),
                })
            }
            _ if quantity == Quantity::TextureEmission => {
                Err(object.unsupported(&["bitmap", "checkerboard", "mesh_attribute", "d65"]))
            }
            _ => Err(object.unsupported(&["bitmap", "checkerboard", "mesh_attribute"])),
        }
    }

    /// The image file that `object` names, of colours of `quantity`.
    fn texels(&mut self, object: &Object, quantity: Quantity) -> Result<Arc<Texels>, SceneError> {
        let filename = object
            .string("filename")?
            .ok_or_else(|| object.missing("filename"))?;
        let raw = object.boolean_or("raw", false)?;
        let path = self.document.resolve(object, "filename", filename)?;
        let key = (path, raw, quantity);
        if let Some(known) = self.images.get(&key) {
            return Ok(known.clone());
        }
        let located =
            |problem: ImageFileError| object.parameter_error("filename", problem.to_string());
        let image = ImageFile::read(&key.0).map_err(located)?;
        let image = if raw { image } else { image.into_linear() };
        let (greatest, range) = match quantity {
            Quantity::TextureEmission => (
                MAX_EMISSION,
                "the texture of a lamp has numbers from 0 to 1e30",
            ),
            Quantity::Index => (MAX_INDEX, "an index has numbers from 0 to 1e6"),
            _ => (1.0, "a texture has numbers from 0 to 1"),
        };
        if let Some(problem) = image.find_unfit(|number| (0.0..=greatest).contains(&number)) {
            let problem = format!("{problem}; {range}");
            let file = key.0;
            return Err(located(ImageFileError { file, problem }));
        }
        let texels = Arc::new(Texels::new(&image));
        self.images.insert(key, texels.clone());
        Ok(texels)
    }
}

/// The transform of texture coordinates `to_uv`: of the 4 x 4 matrix, what it does in the plane.
pub(super) fn to_uv(object: &Object) -> Result<Affine2, SceneError> {
    let matrix = object.transform("to_uv")?.unwrap_or(DMat4::IDENTITY);
    let column = |axis: usize| {
        let column = matrix.col(axis);
        Vec2::new(column.x as f32, column.y as f32)
    };
    Ok(Affine2::from_mat2_translation(
        Mat2::from_cols(column(0), column(1)),
        column(3),
    ))
}
