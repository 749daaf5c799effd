//! `thindielectric`: a pane so thin that light goes straight on behind it, such as a window of one sheet. It has two sides.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `int_ior`, `ext_ior` | float, string or spectrum | indices of refraction: see [`index`](super::index) | `bk7`, `air` |
//! | `specular_reflectance` | spectrum or texture | factor of the reflected light, in [0, 1]; physically 1 | 1 |
//! | `specular_transmittance` | spectrum or texture | factor of the transmitted light, in [0, 1]; physically 1 | 1 |
//!
//! All reflections between the two faces are part of it.

use glam::Vec3;

use super::dielectric::Dielectric;
use super::{BsdfSample, DirectionNumbers, Discrete, fresnel};
use crate::spectrum::SpectrumArithmetic;

/// A thin pane at the wavelengths of one path.
#[derive(Clone, Copy, Debug)]
pub struct ThinDielectric<S> {
    /// Its faces, seen from outside.
    pub face: Dielectric<S>,
}

impl<S> Discrete for ThinDielectric<S> {}

impl<S: SpectrumArithmetic> ThinDielectric<S> {
    /// The share of light that the pane reflects: r + t r t + t r^3 t + ... = 2 r / (1 + r).
    #[inline]
    fn reflected(&self, cos: f32) -> S {
        self.face.fresnel(cos).map(|r| 2.0 * r / (1.0 + r))
    }

    #[inline]
    pub(super) fn albedo(&self, outgoing: Vec3) -> S {
        let reflected = self.reflected(outgoing.z);
        self.face.reflectance * reflected + self.face.transmittance * (S::ONE - reflected)
    }

    pub(super) fn sample(&self, outgoing: Vec3, numbers: &DirectionNumbers) -> BsdfSample<S> {
        let reflected = self.reflected(outgoing.z);
        let probability = reflected.hero();
        if numbers.choice < probability {
            let weight = self.face.reflectance * reflected / probability;
            BsdfSample::discrete(fresnel::reflect_local(outgoing), weight)
        } else {
            let weight = self.face.transmittance * (S::ONE - reflected) / (1.0 - probability);
            BsdfSample::discrete(-outgoing, weight)
        }
    }
}
