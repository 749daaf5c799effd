//! Observations of tiles that are traced side by side, put in in the order of the tiles.

use std::collections::BTreeMap;

use super::{Experience, Observation, PixelObservation};

/// What was observed in one tile.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Observations {
    /// Of path segments.
    pub segments: Vec<Observation>,
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
