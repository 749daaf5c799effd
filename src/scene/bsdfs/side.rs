//! The two sides of a surface.

use glam::Vec3;

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

    /// A vector of the front's normal direction as this side sees it.
    #[inline]
    pub fn facing(self, normal: Vec3) -> Vec3 {
        match self {
            Self::Front => normal,
            Self::Back => -normal,
        }
    }

    /// The opposite side.
    #[inline]
    pub fn other(self) -> Self {
        match self {
            Self::Front => Self::Back,
            Self::Back => Self::Front,
        }
    }
}
