//! `null`: a surface that is not there: light passes straight through. It has no parameters.

use glam::Vec3;

use super::{BsdfSample, DirectionNumbers, Discrete};
use crate::spectrum::SpectrumArithmetic;

/// A surface that light passes.
#[derive(Clone, Copy, Debug)]
pub struct Null;

impl Discrete for Null {}

impl Null {
    #[inline]
    pub(super) fn albedo<S: SpectrumArithmetic>(&self, _outgoing: Vec3) -> S {
        S::ONE
    }

    #[inline]
    pub(super) fn sample<S: SpectrumArithmetic>(
        &self,
        outgoing: Vec3,
        _numbers: &DirectionNumbers,
    ) -> BsdfSample<S> {
        BsdfSample::discrete(-outgoing, S::ONE)
    }
}
