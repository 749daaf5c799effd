//! What models have in common that scatter light into a few directions only.

use glam::Vec3;

use super::BsdfValue;
use crate::spectrum::SpectrumArithmetic;

/// A model whose lobes are all discrete: only sampling finds them.
pub(super) trait Discrete {
    /// That of a mirror.
    #[inline]
    fn shininess(&self, _outgoing: Vec3) -> f32 {
        f32::INFINITY
    }

    /// There is none.
    #[inline]
    fn has_smooth_lobe(&self) -> bool {
        false
    }

    /// Between two given directions nothing is scattered.
    #[inline]
    fn evaluate<S: SpectrumArithmetic>(&self, _outgoing: Vec3, _incident: Vec3) -> BsdfValue<S> {
        BsdfValue::nothing()
    }
}
