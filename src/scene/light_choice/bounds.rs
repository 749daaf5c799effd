//! Where a light or a group of lights is, where it shines, and how much.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::Vec3;

use super::cone::Cone;

/// Bounds of the light of one emitter, or of several together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightBounds {
    /// Least coordinates, world space.
    pub min: Vec3,
    /// Greatest coordinates, world space.
    pub max: Vec3,
    /// Radiant power, in any unit that all lights share; positive.
    pub power: f32,
    /// The outer normals of all surfaces.
    pub normals: Cone,
    /// The greatest angle between a normal and the light that leaves there, in radians, at most pi/2.
    pub spread: f32,
}

impl LightBounds {
    /// The bounds of two groups of lights together.
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
            power: self.power + other.power,
            normals: self.normals.union(other.normals),
            spread: self.spread.max(other.spread),
        }
    }

    /// The middle of the box.
    pub fn centre(&self) -> Vec3 {
        0.5 * (self.min + self.max)
    }

    /// What the lights cost as one group: power times the measures of their directions and of their box (Conty Estevez and
    /// Kulla 2018, section 4.4).
    pub fn cost(&self) -> f32 {
        let size = self.max - self.min;
        // Lights in a plane or on a line still differ by their place.
        let extent =
            size.x * size.y + size.y * size.z + size.z * size.x + 1e-3 * size.length_squared();
        let inner = self.normals.angle;
        let outer = (inner + self.spread).min(PI);
        let directions = 2.0 * PI * (1.0 - inner.cos())
            + FRAC_PI_2
                * (2.0 * outer * inner.sin()
                    - (inner - 2.0 * outer).cos()
                    - 2.0 * inner * inner.sin()
                    + inner.cos());
        self.power * directions * extent
    }
}
