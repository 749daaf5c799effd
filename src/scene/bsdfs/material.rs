//! Materials: the tree of bsdfs that a scene states, and the walk down that tree at a point of a surface.
//!
//! Where a `mask` or a `blendbsdf` mixes materials, one of them is drawn with the probability of its share, once for each
//! vertex (as in pbrt-v4, `MixMaterial`). That is unbiased: the mixture's bsdf is the sum of the materials' weighted by their shares,
//! and both ways to find light share the choice. So a [`Bsdf`] has a fixed size however deep the tree is, and a vertex where the
//! light just passes costs no shadow ray.

use glam::Vec3;

use super::null::Null;
use super::{Bsdf, DiffuseMaterial, Side, twosided};
use crate::sampling::Frame;
use crate::scene::error::SceneError;
use crate::scene::shapes::SurfaceParameters;
use crate::scene::textures::{SpectrumTexture, TextureLoader};
use crate::scene::xml::Object;
use crate::spectrum::{Colour, SpectralCurve};

/// How a surface scatters light on both sides.
#[derive(Clone, Debug)]
pub struct Material {
    tree: Surface,
    needs_parameters: bool,
    is_mixed: bool,
}

/// A bsdf of the scene file with those that it contains.
#[derive(Clone, Debug)]
pub(super) enum Surface {
    /// `diffuse`
    Diffuse(DiffuseMaterial),
    /// `null`
    Null,
    /// `twosided`
    TwoSided(Box<twosided::TwoSided>),
}

/// A point of a surface as a path sees it.
#[derive(Clone, Copy, Debug)]
pub struct SeenPoint {
    /// The side that is seen.
    pub side: Side,
    /// The shading frame of the front, in world space. Local directions are in this frame, its normal turned to the side seen.
    pub frame: Frame,
    /// Unit direction to where the path comes from, local; z > 0.
    pub outgoing: Vec3,
    /// Coordinates and tangents, which mean something where [`Material::needs_parameters`].
    pub parameters: SurfaceParameters,
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
    fn new(tree: Surface) -> Self {
        Self {
            needs_parameters: tree.needs_parameters(),
            is_mixed: tree.is_mixed(),
            tree,
        }
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

    /// Whether one of several materials is drawn at every point.
    #[inline]
    pub fn is_mixed(&self) -> bool {
        self.is_mixed
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
    Surface::load(object, textures).map(Material::new)
}

impl Surface {
    pub(super) fn load(object: &Object, textures: &mut TextureLoader) -> Result<Self, SceneError> {
        match object.plugin.as_str() {
            "diffuse" => DiffuseMaterial::load(object, textures).map(Self::Diffuse),
            "null" => object.finish().map(|()| Self::Null),
            "twosided" => twosided::TwoSided::load(object, textures)
                .map(Box::new)
                .map(Self::TwoSided),
            _ => Err(object.unsupported(&["diffuse", "null", "twosided"])),
        }
    }

    /// Whether light gets through the surface.
    pub(super) fn is_transmissive(&self) -> bool {
        match self {
            Self::Diffuse(_) | Self::TwoSided(_) => false,
            Self::Null => true,
        }
    }

    fn needs_parameters(&self) -> bool {
        match self {
            Self::Diffuse(material) => material.reflectance.varies(),
            Self::Null => false,
            Self::TwoSided(sides) => {
                sides.front.needs_parameters() || sides.back.needs_parameters()
            }
        }
    }

    fn is_mixed(&self) -> bool {
        match self {
            Self::Diffuse(_) | Self::Null => false,
            Self::TwoSided(sides) => sides.front.is_mixed() || sides.back.is_mixed(),
        }
    }

    /// See [`Material::bsdf`].
    pub(super) fn at<C: Colour>(
        &self,
        point: &SeenPoint,
        wavelengths: &C::Wavelengths,
    ) -> Option<Bsdf<C::Spectrum>> {
        let parameters = &point.parameters;
        let is_front = point.side == Side::Front;
        match self {
            Self::Diffuse(material) => {
                is_front.then(|| Bsdf::Diffuse(material.at::<C>(parameters, wavelengths)))
            }
            Self::Null => Some(Bsdf::Null(Null)),
            Self::TwoSided(sides) => {
                let surface = if is_front { &sides.front } else { &sides.back };
                let as_front = SeenPoint {
                    side: Side::Front,
                    ..*point
                };
                surface.at::<C>(&as_front, wavelengths)
            }
        }
    }
}
