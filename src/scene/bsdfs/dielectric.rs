//! `dielectric`: the smooth interface of two transparent materials, such as glass in air. It has two sides.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `int_ior`, `ext_ior` | float, string or spectrum | indices of refraction: see [`index`](super::index) | `bk7`, `air` |
//! | `specular_reflectance` | spectrum or texture | factor of the reflected light, in [0, 1]; physically 1 | 1 |
//! | `specular_transmittance` | spectrum or texture | factor of the refracted light, in [0, 1]; physically 1 | 1 |
//!
//! Where an index depends on the wavelength, refracted light is split up.

use glam::Vec3;

use super::index::Indices;
use super::{BsdfSample, DirectionNumbers, Discrete, Side, fresnel};
use crate::scene::error::SceneError;
use crate::scene::shapes::SurfaceParameters;
use crate::scene::textures::{SpectrumTexture, TextureLoader};
use crate::scene::xml::Object;
use crate::spectrum::{Colour, SpectralCurve, SpectrumArithmetic};

/// A smooth interface as the scene states it; also that of `thindielectric` and `roughdielectric`.
#[derive(Clone, Debug)]
pub struct DielectricMaterial {
    /// The indices of refraction.
    pub indices: Indices,
    /// Factor of the reflected light.
    pub specular_reflectance: SpectrumTexture,
    /// Factor of the refracted light.
    pub specular_transmittance: SpectrumTexture,
}

impl DielectricMaterial {
    pub(super) fn load(object: &Object, textures: &mut TextureLoader) -> Result<Self, SceneError> {
        let material = Self::load_parameters(object, textures)?;
        object.finish()?;
        Ok(material)
    }

    /// As [`Self::load`], for an object that has more parameters.
    pub(super) fn load_parameters(
        object: &Object,
        textures: &mut TextureLoader,
    ) -> Result<Self, SceneError> {
        let reflectance = textures.reflectance(object, "specular_reflectance", 1.0)?;
        let transmittance = textures.reflectance(object, "specular_transmittance", 1.0)?;
        Ok(Self {
            indices: Indices::load(object, "bk7")?,
            specular_reflectance: reflectance,
            specular_transmittance: transmittance,
        })
    }

    /// Whether light passes as if nothing were there: there is no change of index, and no colour.
    pub(super) fn is_invisible(&self) -> bool {
        let is_one = |curve: &SpectralCurve| curve.is_constant() && curve.rgb() == [1.0; 3];
        let is_clear = match &self.specular_transmittance {
            SpectrumTexture::Uniform(transmittance) => is_one(transmittance),
            SpectrumTexture::Varying(_) => false,
        };
        is_clear && self.indices.are_equal()
    }

    pub(super) fn needs_parameters(&self) -> bool {
        self.specular_reflectance.varies() || self.specular_transmittance.varies()
    }

    pub(super) fn at<C: Colour>(
        &self,
        side: Side,
        point: &SurfaceParameters,
        wavelengths: &C::Wavelengths,
    ) -> Dielectric<C::Spectrum> {
        Dielectric {
            eta: self.indices.at::<C>(side, wavelengths),
            reflectance: self.specular_reflectance.spectrum::<C>(point, wavelengths),
            transmittance: self
                .specular_transmittance
                .spectrum::<C>(point, wavelengths),
        }
    }
}

/// A smooth interface, seen from one side, at the wavelengths of one path.
#[derive(Clone, Copy, Debug)]
pub struct Dielectric<S> {
    /// Index of refraction behind the interface over the one before it.
    pub eta: S,
    /// Factor of the reflected light.
    pub reflectance: S,
    /// Factor of the refracted light.
    pub transmittance: S,
}

impl<S> Discrete for Dielectric<S> {}

impl<S: SpectrumArithmetic> Dielectric<S> {
    /// The share of light that is reflected at the absolute cosine `cos`.
    #[inline]
    pub(super) fn fresnel(&self, cos: f32) -> S {
        self.eta
            .map(|eta| fresnel::dielectric(cos, eta).reflectance)
    }

    /// Whether the wavelengths are refracted differently.
    #[inline]
    pub(super) fn is_dispersive(&self) -> bool {
        let hero = self.eta.hero();
        self.eta.components().iter().any(|&eta| eta != hero)
    }

    #[inline]
    pub(super) fn albedo(&self, outgoing: Vec3) -> S {
        self.albedo_at(outgoing.z)
    }

    /// What is reflected and refracted at the cosine `cos`.
    #[inline]
    pub(super) fn albedo_at(&self, cos: f32) -> S {
        let reflected = self.fresnel(cos);
        self.reflectance * reflected + self.transmittance * (S::ONE - reflected)
    }

    /// The hero wavelength's Fresnel reflectance decides between reflection and refraction.
    pub(super) fn sample(&self, outgoing: Vec3, numbers: &DirectionNumbers) -> BsdfSample<S> {
        let eta = self.eta.hero();
        let interface = fresnel::dielectric(outgoing.z, eta);
        let reflected = self.fresnel(outgoing.z);
        if numbers.choice < interface.reflectance {
            let weight = self.reflectance * reflected / interface.reflectance;
            return BsdfSample::discrete(fresnel::reflect_local(outgoing), weight);
        }
        let incident = fresnel::refract(outgoing, Vec3::Z, interface.cos_refracted, eta);
        let refracted = (S::ONE - reflected) / (1.0 - interface.reflectance);
        // Radiance is less where light of one direction is spread over more solid angle.
        let compression = self.eta.map(|eta| 1.0 / (eta * eta));
        BsdfSample {
            eta,
            is_dispersive: self.is_dispersive(),
            ..BsdfSample::discrete(incident, self.transmittance * refracted * compression)
        }
    }
}
