//! The children that a strategy has given to a population.

use multiversion::multiversion;

use super::{ExpectedCount, Population, Rounding, WalkReport};
use crate::room::{make_room, resize};
use crate::sampling::RandomStream;

/// One particle of the next generation, at the vertex of its parent and about to choose its direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Child {
    /// The parent's index in the population.
    pub parent: u32,
    /// What the parent's throughput is multiplied by: 1 / nu of the parent, always finite.
    pub weight: f32,
}

/// The children of a population, in the order of their parents, so that siblings stand side by side.
///
/// Reused from one call to the next, it allocates nothing once it has grown to the size of the batches.
#[derive(Debug, Default)]
pub struct Offspring {
    children: Vec<Child>,
    /// What the strategy wishes for each particle.
    wishes: Vec<f32>,
    /// nu of each particle.
    expected: Vec<ExpectedCount>,
}

impl Offspring {
    /// No children yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// The children of the population last resampled.
    pub fn children(&self) -> &[Child] {
        &self.children
    }

    /// Puts `count` siblings in the place of every child, which share its weight.
    pub fn split_each(&mut self, count: u32) {
        let decided = self.children.len();
        let share = 1.0 / count as f32;
        let nobody = Child {
            parent: 0,
            weight: 0.0,
        };
        self.children.resize(decided * count as usize, nobody);
        // From the last on: the places of those before are not needed any more.
        for index in (0..self.children.len()).rev() {
            let child = self.children[index / count as usize];
            self.children[index] = Child {
                weight: child.weight * share,
                ..child
            };
        }
    }

    /// nu of each particle of the population last resampled: the mean of its number of children.
    pub fn expected_counts(&self) -> &[ExpectedCount] {
        &self.expected
    }

    /// Room for one wish per particle of a population, with unspecified contents.
    pub(super) fn wishes_mut(&mut self, particles: usize) -> &mut [f32] {
        resize(&mut self.wishes, particles);
        &mut self.wishes
    }

    /// Turns the wishes into expected counts that keep the estimator unbiased whatever was wished:
    /// zero exactly for the particles that do not matter, and for those with impossible numbers, which are reported.
    pub(super) fn settle(&mut self, population: &Population) -> WalkReport {
        resize(&mut self.expected, population.len());
        if settle(population, &self.wishes, &mut self.expected) {
            WalkReport::default()
        } else {
            WalkReport::on(population)
        }
    }

    /// Draws the children from the expected counts, jointly within each group where `rounding` is joint.
    pub(super) fn draw(
        &mut self,
        rounding: Rounding,
        population: &Population,
        random: &mut RandomStream,
    ) {
        let children: ExpectedCount = self.expected.iter().copied().sum();
        make_room(&mut self.children, children.whole() as usize + 1);
        rounding.draw(&self.expected, population, random, &mut self.children);
    }
}

/// Writes what `wishes` come to for the particles of `population` into `counts`, all of one length. Returns whether all
/// particles are sound.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
fn settle(population: &Population, wishes: &[f32], counts: &mut [ExpectedCount]) -> bool {
    let mut all_sound = true;
    let particles = population.particles().zip(wishes);
    for ((particle, &wish), count) in particles.zip(counts) {
        let sound = particle.is_sound();
        all_sound &= sound;
        let wished = ExpectedCount::positive(wish);
        *count = if sound & particle.matters() {
            wished
        } else {
            ExpectedCount::ZERO
        };
    }
    all_sound
}

#[cfg(test)]
mod tests {
    use super::*;

    fn child(parent: u32, weight: f32) -> Child {
        Child { parent, weight }
    }

    #[test]
    fn siblings_share_the_weight() {
        let mut offspring = Offspring {
            children: vec![child(0, 2.0), child(3, 8.0)],
            ..Offspring::default()
        };
        offspring.split_each(1);
        assert_eq!(offspring.children(), [child(0, 2.0), child(3, 8.0)]);
        offspring.split_each(2);
        let expected = [child(0, 1.0), child(0, 1.0), child(3, 4.0), child(3, 4.0)];
        assert_eq!(offspring.children(), expected);
        offspring.split_each(0);
        assert!(offspring.children().is_empty());
    }
}
