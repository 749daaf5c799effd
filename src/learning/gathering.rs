//! Observations of tiles that are traced side by side, put in in the order of the tiles.

use std::collections::BTreeMap;

use super::{Experience, LightObservation, Observation, PixelObservation};

/// What was observed in one tile.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Observations {
    /// Of path segments.
    pub segments: Vec<Observation>,
    /// Of lights.
    pub lights: Vec<LightObservation>,
    /// Of camera paths.
    pub pixels: Vec<PixelObservation>,
}

/// Sums do not depend on which tile is ready first: one that is early waits for those before it.
#[derive(Debug)]
pub struct Gathering {
    experience: Experience,
    next: usize,
    waiting: BTreeMap<usize, Observations>,
}

impl Gathering {
    /// Goes on with `experience`, of which tile number `first` is the next.
    pub fn new(experience: Experience, first: usize) -> Self {
        Self {
            experience,
            next: first,
            waiting: BTreeMap::new(),
        }
    }

    /// Tile number `tile` is ready. All tiles from the first on must come, each once.
    pub fn add(&mut self, tile: usize, observations: Observations) {
        self.waiting.insert(tile, observations);
        while let Some(observations) = self.waiting.remove(&self.next) {
            self.experience.add(&observations);
            self.next += 1;
        }
    }

    /// All tiles are ready.
    pub fn into_experience(self) -> Experience {
        self.experience
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of three of these numbers depend on their order.
    fn tile(number: usize) -> Observations {
        let observation = |value| Observation {
            address: 3,
            lobe: None,
            bin: None,
            odds: None,
            radiance: value,
            value,
            cost: 1.0,
        };
        let value = [1e8, 1.0, 2.0, 3.0, 4.0][number];
        Observations {
            segments: vec![observation(value), observation(0.5 * value)],
            lights: Vec::new(),
            pixels: vec![PixelObservation {
                pixel: number as u32,
                paths: 1,
                ..PixelObservation::default()
            }],
        }
    }

    fn gathered(order: &[usize]) -> Experience {
        let mut gathering = Gathering::new(Experience::default(), 0);
        for &number in order {
            gathering.add(number, tile(number));
        }
        gathering.into_experience()
    }

    #[test]
    fn the_order_in_which_tiles_are_ready_does_not_matter() {
        let in_order = gathered(&[0, 1, 2, 3, 4]);
        for order in [[4, 3, 2, 1, 0], [1, 0, 4, 2, 3], [0, 2, 4, 1, 3]] {
            assert_eq!(gathered(&order), in_order, "{order:?}");
        }
        // It would: the same observations as tiles of other numbers.
        let mut reversed = Gathering::new(Experience::default(), 0);
        (0..5).for_each(|number| reversed.add(number, tile(4 - number)));
        assert_ne!(reversed.into_experience(), in_order);
    }

    #[test]
    fn it_goes_on_where_a_pass_was_left() {
        for ready in 0..5 {
            let left = gathered(&(0..ready).collect::<Vec<_>>());
            let mut gathering = Gathering::new(left, ready);
            (ready..5)
                .rev()
                .for_each(|number| gathering.add(number, tile(number)));
            assert_eq!(
                gathering.into_experience(),
                gathered(&[0, 1, 2, 3, 4]),
                "{ready}"
            );
        }
    }
}
