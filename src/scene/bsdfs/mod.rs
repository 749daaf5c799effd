//! Bsdfs: how surfaces scatter light.
//!
//! A [`Material`] is what the scene states, a tree: `twosided`, `mask`, `blendbsdf`, `bumpmap` and `normalmap` contain
//! other bsdfs. At a path vertex it becomes a [`Bsdf`]: one scattering model with all of its parameters evaluated at that point
//! for the wavelengths of one path, which next-event estimation, the strategy and all children of the vertex share.
//! Where materials are mixed, one of them is drawn there (see [`material`]), so that no `Bsdf` contains another.
//!
//! Directions are unit vectors in the local shading frame whose z axis is the normal of the side that was hit; both
//! point away from the surface. `outgoing` goes to where the path comes from and has z > 0, `incident` to where it goes on;
//! its z is negative behind the surface, in transmission. Values are those of radiance: they include the scaling by the squared
//! relative index with which radiance is compressed where it is refracted.

mod diffuse;
mod material;
mod null;
mod side;
mod twosided;

pub use diffuse::{Diffuse, DiffuseMaterial};
pub(super) use material::load;
pub use material::{Material, SeenPoint};
pub use null::Null;
pub use side::Side;

use glam::Vec3;

use crate::sampling::SolidAnglePdf;
use crate::spectrum::SpectrumArithmetic;

/// A scattering model of one side of a surface at the wavelengths of one path.
#[derive(Clone, Copy, Debug)]
pub enum Bsdf<S> {
    /// Lambertian reflection.
    Diffuse(Diffuse<S>),
    /// Nothing: light passes.
    Null(Null),
}

/// What the smooth lobes of a bsdf say of a pair of directions; discrete lobes have no values.
#[derive(Clone, Copy, Debug)]
pub struct BsdfValue<S> {
    /// The bsdf times the absolute cosine of the incident direction, in 1/sr.
    pub value: S,
    /// The density with which [`Bsdf::sample`] draws the incident direction.
    pub pdf: SolidAnglePdf,
    /// Whether the value is that of the hero wavelength alone: see [`BsdfSample::is_dispersive`].
    pub is_dispersive: bool,
}

impl<S: SpectrumArithmetic> BsdfValue<S> {
    /// Directions between which nothing is scattered.
    #[inline]
    pub(super) fn nothing() -> Self {
        Self::of(S::ZERO, 0.0)
    }

    /// A value for all wavelengths and the density `pdf` in 1/sr.
    #[inline]
    pub(super) fn of(value: S, pdf: f32) -> Self {
        Self {
            value,
            pdf: SolidAnglePdf(pdf),
            is_dispersive: false,
        }
    }
}

/// An incident direction drawn from a bsdf.
#[derive(Clone, Copy, Debug)]
pub struct BsdfSample<S> {
    /// The direction, local. It means nothing where `weight` is black.
    pub incident: Vec3,
    /// bsdf times absolute cosine over density, or over probability in a discrete lobe; black where no direction was found.
    pub weight: S,
    /// The density of `incident`; infinite in a discrete lobe, which only sampling can find.
    pub pdf: SolidAnglePdf,
    /// Index of refraction behind the surface over the one before it where the direction was refracted, otherwise 1.
    pub eta: f32,
    /// Whether only the hero wavelength goes in this direction: a path that follows it goes on with
    /// [`SpectrumArithmetic::only_hero`] of its throughput, unless it carries a single wavelength already.
    pub is_dispersive: bool,
}

impl<S: SpectrumArithmetic> BsdfSample<S> {
    /// No direction was found.
    #[inline]
    pub(super) fn failed() -> Self {
        Self::smooth(Vec3::Z, S::ZERO, 0.0)
    }

    /// A direction of a smooth lobe, not refracted, with the density `pdf` in 1/sr.
    #[inline]
    pub(super) fn smooth(incident: Vec3, weight: S, pdf: f32) -> Self {
        Self {
            incident,
            weight,
            pdf: SolidAnglePdf(pdf),
            eta: 1.0,
            is_dispersive: false,
        }
    }

    /// The direction of a discrete lobe, not refracted.
    #[inline]
    pub(super) fn discrete(incident: Vec3, weight: S) -> Self {
        Self::smooth(incident, weight, f32::INFINITY)
    }
}

/// Calls a method of the model that a bsdf is.
macro_rules! dispatch {
    ($bsdf:expr, $model:ident => $call:expr) => {
        match $bsdf {
            Bsdf::Diffuse($model) => $call,
            Bsdf::Null($model) => $call,
        }
    };
}

impl<S: SpectrumArithmetic> Bsdf<S> {
    /// The share of the light from `outgoing` that is scattered into any direction, in [0, 1]: the directional-hemispherical
    /// reflectance and transmittance. It leaves out the scaling of refracted radiance, and where a model has no closed form it is
    /// an approximation that is positive wherever the model scatters; strategies use it to distribute their particles.
    #[inline]
    pub fn albedo(&self, outgoing: Vec3) -> S {
        dispatch!(self, model => model.albedo(outgoing))
    }

    /// The shininess that go-with-the-winners asks for: 0 for a perfectly diffuse surface, infinite for a mirror. For rough
    /// surfaces it is the exponent of the Phong lobe that is as wide (Walter et al. 2007, section 5.2: 2/alpha^2 - 2).
    #[inline]
    pub fn shininess(&self, outgoing: Vec3) -> f32 {
        dispatch!(self, model => model.shininess(outgoing))
    }

    /// Whether light from directions other than a few discrete ones is scattered: only then next-event estimation can find any.
    #[inline]
    pub fn has_smooth_lobe(&self) -> bool {
        dispatch!(self, model => model.has_smooth_lobe())
    }

    /// The smooth lobes and their sampling density for a pair of directions.
    #[inline]
    pub fn evaluate(&self, outgoing: Vec3, incident: Vec3) -> BsdfValue<S> {
        dispatch!(self, model => model.evaluate(outgoing, incident))
    }

    /// Draws an incident direction from the uniform numbers `u` in [0, 1); the third chooses among lobes.
    #[inline]
    pub fn sample(&self, outgoing: Vec3, u: [f32; 3]) -> BsdfSample<S> {
        dispatch!(self, model => model.sample(outgoing, u))
    }
}
