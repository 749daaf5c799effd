//! All that was observed, place by place.

use serde::{Deserialize, Serialize};

use super::place_sums::PlaceSums;
use super::{CellTree, Insights, LightObservation, Observation, Observations, PixelObservation};
use crate::sampling::FRAME_CLASSES;

/// A cell is halved when more observations than this are in it: some dozens for each bin of the normals that it has.
const MOST_PER_CELL: f64 = 6000.0;

/// The most cells: some 100 MB, and more where surfaces have lobes.
const MOST_CELLS: u32 = 1 << 14;

/// Halvings above a cell, two along each axis, to the node with whose mean that of the cell is filled up.
const TO_FAMILY: u8 = 6;

/// All observations so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Experience {
    /// Which sums belong to an address, counted from 1; 0 while nothing was observed there.
    places: Vec<u32>,
    sums: Vec<PlaceSums>,
    /// Of each pixel, row by row.
    pixels: Vec<PixelObservation>,
}

impl Experience {
    /// Adds what was observed in a tile.
    pub(super) fn add(&mut self, observations: &Observations) {
        for observation in &observations.segments {
            self.observe(observation);
        }
        for observation in &observations.lights {
            self.observe_light(observation);
        }
        for observation in &observations.pixels {
            let pixel = observation.pixel as usize;
            if pixel >= self.pixels.len() {
                self.pixels.resize(pixel + 1, PixelObservation::default());
            }
            self.pixels[pixel].add(observation);
        }
    }

    /// What was observed of each pixel, row by row.
    pub(super) fn pixels(&self) -> &[PixelObservation] {
        &self.pixels
    }

    /// Adds an observation; one that is not finite is none.
    fn observe(&mut self, observation: &Observation) {
        let is_finite = |value: f32| (0.0..=f32::MAX).contains(&value);
        let square = observation.value * observation.value;
        if !(is_finite(observation.radiance) && is_finite(square)) {
            return;
        }
        self.sums_at(observation.address).observe(observation);
    }

    /// Adds a look at a light; one that is not finite is none.
    fn observe_light(&mut self, observation: &LightObservation) {
        let square = observation.value * observation.value;
        if (0.0..=f32::MAX).contains(&square) {
            self.sums_at(observation.address)
                .lights
                .observe(observation);
        }
    }

    /// The sums of an address.
    fn sums_at(&mut self, address: u32) -> &mut PlaceSums {
        let address = address as usize;
        if address >= self.places.len() {
            self.places.resize(address + 1, 0);
        }
        let place = &mut self.places[address];
        if *place == 0 {
            self.sums.push(PlaceSums::default());
            *place = self.sums.len() as u32;
        }
        &mut self.sums[*place as usize - 1]
    }

    /// Divides the cells of `tree` in which there is much to tell apart.
    pub(super) fn refine(&mut self, tree: &mut CellTree) {
        self.places.resize(tree.cells() as usize * FRAME_CLASSES, 0);
        let count = |places: &[u32]| {
            let counts = places.iter().filter(|&&place| place > 0);
            counts
                .map(|&place| f64::from(self.sums[place as usize - 1].moments.count))
                .sum()
        };
        let mut counts: Vec<f64> = self.places.chunks(FRAME_CLASSES).map(count).collect();
        let Self { places, sums, .. } = self;
        tree.refine(&mut counts, MOST_PER_CELL, MOST_CELLS, |cell, _| {
            // Both halves begin with half of what was in the whole.
            let start = cell as usize * FRAME_CLASSES;
            for place in start..start + FRAME_CLASSES {
                let place = places[place];
                if place == 0 {
                    places.push(0);
                    continue;
                }
                let mut half = PlaceSums::default();
                half.add(&sums[place as usize - 1], 0.5);
                sums[place as usize - 1] = half.clone();
                sums.push(half);
                places.push(sums.len() as u32);
            }
        });
    }

