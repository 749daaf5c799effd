//! What refraction has done to a path.

/// The traces that refraction leaves on a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Refraction {
    /// Whether of the path's wavelengths only the hero is left: it was refracted apart from the others.
    pub is_single: bool,
    /// The squared index of refraction where the path is, relative to where it began. Radiance is compressed by as much, and with
    /// it the throughput; how much light the path can still carry to the camera is not.
    pub squared_index: f32,
}

impl Refraction {
    /// Nothing yet.
    pub const NONE: Self = Self {
        is_single: false,
        squared_index: 1.0,
    };

    /// After a direction that was refracted with the relative index `eta` (1 if it was not), by wavelength if `is_dispersive`.
    #[inline]
    pub fn then(self, eta: f32, is_dispersive: bool) -> Self {
        Self {
            is_single: self.is_single || is_dispersive,
            squared_index: self.squared_index * eta * eta,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_goes_in_and_comes_out_is_as_it_was() {
        let inside = Refraction::NONE.then(1.5, false);
        assert_eq!(inside.squared_index, 2.25);
        let outside = inside.then(1.0, false).then(1.0 / 1.5, true);
        assert!((outside.squared_index - 1.0).abs() < 1e-6);
        assert!(!inside.is_single && outside.is_single);
        assert!(outside.then(1.5, false).is_single);
    }
}
