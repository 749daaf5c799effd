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

mod beckmann;
mod blend;
mod bump_map;
mod chunk;
mod conductor;
mod conductor_materials;
mod dielectric;
mod diffuse;
mod discrete;
mod effects;
mod fresnel;
mod index;
mod mask;
mod material;
mod microfacet;
mod normal_map;
mod null;
mod perturbed;
mod plain;
mod plastic;
mod principled;
mod refraction;
mod rough_coating;
mod rough_conductor;
mod rough_dielectric;
mod rough_plastic;
mod roughness;
mod sellmeier;
mod side;
mod stated;
mod surface;
mod thin_dielectric;
mod twosided;

pub(crate) use beckmann::SlopeLanes;
pub(crate) use chunk::{BsdfSamples, BsdfValues};
pub use conductor::{Conductor, ConductorMaterial};
pub use conductor_materials::ConductorIndex;
pub use dielectric::{Dielectric, DielectricMaterial};
pub use diffuse::{Diffuse, DiffuseMaterial};
use discrete::Discrete;
pub use index::Indices;
pub(super) use material::load;
pub use material::{Material, SeenPoint};
pub use microfacet::Distribution;
pub use null::Null;
pub use perturbed::Perturbed;
pub use plastic::{CoatedBase, Plastic, PlasticMaterial};
pub use principled::{
    CommonParameters, Principled, PrincipledMaterial, PrincipledThin, PrincipledThinMaterial,
};
pub use refraction::Refraction;
pub use rough_conductor::{RoughConductor, RoughConductorMaterial};
pub use rough_dielectric::{RoughDielectric, RoughDielectricMaterial};
pub use rough_plastic::{RoughPlastic, RoughPlasticMaterial};
pub use roughness::Roughness;
pub use side::Side;
pub use thin_dielectric::ThinDielectric;

use glam::{Vec2, Vec3};

use crate::sampling::{SolidAnglePdf, warp};
use crate::spectrum::SpectrumArithmetic;

/// How one side of a surface scatters light at the wavelengths of one path.
#[derive(Clone, Copy, Debug)]
pub enum Bsdf<S> {
    /// By a model in the shading frame.
    Plain(Model<S>),
    /// By a model in a frame of its own, that of a bump or a normal map.
    Perturbed(Perturbed<S>),
}

/// A scattering model with its parameters.
#[derive(Clone, Copy, Debug)]
pub enum Model<S> {
    /// Lambertian reflection.
    Diffuse(Diffuse<S>),
    /// A smooth metal.
    Conductor(Conductor<S>),
    /// A rough metal.
    RoughConductor(RoughConductor<S>),
    /// A smooth interface.
    Dielectric(Dielectric<S>),
    /// A rough interface.
    RoughDielectric(RoughDielectric<S>),
    /// A thin pane.
    ThinDielectric(ThinDielectric<S>),
    /// A diffuse base under a smooth coating.
    Plastic(Plastic<S>),
    /// A diffuse base under a rough coating.
    RoughPlastic(RoughPlastic<S>),
    /// The surface of a solid, a mixture of many lobes.
    Principled(Principled<S>),
    /// A sheet, a mixture of many lobes.
    PrincipledThin(PrincipledThin<S>),
    /// Nothing: light passes.
    Null(Null),
}

/// Random numbers for one direction.
#[derive(Clone, Copy, Debug)]
pub struct DirectionNumbers {
    /// Uniform in [0, 1)^2.
    pub square: [f32; 2],
    /// The direction that diffuse lobes take: above the surface in the shading frame, distributed by the cosine to its normal. Who puts one of another
    /// distribution there corrects weights and densities.
    pub diffuse: Vec3,
    /// Chooses among lobes: uniform in [0, 1).
    pub choice: f32,
    /// The slope that `square` gives where the bsdf has a [`slope_view`](Bsdf::slope_view), if it has been found already.
    slope: Option<Vec2>,
}

impl DirectionNumbers {
    /// Numbers that are uniform in [0, 1), of which all lobes take the first two.
    #[inline]
    pub fn new([u, v, choice]: [f32; 3]) -> Self {
        Self {
            square: [u, v],
            diffuse: warp::cosine_hemisphere([u, v]),
            choice,
            slope: None,
        }
    }

    /// The same, with another direction for diffuse lobes.
    #[inline]
    pub(crate) fn with_diffuse(self, diffuse: Vec3) -> Self {
        Self { diffuse, ..self }
    }

    /// The same, whose `slope` has been found.
    #[inline]
    pub(crate) fn with_slope(self, slope: Option<Vec2>) -> Self {
        Self { slope, ..self }
    }
}

/// How the lobes of a bsdf share the directions that it draws.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lobes {
    /// The probability with which [`Bsdf::sample`] takes the direction [for diffuse lobes](DirectionNumbers::diffuse).
    pub diffuse: f32,
    /// Whether any of the others is smooth.
    pub has_glossy: bool,
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

    /// A direction drawn with the density that `value` states.
    #[inline]
    pub(super) fn of_value(incident: Vec3, value: BsdfValue<S>) -> Self {
        if !(value.pdf.0 > 0.0 && value.pdf.0.is_finite()) {
            return Self::failed();
        }
        Self {
            is_dispersive: value.is_dispersive,
            ..Self::smooth(incident, value.value / value.pdf.0, value.pdf.0)
        }
    }

    /// The direction of a discrete lobe, not refracted.
    #[inline]
    pub(super) fn discrete(incident: Vec3, weight: S) -> Self {
        Self::smooth(incident, weight, f32::INFINITY)
    }
}

