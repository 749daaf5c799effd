//! Bsdfs: how surfaces scatter light.
//!
//! A [`Material`] is what the scene states. At a path vertex it becomes a [`Bsdf`]: the scattering function of one
//! side at the wavelengths of one path, which next-event estimation, the strategy and all children of the vertex share.
//!
//! Directions are unit vectors in the local shading frame whose z axis is the normal of the side that was hit; both
//! point away from the surface. `outgoing` goes to where the path comes from, `incident` to where it goes on.

mod chunk;
mod diffuse;
mod twosided;

pub(crate) use chunk::{BsdfSamples, BsdfValues};
pub use diffuse::{Diffuse, DiffuseMaterial};

use glam::Vec3;

use super::error::SceneError;
use super::xml::Object;
use crate::sampling::SolidAnglePdf;
use crate::spectrum::{Colour, SpectralCurve, SpectrumArithmetic};

/// How the two sides of a surface scatter light.
///
/// `twosided` gives both sides a model; every other plugin only the front, and the back of such a surface is black,
/// as in Mitsuba.
#[derive(Clone, Debug)]
pub struct Material {
    /// The side that the shading normal points to.
    pub front: Model,
    /// The other side; black where there is none.
    pub back: Option<Model>,
}

impl Default for Material {
    /// What a shape without a bsdf is made of, unless it emits.
    fn default() -> Self {
        Self {
            front: Model::Diffuse(DiffuseMaterial::default()),
            back: None,
        }
    }
}

impl Material {
    /// What a shape that emits and has no bsdf is made of: it reflects nothing.
    pub fn black() -> Self {
        Self {
            front: Model::Diffuse(DiffuseMaterial {
                reflectance: SpectralCurve::BLACK,
            }),
            back: None,
        }
    }
}

/// The bsdf of a scene file.
pub(super) fn load(object: &Object) -> Result<Material, SceneError> {
    match object.plugin.as_str() {
        "twosided" => twosided::load(object),
        _ => Ok(Material {
            front: load_model(object)?,
            back: None,
        }),
    }
}

/// The bsdf of a scene file, for one side.
fn load_model(object: &Object) -> Result<Model, SceneError> {
    match object.plugin.as_str() {
        "diffuse" => DiffuseMaterial::load(object).map(Model::Diffuse),
        _ => Err(object.unsupported(&["diffuse", "twosided"])),
    }
}

/// The scattering model of one side.
#[derive(Clone, Debug)]
pub enum Model {
    /// `diffuse`
    Diffuse(DiffuseMaterial),
}

/// The scattering function of one side at the wavelengths of one path.
#[derive(Clone, Copy, Debug)]
pub enum Bsdf<S> {
    /// Lambertian reflection.
    Diffuse(Diffuse<S>),
}

/// A bsdf for a pair of directions.
#[derive(Clone, Copy, Debug)]
pub struct BsdfValue<S> {
    /// The bsdf times the cosine of the incident direction, in 1/sr.
    pub value: S,
    /// The density with which [`Bsdf::sample`] draws the incident direction.
    pub pdf: SolidAnglePdf,
}

/// An incident direction drawn from a bsdf.
#[derive(Clone, Copy, Debug)]
pub struct BsdfSample<S> {
    /// The direction, local.
    pub incident: Vec3,
    /// bsdf times cosine over density.
    pub weight: S,
    /// The density of `incident`.
    pub pdf: SolidAnglePdf,
}

/// A side of a surface, as seen from where a path comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The side that the shading normal points to.
    Front,
    /// The other side.
    Back,
}

impl Side {
    /// The side that a direction with cosine `cosine` against the shading normal sees; none edge-on.
    #[inline]
    pub fn seen_with(cosine: f32) -> Option<Self> {
        if cosine > 0.0 {
            Some(Self::Front)
        } else if cosine < 0.0 {
            Some(Self::Back)
        } else {
            None
        }
    }
}

impl Material {
    /// The bsdf of a side at the given wavelengths, or `None` where that side is black.
    #[inline]
    pub fn bsdf<C: Colour>(
        &self,
        side: Side,
        wavelengths: &C::Wavelengths,
    ) -> Option<Bsdf<C::Spectrum>> {
        let model = match side {
            Side::Front => Some(&self.front),
            Side::Back => self.back.as_ref(),
        };
        model.map(|Model::Diffuse(diffuse)| Bsdf::Diffuse(diffuse.at::<C>(wavelengths)))
    }
}

impl<S: SpectrumArithmetic> Bsdf<S> {
    /// The directional-hemispherical reflectance for `outgoing`, in [0, 1].
    #[inline]
    pub fn albedo(&self) -> S {
        let Self::Diffuse(diffuse) = self;
        diffuse.albedo()
    }

    /// The shininess that go-with-the-winners asks for: 0 for a perfectly diffuse surface, infinite for a mirror.
    #[inline]
    pub fn shininess(&self) -> f32 {
        let Self::Diffuse(diffuse) = self;
        diffuse.shininess()
    }

    /// The bsdf and its sampling density for a pair of directions.
    #[inline]
    pub fn evaluate(&self, outgoing: Vec3, incident: Vec3) -> BsdfValue<S> {
        let Self::Diffuse(diffuse) = self;
        diffuse.evaluate(outgoing, incident)
    }

    /// Draws an incident direction from the uniform numbers `u` in [0, 1).
    #[inline]
    pub fn sample(&self, outgoing: Vec3, u: [f32; 2]) -> BsdfSample<S> {
        let Self::Diffuse(diffuse) = self;
        diffuse.sample(outgoing, u)
    }
}
