//! What paths that go on somewhere bring back, and what they cost, on average.

use serde::{Deserialize, Serialize};

use super::Observation;

/// Moments of the value of an [`Observation`], and its cost.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Moments {
    /// The mean of what a path that goes on there brings back, for albedo 1.
    pub mean: f32,
    /// The mean of its square; 0 where nothing was observed.
    pub square: f32,
    /// What such a path costs, where a bounce costs 1.
    pub cost: f32,
}

impl Moments {
    /// Where nothing was observed.
    pub(super) const NONE: Self = Self {
        mean: 0.0,
        square: 0.0,
        cost: 1.0,
    };
}

/// Sums over observations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct MomentSums {
    pub count: f32,
    value: f32,
    square: f32,
    cost: f32,
}

impl MomentSums {
    pub fn observe(&mut self, observation: &Observation) {
        self.count += 1.0;
        self.value += observation.value;
        self.square += observation.value * observation.value;
        self.cost += observation.cost;
    }

    pub fn add(&mut self, other: &Self, share: f32) {
        self.count += share * other.count;
        self.value += share * other.value;
        self.square += share * other.square;
        self.cost += share * other.cost;
    }

    /// The moments of these observations alone; of nothing, [`Moments::NONE`].
    pub fn moments(&self) -> Moments {
        if self.count > 0.0 {
            self.filled_up(0.0, &Moments::NONE)
        } else {
            Moments::NONE
        }
    }

    /// The moments of these observations and `count` others that have those of `others`; not all may be nothing.
    pub fn filled_up(&self, count: f32, others: &Moments) -> Moments {
        let mean = |sum: f32, other: f32| (sum + count * other) / (self.count + count);
        Moments {
            mean: mean(self.value, others.mean),
            square: mean(self.square, others.square),
            cost: mean(self.cost, others.cost),
        }
    }
}
