//! Materials: the tree of bsdfs that a scene states, and the walk down that tree at a point of a surface.
//!
//! Where a `mask` or a `blendbsdf` mixes materials, one of them is drawn with the probability of its share, once for each
//! vertex (as in pbrt-v4, `MixMaterial`). That is unbiased: the mixture's bsdf is the sum of the materials' weighted by their shares,
//! and both ways to find light share the choice. So a [`Bsdf`] has a fixed size however deep the tree is, and a vertex where the
//! light just passes costs no shadow ray.

use glam::Vec3;

use super::stated::Stated;
use super::surface::Surface;
use super::{Bsdf, DiffuseMaterial, Side};
use crate::sampling::Frame;
use crate::scene::effects::Effect;
use crate::scene::error::SceneError;
use crate::scene::shapes::SurfaceParameters;
use crate::scene::source::Source;
use crate::scene::textures::{AskedAttribute, SpectrumTexture, TextureLoader};
use crate::scene::xml::Object;
use crate::spectrum::{Colour, SpectralCurve};

/// How a surface scatters light on both sides.
#[derive(Clone, Debug)]
pub struct Material {
    tree: Surface,
    source: Option<Box<Source>>,
    needs_parameters: bool,
    is_mixed: bool,
    scatters_below: bool,
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
            scatters_below: tree.is_transmissive() || tree.is_tilted(),
            attributes: Vec::new(),
            source: None,
            tree,
        }
    }

    /// What `change` makes of it.
    pub(super) fn changed(self, change: impl FnOnce(Surface) -> Surface) -> Self {
        Self {
            attributes: self.attributes,
            source: self.source,
            ..Self::new(change(self.tree))
        }
    }

    /// The bsdf of the scene file that it is; none where a shape has no bsdf.
    pub fn source(&self) -> Option<&Source> {
        self.source.as_deref()
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

    /// Whether light that arrives below the horizon of the shape's shading normal can be scattered above it: some is transmitted, or a map tilts the surface
    /// so far that its back is seen.
    #[inline]
    pub fn scatters_below(&self) -> bool {
        self.scatters_below
    }

    /// Whether light goes through it somewhere.
    pub fn is_transmissive(&self) -> bool {
        self.tree.is_transmissive()
    }

    /// Whether all that it does is to reflect diffusely, the same at every point: `matte` then says all.
    pub fn is_matte(&self) -> bool {
        self.tree.is_matte()
    }

    /// The effects that it calls for.
    pub(in crate::scene) fn effects(&self) -> Vec<Effect> {
        self.tree.effects()
    }

    /// The effects that it calls for, each with the bsdf in it that does; none where a shape has no bsdf.
    pub(in crate::scene) fn calls(&self) -> Vec<(Effect, Source)> {
        match self.source() {
            Some(source) => self.tree.calls(source),
            None => Vec::new(),
        }
    }

    /// The diffuse reflectance of a side, where it has one that is the same at every point.
    #[inline(always)]
    pub(crate) fn matte(&self, side: Side) -> Option<&SpectralCurve> {
        let front = match (&self.tree, side) {
            (Surface::TwoSided(sides), Side::Front) => &sides.front.surface,
            (Surface::TwoSided(sides), Side::Back) => &sides.back.surface,
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
    let Stated { surface, source } = Surface::load(object, textures)?;
    Ok(Material {
        source: Some(source),
        attributes: textures.take_attributes(),
        ..Material::new(surface)
    })
}
