//! Cones of directions.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::Vec3;

/// All unit vectors that make at most an angle with an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Unit vector.
    pub axis: Vec3,
    /// The angle in radians, from 0 to pi.
    pub angle: f32,
}

impl Cone {
    /// All directions.
    pub const EVERYWHERE: Self = Self {
        axis: Vec3::Z,
        angle: PI,
    };

    /// What rounding does to angles.
    const SLACK: f32 = 1e-3;

    /// A cone that holds unit vectors and all their normalised positive combinations; [everywhere](Self::EVERYWHERE) where
    /// they do not lie in less than a hemisphere.
    pub fn about(vectors: impl Iterator<Item = Vec3> + Clone) -> Self {
        let sum: Vec3 = vectors.clone().sum();
        let Some(axis) = sum.try_normalize() else {
            return Self::EVERYWHERE;
        };
        let angle = vectors
            .map(|vector| vector.angle_between(axis))
            .fold(0.0, f32::max)
            + Self::SLACK;
        if angle < FRAC_PI_2 {
            Self { axis, angle }
        } else {
            Self::EVERYWHERE
        }
    }

    /// A cone that holds two cones (Conty Estevez and Kulla 2018, algorithm 1).
    pub fn union(self, other: Self) -> Self {
        let (wide, narrow) = if self.angle >= other.angle {
            (self, other)
        } else {
            (other, self)
        };
        let between = wide.axis.angle_between(narrow.axis);
        if between + narrow.angle <= wide.angle {
            return wide;
        }
        let angle = 0.5 * (wide.angle + between + narrow.angle);
        let perpendicular = narrow.axis - wide.axis * wide.axis.dot(narrow.axis);
        match perpendicular.try_normalize() {
            Some(perpendicular) if angle < PI => {
                let (sine, cosine) = (angle - wide.angle).sin_cos();
                Self {
                    axis: (wide.axis * cosine + perpendicular * sine).normalize(),
                    angle: (angle + Self::SLACK).min(PI),
                }
            }
            _ => Self::EVERYWHERE,
        }
    }
}