/// The shininess of lobes that scatter the given shares of the light: the one whose 1 / (s + 1), the spread that
/// go-with-the-winners asks for, is the mean of theirs.
pub(super) fn mixed_shininess<const N: usize>(shares: [f32; N], shininess: [f32; N]) -> f32 {
    let spread = |i: usize| shares[i] / (shininess[i] + 1.0);
    let mean = (0..N).map(spread).sum::<f32>() / shares.iter().sum::<f32>();
    // Not-a-number, where nothing is scattered, is not below 1.
    if mean < 1.0 { 1.0 / mean - 1.0 } else { 0.0 }
}

/// Calls a method of the model that a bsdf has, in whichever frame.
macro_rules! dispatch_frame {
    ($bsdf:expr, $model:ident => $call:expr) => {
        match $bsdf {
            Bsdf::Plain($model) => $call,
            Bsdf::Perturbed($model) => $call,
        }
    };
}

/// Calls a method of a model.
macro_rules! dispatch {
    ($bsdf:expr, $model:ident => $call:expr) => {
        match $bsdf {
            Model::Diffuse($model) => $call,
            Model::Conductor($model) => $call,
            Model::RoughConductor($model) => $call,
            Model::Dielectric($model) => $call,
            Model::RoughDielectric($model) => $call,
            Model::ThinDielectric($model) => $call,
            Model::Plastic($model) => $call,
            Model::RoughPlastic($model) => $call,
            Model::Principled($model) => $call,
            Model::PrincipledThin($model) => $call,
            Model::Null($model) => $call,
        }
    };
}

impl<S: SpectrumArithmetic> Bsdf<S> {
    /// The share of the light from `outgoing` that is scattered into any direction, in [0, 1]: the directional-hemispherical
    /// reflectance and transmittance. It leaves out the scaling of refracted radiance, and where a model has no closed form it is
    /// an approximation that is positive wherever the model scatters; strategies use it to distribute their particles.
    #[inline]
    pub fn albedo(&self, outgoing: Vec3) -> S {
        dispatch_frame!(self, model => model.albedo(outgoing))
    }

    /// The shininess that go-with-the-winners asks for: 0 for a perfectly diffuse surface, infinite for a mirror. For rough
    /// surfaces it is the exponent of the Phong lobe that is as wide (Walter et al. 2007, section 5.2: 2/alpha^2 - 2).
    #[inline]
    pub fn shininess(&self, outgoing: Vec3) -> f32 {
        dispatch_frame!(self, model => model.shininess(outgoing))
    }

    /// The lobes of which directions are drawn. Those of a tilted surface are not diffuse: the normal is another.
    #[inline]
    pub fn lobes(&self, outgoing: Vec3) -> Lobes {
        match self {
            Self::Plain(model) => model.lobes(outgoing),
            Self::Perturbed(model) => Lobes {
                diffuse: 0.0,
                has_glossy: model.has_smooth_lobe(),
            },
        }
    }

    /// Whether light from directions other than a few discrete ones is scattered: only then next-event estimation can find any.
    #[inline]
    pub fn has_smooth_lobe(&self) -> bool {
        dispatch_frame!(self, model => model.has_smooth_lobe())
    }

    /// The smooth lobes and their sampling density for a pair of directions.
    #[inline]
    pub fn evaluate(&self, outgoing: Vec3, incident: Vec3) -> BsdfValue<S> {
        dispatch_frame!(self, model => model.evaluate(outgoing, incident))
    }

    /// The cosine under which the slope of a facet is looked for when a direction is drawn, if it takes a search: that of many can be done
    /// [at once](SlopeLanes).
    #[inline]
    pub(crate) fn slope_view(&self, outgoing: Vec3) -> Option<f32> {
        dispatch_frame!(self, model => model.slope_view(outgoing))
    }

    /// Draws an incident direction.
    #[inline]
    pub fn sample(&self, outgoing: Vec3, numbers: &DirectionNumbers) -> BsdfSample<S> {
        dispatch_frame!(self, model => model.sample(outgoing, numbers))
    }
}

impl<S: SpectrumArithmetic> Model<S> {
    #[inline]
    fn albedo(&self, outgoing: Vec3) -> S {
        dispatch!(self, model => model.albedo(outgoing))
    }

    #[inline]
    fn shininess(&self, outgoing: Vec3) -> f32 {
        dispatch!(self, model => model.shininess(outgoing))
    }

    #[inline]
    fn lobes(&self, outgoing: Vec3) -> Lobes {
        match self {
            Self::Diffuse(model) => model.lobes(),
            Self::Plastic(model) => model.lobes(outgoing),
            Self::RoughPlastic(model) => model.lobes(outgoing),
            Self::Principled(model) => model.lobes(),
            Self::PrincipledThin(model) => model.lobes(),
            other => Lobes {
                diffuse: 0.0,
                has_glossy: other.has_smooth_lobe(),
            },
        }
    }

    #[inline]
    fn has_smooth_lobe(&self) -> bool {
        dispatch!(self, model => model.has_smooth_lobe())
    }

    #[inline]
    fn evaluate(&self, outgoing: Vec3, incident: Vec3) -> BsdfValue<S> {
        dispatch!(self, model => model.evaluate(outgoing, incident))
    }

    #[inline]
    fn slope_view(&self, outgoing: Vec3) -> Option<f32> {
        match self {
            Self::RoughConductor(model) => model.slope_view(outgoing),
            Self::RoughDielectric(model) => model.slope_view(outgoing),
            Self::RoughPlastic(model) => model.slope_view(outgoing),
            _ => None,
        }
    }

    #[inline]
    fn sample(&self, outgoing: Vec3, numbers: &DirectionNumbers) -> BsdfSample<S> {
        dispatch!(self, model => model.sample(outgoing, numbers))
    }
}

#[cfg(test)]
mod tests;
