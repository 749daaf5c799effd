//! Where a light or a group of lights is, where it shines, and how much: what its contribution is guessed from.

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

/// What remains of [`LightBounds`] to guess a contribution from: a sphere around the box, and cosines instead of angles.
#[derive(Clone, Copy, Debug)]
pub struct LightSphere {
    centre: Vec3,
    radius_squared: f32,
    power: f32,
    axis: Vec3,
    normals_sine: f32,
    normals_cosine: f32,
    /// The cosine of the greatest angle between a normal and light.
    spread_cosine: f32,
}

/// Importances lie between these limits, so that their quotients are numbers.
const IMPORTANCES: (f32, f32) = (1e-30, 1e30);

/// How far rounding may put light outside of its cone, in radians.
const SLACK: f32 = 1e-3;

impl From<&LightBounds> for LightSphere {
    fn from(bounds: &LightBounds) -> Self {
        let (normals_sine, normals_cosine) = bounds.normals.angle.sin_cos();
        Self {
            centre: bounds.centre(),
            radius_squared: 0.25 * (bounds.max - bounds.min).length_squared(),
            power: bounds.power,
            axis: bounds.normals.axis,
            normals_sine,
            normals_cosine,
            spread_cosine: (bounds.spread + SLACK).cos(),
        }
    }
}

impl LightSphere {
    /// An estimate of what arrives from the lights at a surface at `position` (world space) with this unit `normal`, of
    /// either side; 0 only where nothing can.
    ///
    /// Conty Estevez and Kulla 2018, equation 3, with the bounding sphere of the box as in pbrt-v4.
    #[inline]
    pub fn importance(&self, position: Vec3, normal: Vec3) -> f32 {
        let offset = self.centre - position;
        let distance_squared = offset.length_squared();
        // Within the sphere nothing is known of directions.
        if distance_squared <= self.radius_squared || distance_squared == 0.0 {
            return (self.power / self.radius_squared).clamp(IMPORTANCES.0, IMPORTANCES.1);
        }
        let towards_light = offset / distance_squared.sqrt();
        // The angle under which the sphere is seen.
        let seen = Angle::with_squared_sine((self.radius_squared / distance_squared).min(1.0));
        let normals = Angle {
            sine: self.normals_sine,
            cosine: self.normals_cosine,
        };
        // The least angle between a normal and a direction to the position.
        let emission = Angle::with_cosine(-self.axis.dot(towards_light));
        let emission = emission.less(normals).less(seen);
        if emission.cosine < self.spread_cosine {
            return 0.0;
        }
        let incidence = Angle::with_cosine(normal.dot(towards_light).abs()).less(seen);
        let importance = self.power * emission.cosine * incidence.cosine / distance_squared;
        importance.clamp(IMPORTANCES.0, IMPORTANCES.1)
    }
}

/// An angle from 0 to pi.
#[derive(Clone, Copy, Debug)]
struct Angle {
    sine: f32,
    cosine: f32,
}

impl Angle {
    #[inline]
    fn with_cosine(cosine: f32) -> Self {
        Self {
            sine: (1.0 - cosine * cosine).max(0.0).sqrt(),
            cosine,
        }
    }

    /// At most a right angle.
    #[inline]
    fn with_squared_sine(squared: f32) -> Self {
        Self {
            sine: squared.sqrt(),
            cosine: (1.0 - squared).sqrt(),
        }
    }

    /// The difference to another angle; 0 where that is larger.
    #[inline]
    fn less(self, other: Self) -> Self {
        if self.cosine > other.cosine {
            return Self {
                sine: 0.0,
                cosine: 1.0,
            };
        }
        Self {
            sine: self.sine * other.cosine - self.cosine * other.sine,
            cosine: self.cosine * other.cosine + self.sine * other.sine,
        }
    }
}
