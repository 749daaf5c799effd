//! What lights can contribute to a surface, guessed for several at once.

use super::Receiver;
use super::bounds::LightBounds;
use crate::lanes::VectorLanes;

/// What remains of the [`LightBounds`] of `N` groups of lights to guess contributions from: spheres around their boxes, and cosines instead of angles.
/// Lanes without lights have no power.
#[derive(Clone, Debug)]
pub struct LightLanes<const N: usize> {
    /// The middles of the spheres, world space.
    centre: VectorLanes<N>,
    radius_squared: [f32; N],
    power: [f32; N],
    /// The axes of the cones that hold the normals.
    axis: VectorLanes<N>,
    normals_sine: [f32; N],
    normals_cosine: [f32; N],
    /// The cosine of the greatest angle between a normal and light.
    spread_cosine: [f32; N],
}

/// Importances lie between these limits, so that their quotients are numbers.
const IMPORTANCES: [f32; 2] = [1e-30, 1e30];

/// How far rounding may put light outside of its cone or below the surface, in radians.
const SLACK: f32 = 1e-3;

impl<const N: usize> LightLanes<N> {
    /// No lights.
    pub fn none() -> Self {
        Self {
            centre: VectorLanes::default(),
            radius_squared: [0.0; N],
            power: [0.0; N],
            axis: VectorLanes::default(),
            normals_sine: [0.0; N],
            normals_cosine: [1.0; N],
            spread_cosine: [0.0; N],
        }
    }

    /// Puts a group of lights into its lane.
    pub fn put(&mut self, lane: usize, bounds: &LightBounds) {
        self.centre.put(lane, bounds.centre());
        self.radius_squared[lane] = 0.25 * (bounds.max - bounds.min).length_squared();
        self.power[lane] = bounds.power;
        self.axis.put(lane, bounds.normals.axis);
        (self.normals_sine[lane], self.normals_cosine[lane]) = bounds.normals.angle.sin_cos();
        self.spread_cosine[lane] = (bounds.spread + SLACK).cos();
    }

    /// Estimates of what arrives from the lights of each lane at a surface; 0 only where nothing can.
    ///
    /// Conty Estevez and Kulla 2018, equation 3, with the bounding sphere of the box as in pbrt-v4.
    #[inline(always)]
    pub fn importances(&self, receiver: &Receiver) -> [f32; N] {
        let &Receiver {
            position,
            normal,
            scatters_below,
        } = receiver;
        let mut importances = [0.0; N];
        // No jumps: one loop over lanes.
        for (lane, importance) in importances.iter_mut().enumerate() {
            let (power, radius_squared) = (self.power[lane], self.radius_squared[lane]);
            let offset = self.centre.get(lane) - position;
            let distance_squared = offset.length_squared();
            // Within the sphere nothing is known of directions.
            let is_within = (distance_squared <= radius_squared) | (distance_squared == 0.0);
            let towards_light = offset * (1.0 / distance_squared.sqrt());
            // The angle under which the sphere is seen.
            let seen = Angle::with_squared_sine(radius_squared / distance_squared);
            let normals = Angle {
                sine: self.normals_sine[lane],
                cosine: self.normals_cosine[lane],
            };
            // The least angle between a normal and a direction to the position.
            let emission = Angle::with_cosine(-self.axis.get(lane).dot(towards_light));
            let emission = emission.less(normals).less(seen);
            let cosine = normal.dot(towards_light);
            let cosine = choose(scatters_below, cosine.abs(), cosine);
            // The least angle between the normal and a direction to the lights.
            let incidence = Angle::with_cosine(cosine).less(seen);
            let arriving = power * emission.cosine * incidence.cosine / distance_squared;
            let guess = choose(is_within, power / radius_squared, arriving);
            let is_above = incidence.cosine >= -SLACK;
            let can_arrive = is_within | (emission.cosine >= self.spread_cosine[lane]) & is_above;
            *importance = choose((power > 0.0) & can_arrive, within_limits(guess), 0.0);
        }
        importances
    }
}

/// The nearest number within [`IMPORTANCES`]; the least for what is no number.
#[inline(always)]
fn within_limits(importance: f32) -> f32 {
    let [least, most] = IMPORTANCES;
    let at_least = choose(importance > least, importance, least);
    choose(at_least < most, at_least, most)
}

#[inline(always)]
fn choose(condition: bool, yes: f32, no: f32) -> f32 {
    if condition { yes } else { no }
}

/// An angle from 0 to pi.
#[derive(Clone, Copy, Debug)]
struct Angle {
    sine: f32,
    cosine: f32,
}

impl Angle {
    #[inline(always)]
    fn with_cosine(cosine: f32) -> Self {
        Self {
            sine: (1.0 - cosine * cosine).max(0.0).sqrt(),
            cosine,
        }
    }

    /// At most a right angle.
    #[inline(always)]
    fn with_squared_sine(squared: f32) -> Self {
        let squared = choose(squared < 1.0, squared, 1.0);
        Self {
            sine: squared.sqrt(),
            cosine: (1.0 - squared).sqrt(),
        }
    }

    /// The difference to another angle; 0 where that is larger.
    #[inline(always)]
    fn less(self, other: Self) -> Self {
        let is_larger = self.cosine > other.cosine;
        let sine = self.sine * other.cosine - self.cosine * other.sine;
        let cosine = self.cosine * other.cosine + self.sine * other.sine;
        Self {
            sine: choose(is_larger, 0.0, sine),
            cosine: choose(is_larger, 1.0, cosine),
        }
    }
}
