//! Materials: the tree of bsdfs that a scene states, and the walk down that tree at a point of a surface.
//!
//! Where a `mask` or a `blendbsdf` mixes materials, one of them is drawn with the probability of its share, once for each
//! vertex (as in pbrt-v4, `MixMaterial`). That is unbiased: the mixture's bsdf is the sum of the materials' weighted by their shares,
//! and both ways to find light share the choice. So a [`Bsdf`] has a fixed size however deep the tree is, and a vertex where the
//! light just passes costs no shadow ray.

use glam::Vec3;

use super::surface::Surface;
use super::{Bsdf, DiffuseMaterial, Side};
use crate::sampling::Frame;
use crate::scene::effects::Effect;
use crate::scene::error::SceneError;
use crate::scene::shapes::SurfaceParameters;
use crate::scene::textures::{AskedAttribute, SpectrumTexture, TextureLoader};
use crate::scene::xml::Object;
use crate::spectrum::{Colour, SpectralCurve};

/// How a surface scatters light on both sides.
#[derive(Clone, Debug)]
pub struct Material {
    tree: Surface,
    needs_parameters: bool,
    is_mixed: bool,
    /// The mesh attributes that it asks for.
    attributes: Vec<AskedAttribute>,
}

/// A point of a surface as a path sees it.
#[derive(Clone, Copy, Debug)]
pub struct SeenPoint<'s> {
    /// The side that is seen.
    pub side: Side,
    /// The shading frame of the front, in world space. Local directions are in this frame, its normal turned to the side seen.
    pub frame: Frame,
    /// Unit direction to where the path comes from, local; z > 0.
    pub outgoing: Vec3,
    /// Coordinates and tangents, which mean something where [`Material::needs_parameters`].
    pub parameters: SurfaceParameters<'s>,
    /// A uniform number in [0, 1) that draws one of the materials mixed here; used where [`Material::is_mixed`].
    pub choice: f32,
}

impl Default for Material {
    /// What a shape without a bsdf is made of, unless it emits.
    fn default() -> Self {
        Self::new(Surface::Diffuse(DiffuseMaterial::default()))
    }
}

impl Material {
    pub(super) fn new(tree: Surface) -> Self {
        Self {
            needs_parameters: tree.needs_parameters(),
            is_mixed: tree.is_mixed(),
            attributes: Vec::new(),
            tree,
        }
    }

    /// The same material, which asks for these mesh attributes.
    pub(super) fn with_attributes(self, attributes: Vec<AskedAttribute>) -> Self {
        Self { attributes, ..self }
    }

    pub(super) fn into_tree(self) -> Surface {
        self.tree
    }

    /// What a shape that emits and has no bsdf is made of: it reflects nothing.
    pub fn black() -> Self {
        Self::new(Surface::Diffuse(DiffuseMaterial {
            reflectance: SpectrumTexture::Uniform(SpectralCurve::BLACK),
        }))
    }

    /// Whether it asks for the surface's coordinates and tangents.
    #[inline]
    pub fn needs_parameters(&self) -> bool {
        self.needs_parameters
    }

    /// The mesh attributes that it asks for.
    pub(in crate::scene) fn attributes(&self) -> &[AskedAttribute] {
        &self.attributes
    }

    /// Whether one of several materials is drawn at every point.
    #[inline]
    pub fn is_mixed(&self) -> bool {
        self.is_mixed
    }

    /// Whether light goes through it somewhere.
    pub fn is_transmissive(&self) -> bool {
        self.tree.is_transmissive()
    }

    /// Whether all that it does is to reflect diffusely, the same at every point: [`Self::matte`] then says all.
    pub fn is_matte(&self) -> bool {
        self.tree.is_matte()
    }

    /// The effects that it calls for, each once.
    pub(in crate::scene) fn effects(&self) -> Vec<Effect> {
        self.tree.effects()
    }

    /// The diffuse reflectance of a side, where it has one that is the same at every point.
    #[inline(always)]
    pub(crate) fn matte(&self, side: Side) -> Option<&SpectralCurve> {
        let front = match (&self.tree, side) {
            (Surface::TwoSided(sides), Side::Front) => &sides.front,
            (Surface::TwoSided(sides), Side::Back) => &sides.back,
            (surface, Side::Front) => surface,
            (_, Side::Back) => return None,
        };
        match front {
            Surface::Diffuse(DiffuseMaterial {
                reflectance: SpectrumTexture::Uniform(reflectance),
            }) => Some(reflectance),
            _ => None,
        }
    }

    /// Whether it refracts wavelengths apart.
    pub fn disperses(&self) -> bool {
        self.tree.disperses()
    }

    /// The bsdf of what a path with `wavelengths` sees at `point`, or `None` where that is black.
    #[inline]
    pub fn bsdf<C: Colour>(
        &self,
        point: &SeenPoint,
        wavelengths: &C::Wavelengths,
    ) -> Option<Bsdf<C::Spectrum>> {
        self.tree.at::<C>(point, wavelengths)
    }
}

/// The bsdf of a scene file.
pub(in crate::scene) fn load(
    object: &Object,
    textures: &mut TextureLoader,
) -> Result<Material, SceneError> {
    let tree = Surface::load(object, textures)?;
    Ok(Material::new(tree).with_attributes(textures.take_attributes()))
}
