//! `conductor`: a smooth metal: a mirror with the colours of its material. One-sided.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `material`, `eta`, `k` | | what it is made of: see [`conductor_materials`](super::conductor_materials) | a perfect mirror |
//! | `specular_reflectance` | spectrum or texture | factor of the reflected light, in [0, 1]; physically 1 | 1 |

use glam::Vec3;

use super::conductor_materials::ConductorIndex;
use super::{BsdfSample, DirectionNumbers, Discrete, fresnel};
use crate::scene::error::SceneError;
use crate::scene::shapes::SurfaceParameters;
use crate::scene::textures::{SpectrumTexture, TextureLoader};
use crate::scene::xml::Object;
use crate::spectrum::{Colour, SpectrumArithmetic};

/// A smooth metal as the scene states it.
#[derive(Clone, Debug)]
pub struct ConductorMaterial {
    /// What it is made of.
    pub index: ConductorIndex,
    /// Factor of the reflected light.
    pub specular_reflectance: SpectrumTexture,
}

impl ConductorMaterial {
    pub(super) fn load(object: &Object, textures: &mut TextureLoader) -> Result<Self, SceneError> {
        let material = Self {
            index: ConductorIndex::load(object, textures)?,
            specular_reflectance: textures.reflectance(object, "specular_reflectance", 1.0)?,
        };
        object.finish()?;
        Ok(material)
    }

    /// Whether it differs from point to point.
    pub(super) fn varies(&self) -> bool {
        self.index.varies() || self.specular_reflectance.varies()
    }

    /// Makes it the mean of its textures.
    pub(super) fn make_uniform(&mut self) {
        self.index.make_uniform();
        self.specular_reflectance.make_uniform();
    }

    pub(super) fn at<C: Colour>(
        &self,
        point: &SurfaceParameters,
        wavelengths: &C::Wavelengths,
    ) -> Conductor<C::Spectrum> {
        Conductor {
            eta: self.index.eta.spectrum::<C>(point, wavelengths),
            k: self.index.k.spectrum::<C>(point, wavelengths),
            reflectance: self.specular_reflectance.spectrum::<C>(point, wavelengths),
        }
    }
}

/// A smooth metal at the wavelengths of one path.
#[derive(Clone, Copy, Debug)]
pub struct Conductor<S> {
    /// Real part of the index of refraction.
    pub eta: S,
    /// Imaginary part of the index of refraction.
    pub k: S,
    /// Factor of the reflected light.
    pub reflectance: S,
}

impl<S> Discrete for Conductor<S> {}

impl<S: SpectrumArithmetic> Conductor<S> {
    /// The share of light that is reflected at the cosine `cos`.
    #[inline]
    pub(super) fn fresnel(&self, cos: f32) -> S {
        self.reflectance
            * self
                .eta
                .zip(self.k, |eta, k| fresnel::conductor(cos, eta, k))
    }

    #[inline]
    pub(super) fn albedo(&self, outgoing: Vec3) -> S {
        self.fresnel(outgoing.z)
    }

    #[inline]
    pub(super) fn sample(&self, outgoing: Vec3, _numbers: &DirectionNumbers) -> BsdfSample<S> {
        let incident = fresnel::reflect_local(outgoing);
        BsdfSample::discrete(incident, self.fresnel(outgoing.z))
    }
}