    /// What is to be learned from all that.
    pub(super) fn insights(&self, tree: &CellTree) -> Insights {
        let families = tree.families(TO_FAMILY);
        let mut of_families: std::collections::BTreeMap<(u32, usize), PlaceSums> =
            Default::default();
        let observed = self
            .places
            .iter()
            .enumerate()
            .filter(|(_, place)| **place > 0);
        let family = |address: usize| (families[address / FRAME_CLASSES], address % FRAME_CLASSES);
        for (address, &place) in observed.clone() {
            let sums = of_families.entry(family(address)).or_default();
            sums.add(&self.sums[place as usize - 1], 1.0);
        }
        let mut insights = Insights::nothing(self.places.len());
        for (address, &place) in observed {
            let (own, family) = (
                &self.sums[place as usize - 1],
                &of_families[&family(address)],
            );
            insights.places[address] = insights.of_paths.len() as u32;
            let insight = own.insight(family);
            insights.of_lobes.push(own.of_lobes(&insight.moments));
            insights.of_paths.push(insight);
            insights.of_lights.push(own.lights.weights(&family.lights));
        }
        insights
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::light_sums::LightSums;
    use crate::learning::place_sums::OF_FAMILY;
    use crate::learning::{Bin, GuidedShare, LobeClass, MixedDirection, Moments, Odds};
    use crate::scene::ChosenGroup;
    use glam::Vec3;

    fn tree() -> CellTree {
        CellTree::new([Vec3::ZERO, Vec3::ONE], 3)
    }

    /// Of what faces +z.
    fn address(tree: &CellTree, position: f32) -> u32 {
        tree.cell(Vec3::splat(position)) * FRAME_CLASSES as u32 + 4
    }

    fn observation(address: u32, value: f32) -> Observation {
        Observation {
            address,
            lobe: None,
            bin: Some(Bin::of([0.5, 0.9])),
            odds: None,
            radiance: 2.0 * value,
            value,
            cost: 3.0 * value,
        }
    }

    fn observed(observations: impl IntoIterator<Item = Observation>) -> Experience {
        let mut experience = Experience::default();
        for observation in observations {
            experience.observe(&observation);
        }
        experience
    }

    /// What is no number, or infinite, is not learned from.
    #[test]
    fn looks_at_lights_are_kept_where_they_are_finite() {
        let tree = tree();
        let look = |value| LightObservation {
            address: address(&tree, 0.2),
            group: ChosenGroup {
                number: 2,
                guessed: 0.5,
                chosen: 0.25,
            },
            value,
        };
        let mut experience = Experience::default();
        for value in [f32::NAN, f32::INFINITY, f32::MAX] {
            experience.observe_light(&look(value));
        }
        assert_eq!(experience, Experience::default());
        experience.observe_light(&look(2.0));
        let mut expected = LightSums::default();
        expected.observe(&look(2.0));
        assert_eq!(total(&experience).lights, expected);
    }

    /// All sums of a list added up.
    fn total(experience: &Experience) -> PlaceSums {
        let mut total = PlaceSums::default();
        for sums in &experience.sums {
            total.add(sums, 1.0);
        }
        total
    }

    #[test]
    fn insights_stand_where_something_was_observed() {
        let tree = tree();
        let (here, there) = (address(&tree, 0.1), address(&tree, 0.9));
        let mut experience = observed([observation(there, 5.0), observation(here, 1.0)]);
        experience.refine(&mut tree.clone());
        let Insights {
            places,
            of_paths: insights,
            ..
        } = experience.insights(&tree);
        assert_eq!(places.len(), tree.cells() as usize * FRAME_CLASSES);
        assert_eq!(places.iter().filter(|&&place| place > 0).count(), 2);
        assert_eq!(insights.len(), 3);
        for (address, value) in [(here, 1.0), (there, 5.0)] {
            let insight = &insights[places[address as usize] as usize];
            // Of the only cell of a family, nothing is filled up with something else.
            let expected = Moments {
                mean: value,
                square: value * value,
                cost: 3.0 * value,
            };
            assert_eq!(insight.moments, expected);
        }
    }

    /// Where little was observed, the rest is what was observed around: cells of one eighth of each axis, families of a half.
    #[test]
    fn few_observations_are_filled_up_by_those_of_the_family() {
        let tree = tree();
        let [few, many, apart] = [0.1, 0.3, 0.9].map(|position| address(&tree, position));
        let of_many = (0..96).map(|_| observation(many, 1.0));
        let of_others = [observation(few, 8.0), observation(apart, 1e6)];
        let mut experience = observed(of_many.chain(of_others));
        experience.refine(&mut tree.clone());
        let Insights {
            places,
            of_paths: insights,
            ..
        } = experience.insights(&tree);
        let mean = |address: u32| insights[places[address as usize] as usize].moments.mean;
        let family = (96.0 + 8.0) / 97.0;
        assert!((mean(few) - (8.0 + OF_FAMILY * family) / (1.0 + OF_FAMILY)).abs() < 1e-5);
        assert!((mean(many) - (96.0 + OF_FAMILY * family) / (96.0 + OF_FAMILY)).abs() < 1e-5);
        assert_eq!(mean(apart), 1e6);
    }

    /// What a lobe sees is known apart, also where a cell was halved.
    #[test]
    fn lobes_are_told_apart() {
        let mut tree = tree();
        let address = address(&tree, 0.1);
        let [bright, dark] = [glam::Vec3::X, glam::Vec3::NEG_X].map(LobeClass::of);
        let seen = |lobe, value| Observation {
            lobe: Some(lobe),
            ..observation(address, value)
        };
        let of_both = (0..MOST_PER_CELL as u32).flat_map(|_| [seen(bright, 5.0), seen(dark, 1.0)]);
        let mut experience = observed(of_both);
        experience.refine(&mut tree);
        assert_eq!(tree.cells(), 512 + 1);
        let insights = experience.insights(&tree);
        for half in [1, 2] {
            assert_eq!(insights.of_paths[half].moments.mean, 3.0);
            let lobes = insights.of_lobes[half].as_ref().expect("lobes were seen");
            let mean = |lobe| lobes.of(lobe).mean;
            assert!(mean(bright) > 4.99 && mean(dark) < 1.01);
        }
    }

    #[test]
    fn light_is_expected_from_where_it_came() {
        let tree = tree();
        let address = address(&tree, 0.1);
        let from = |u, v, radiance| Observation {
            bin: Some(Bin::of([u, v])),
            radiance,
            ..observation(address, 1.0)
        };
        let everywhere = (0..4096).map(|i| {
            let [u, v] = [i % 8, i / 8 % 8].map(|k| (k as f32 + 0.5) / 8.0);
            from(u, v, if i % 64 == 19 { 64.0 } else { 0.0 })
        });
        let mut experience = observed(everywhere);
        experience.refine(&mut tree.clone());
        let insights = experience.insights(&tree).of_paths;
        // u is in bin 19 % 8, v in 19 / 8.
        let bright = insights[1].warp.density(Bin::of([3.5 / 8.0, 2.5 / 8.0]));
        let dark = insights[1].warp.density(Bin::of([2.5 / 8.0, 3.5 / 8.0]));
        assert!(bright > 30.0 && dark < 0.5, "{bright} {dark}");
        assert!(insights[1].guides);
    }

    /// Directions that lobes alone would rarely have drawn bring back the light.
    #[test]
    fn surfaces_with_lobes_are_guided_as_much_as_varies_least() {
        let share_by = |guided: f32| {
            let mut tree = tree();
            let direction = MixedDirection {
                pdf: 1.0,
                guided,
                share: 0.5,
                reach: 1.0,
            };
            let observation = Observation {
                odds: Some(Odds::of(&direction)),
                ..observation(address(&tree, 0.1), 1.0)
            };
            let mut experience = observed([observation; 100]);
            experience.refine(&mut tree);
            experience.insights(&tree).of_paths[1].mixed_share.value()
        };
        assert_eq!(share_by(1.9), 0.75);
        assert_eq!(share_by(0.1), 0.0);
        let mut experience = observed([observation(address(&tree(), 0.1), 1.0)]);
        experience.refine(&mut tree());
        let insights = experience.insights(&tree()).of_paths;
        assert_eq!(insights[1].mixed_share, GuidedShare::UNKNOWN);
    }

    /// What is the same from everywhere, or noise from everywhere.
    #[test]
    fn light_from_everywhere_does_not_guide() {
        for rare in [1, 3, 101] {
            let mut tree = tree();
            let address = address(&tree, 0.1);
            let from_everywhere = (0..64_000).map(|i| {
                let bin = Bin::of([i % 8, i / 8 % 8].map(|k| (k as f32 + 0.5) / 8.0));
                let radiance = if i % rare == 0 { 10.0 } else { 0.0 };
                Observation {
                    bin: Some(bin),
                    radiance,
                    ..observation(address, 1.0)
                }
            });
            let mut experience = observed(from_everywhere);
            experience.refine(&mut tree);
            let insights = experience.insights(&tree).of_paths;
            assert!(insights.iter().all(|insight| !insight.guides), "{rare}");
        }
    }

    #[test]
    fn halving_keeps_the_sums() {
        let mut tree = tree();
        let (full, other) = (address(&tree, 0.1), address(&tree, 0.9));
        let count = 4 * MOST_PER_CELL as u32;
        let of_full = (0..count).map(|_| observation(full, 0.5));
        let mut experience = observed(of_full.chain([observation(other, 3.0)]));
        let before = total(&experience);
        experience.refine(&mut tree);
        // Twice: the cell's four parts have as much as a cell may have.
        assert_eq!(tree.cells(), 512 + 3);
        assert_eq!(
            experience.places.len(),
            tree.cells() as usize * FRAME_CLASSES
        );
        assert_eq!(total(&experience), before);
        let count_at = |position| {
            let place = experience.places[address(&tree, position) as usize];
            experience.sums[place as usize - 1].moments.count
        };
        assert_eq!(f64::from(count_at(0.1)), MOST_PER_CELL);
        assert_eq!(f64::from(count_at(0.01)), MOST_PER_CELL);
        assert_eq!(count_at(0.9), 1.0);
        let Insights {
            places,
            of_paths: insights,
            ..
        } = experience.insights(&tree);
        assert_eq!(places.iter().filter(|&&place| place > 0).count(), 5);
        assert!(
            insights[1..2]
                .iter()
                .all(|insight| insight.moments.mean == 0.5)
        );
    }

    #[test]
    fn what_is_not_finite_is_not_observed() {
        let nothing = Experience::default();
        for value in [f32::NAN, f32::INFINITY, -1.0, 1e30] {
            assert_eq!(observed([observation(7, value)]), nothing, "{value}");
        }
    }
}
