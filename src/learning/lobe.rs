//! Where the lobes of a surface point: what goes on at a glossy surface depends on that as much as on the place.

use std::num::NonZeroU8;

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::moments::{MomentSums, Moments};
use crate::sampling::{FRAME_CLASSES, Frame};

/// Parts of each class of directions along either axis across it.
const PARTS: usize = 2;

/// How many classes of directions there are.
const CLASSES: usize = FRAME_CLASSES * PARTS * PARTS;

/// How many observations of the whole place each class of directions is filled up with.
const OF_PLACE: f32 = 4.0;

/// One of 24 classes of directions: which of the six axis directions is nearest, and the signs of the other two coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LobeClass(
    /// Counted from 1, so that no lobe takes no room.
    NonZeroU8,
);

impl LobeClass {
    /// That of a `direction` in world space, of any length: the one in which mirrors would pass on what a surface passes on about it.
    #[inline]
    pub fn of(direction: Vec3) -> Self {
        let nearest = Frame::class(direction);
        let [first, second] = match nearest / 2 {
            0 => [direction.y, direction.z],
            1 => [direction.z, direction.x],
            _ => [direction.x, direction.y],
        };
        let part = 2 * u8::from(first < 0.0) + u8::from(second < 0.0);
        Self(NonZeroU8::MIN.saturating_add(nearest as u8 * (PARTS * PARTS) as u8 + part))
    }

    #[inline]
    fn index(self) -> usize {
        usize::from(self.0.get()) - 1
    }
}

/// The sums of each class at one place.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct LobeSums([MomentSums; CLASSES]);

impl LobeSums {
    /// Those of one class.
    pub fn of(&mut self, class: LobeClass) -> &mut MomentSums {
        &mut self.0[class.index()]
    }

    pub fn add(&mut self, other: &Self, share: f32) {
        for (sums, other) in self.0.iter_mut().zip(&other.0) {
            sums.add(other, share);
        }
    }

    /// What these sums say, filled up with observations like those of the whole `place`.
    pub fn moments(&self, place: &Moments) -> LobeMoments {
        LobeMoments(self.0.map(|sums| sums.filled_up(OF_PLACE, place)))
    }
}

/// What is known of each class at one place.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct LobeMoments([Moments; CLASSES]);

impl LobeMoments {
    /// That of one class.
    #[inline]
    pub fn of(&self, class: LobeClass) -> &Moments {
        &self.0[class.index()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn classes_tell_directions_apart() {
        let mut seen = HashSet::new();
        for [major, first, second] in [[3.0, 1.0, 2.0], [2.0, 3.0, 1.0], [1.0, 2.0, 3.0]] {
            for signs in 0..8 {
                let sign = |bit: u32| if signs >> bit & 1 == 0 { 1.0 } else { -1.0 };
                let direction = Vec3::new(sign(0) * major, sign(1) * first, sign(2) * second);
                let class = LobeClass::of(direction);
                assert_eq!(class, LobeClass::of(0.1 * direction));
                seen.insert(class.index());
            }
        }
        assert_eq!(seen, (0..CLASSES).collect());
    }

    #[test]
    fn classes_are_filled_up_by_the_place() {
        let [known, unknown] = [Vec3::X, Vec3::NEG_X].map(LobeClass::of);
        let mut sums = LobeSums::default();
        for value in [1.0, 3.0, 3.0, 5.0] {
            sums.of(known).observe(&crate::learning::Observation {
                address: 0,
                lobe: Some(known),
                bin: None,
                odds: None,
                radiance: value,
                value,
                cost: 2.0,
            });
        }
        let place = Moments {
            mean: 1.0,
            square: 5.0,
            cost: 4.0,
        };
        let moments = sums.moments(&place);
        assert_eq!(*moments.of(unknown), place);
        let expected = Moments {
            mean: 2.0,
            square: 8.0,
            cost: 3.0,
        };
        assert_eq!(*moments.of(known), expected);
    }
}
