//! Probability densities that cannot be mixed up, and how two of them share one estimate.

/// A probability density over solid angle, in 1/sr.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct SolidAnglePdf(pub f32);

/// A probability density over surface area, in 1/(scene unit)^2.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct AreaPdf(pub f32);

impl AreaPdf {
    /// The same density over the solid angle seen from a point at `distance` (scene units), where the
    /// surface's unit normal and the direction to it have the absolute cosine `cosine`.
    ///
    /// A surface seen edge-on has an infinite density per solid angle.
    #[inline]
    pub fn to_solid_angle(self, distance: f32, cosine: f32) -> SolidAnglePdf {
        SolidAnglePdf(self.0 * distance * distance / cosine)
    }
}

impl SolidAnglePdf {
    /// The density of a strategy that is itself chosen with probability `probability`.
    #[inline(always)]
    pub fn chosen_with(self, probability: f32) -> Self {
        Self(self.0 * probability)
    }

    /// The density of a technique that takes `samples` samples on average where others take one: what its share is weighed by.
    #[inline(always)]
    pub fn taken_times(self, samples: f32) -> Self {
        Self(self.0 * samples)
    }
}

/// The weight of a sample drawn with density `own`, where another strategy could have drawn it with density
/// `other`: the power heuristic with exponent 2 (Veach 1997, section 9.2.4).
///
/// It is in [0, 1], and it is 1 where the other strategy cannot draw the sample.
#[inline(always)]
pub fn power_heuristic(own: SolidAnglePdf, other: SolidAnglePdf) -> f32 {
    // The ratio, unlike the squares, neither overflows nor underflows for densities that matter.
    let ratio = other.0 / own.0;
    1.0 / (1.0 + ratio * ratio)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_of_both_strategies_add_up_to_one() {
        for (a, b) in [(0.3, 0.7), (1e-20, 1e10), (5.0, 0.0), (1e30, 1e30)] {
            let (a, b) = (SolidAnglePdf(a), SolidAnglePdf(b));
            let sum = power_heuristic(a, b)
                + if b.0 > 0.0 {
                    power_heuristic(b, a)
                } else {
                    0.0
                };
            assert!((sum - 1.0).abs() < 1e-6, "{a:?} {b:?} {sum}");
        }
    }

    #[test]
    fn an_infinite_density_takes_all_the_weight() {
        let edge_on = AreaPdf(1.0).to_solid_angle(1.0, 0.0);
        assert_eq!(power_heuristic(SolidAnglePdf(1.0), edge_on), 0.0);
    }
}
