//! Sums of what was observed.

use serde::{Deserialize, Serialize};

use super::square_warp::{Bin, SIDE};
use super::{CellTree, Insight, Observations, SquareWarp};
use crate::sampling::FRAME_CLASSES;

/// A cell is halved when more observations than this are in it: some dozens for each bin of the normals that it has.
const MOST_PER_CELL: f64 = 6000.0;

/// The most cells: some 100 MB.
const MOST_CELLS: u32 = 1 << 14;

/// Halvings above a cell, two along each axis, to the node with whose mean that of the cell is filled up.
const TO_FAMILY: u8 = 6;

/// How many observations of its family each bin of a cell is filled up with.
const OF_FAMILY: f32 = 4.0;

/// How many observations of its own mean each bin of a family is filled up with.
const OF_MEAN: f32 = 2.0;

/// What one path segment brought back to the vertex that it had left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// Where the vertex was (see [`Knowledge::address`](super::Knowledge::address)).
    pub address: u32,
    /// The direction of the segment, if it is one of those that are learned.
    pub bin: Option<Bin>,
    /// The radiance that came along it.
    pub radiance: f32,
    /// What it was worth: an estimate of the light that the vertex reflects, with albedo 1.
    pub value: f32,
    /// How many rays were traced for it, all descendants included.
    pub cost: f32,
}

/// What the camera paths of one pixel brought back.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PixelObservation {
    /// Which pixel: row by row.
    pub pixel: u32,
    /// How many paths.
    pub paths: u32,
    /// The sum of their radiance.
    pub radiance: f32,
    /// The sum of the squares of their radiance.
    pub square: f32,
    /// The sum of their rays.
    pub rays: f32,
}

impl PixelObservation {
    fn add(&mut self, other: &Self) {
        if !(other.square >= 0.0 && other.square < f32::INFINITY) {
            return;
        }
        self.paths += other.paths;
        self.radiance += other.radiance;
        self.square += other.square;
        self.rays += other.rays;
    }
}

/// All observations so far.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Experience {
    /// Which sums belong to an address, counted from 1; 0 while nothing was observed there.
    places: Vec<u32>,
    sums: Vec<Sums>,
    /// Of each pixel, row by row.
    pixels: Vec<PixelObservation>,
}

/// The sums of one cell and class of normals.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Sums {
    count: f32,
    value: f32,
    square: f32,
    cost: f32,
    bins: [[BinSums; SIDE]; SIDE],
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct BinSums {
    count: f32,
    radiance: f32,
}

impl BinSums {
    fn add(&mut self, other: Self, share: f32) {
        self.count += share * other.count;
        self.radiance += share * other.radiance;
    }
}

impl Sums {
    fn add(&mut self, other: &Self, share: f32) {
        self.count += share * other.count;
        self.value += share * other.value;
        self.square += share * other.square;
        self.cost += share * other.cost;
        let bins = self.bins.as_flattened_mut().iter_mut();
        for (bin, other) in bins.zip(other.bins.as_flattened()) {
            bin.add(*other, share);
        }
    }

    fn observe(&mut self, observation: &Observation) {
        self.count += 1.0;
        self.value += observation.value;
        self.square += observation.value * observation.value;
        self.cost += observation.cost;
        if let Some(bin) = observation.bin {
            let [row, column] = bin.place();
            self.bins[row][column].count += 1.0;
            self.bins[row][column].radiance += observation.radiance;
        }
    }

    /// These sums, filled up with `count` observations like the `others` that a cell has in common with its family.
    fn insight(&self, family: &Self) -> Insight {
        let mean = ratio(
            family
                .bins
                .as_flattened()
                .iter()
                .map(|bin| bin.radiance)
                .sum(),
            family.count,
        );
        let mut radiance = [[0.0; SIDE]; SIDE];
        let bins = self
            .bins
            .as_flattened()
            .iter()
            .zip(family.bins.as_flattened());
        for (radiance, (bin, family)) in radiance.as_flattened_mut().iter_mut().zip(bins) {
            let of_family = (family.radiance + OF_MEAN * mean) / (family.count + OF_MEAN);
            *radiance = (bin.radiance + OF_FAMILY * of_family) / (bin.count + OF_FAMILY);
        }
        let filled = |own: f32, of_family: f32| {
            let prior = ratio(of_family, family.count);
            (own + OF_FAMILY * prior) / (self.count + OF_FAMILY)
        };
        Insight {
            warp: SquareWarp::new(&radiance),
            mean: filled(self.value, family.value),
            square: filled(self.square, family.square),
            cost: filled(self.cost, family.cost),
        }
    }
}

fn ratio(sum: f32, count: f32) -> f32 {
    if count > 0.0 { sum / count } else { 0.0 }
}

impl Experience {
    /// Adds what was observed in a tile.
    pub(super) fn add(&mut self, observations: &Observations) {
        for observation in &observations.segments {
            self.observe(observation);
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
        let address = observation.address as usize;
        if address >= self.places.len() {
            self.places.resize(address + 1, 0);
        }
        let place = &mut self.places[address];
        if *place == 0 {
            self.sums.push(Sums::default());
            *place = self.sums.len() as u32;
        }
        self.sums[*place as usize - 1].observe(observation);
    }

    /// Divides the cells of `tree` in which there is much to tell apart.
    pub(super) fn refine(&mut self, tree: &mut CellTree) {
        self.places.resize(tree.cells() as usize * FRAME_CLASSES, 0);
        let count = |places: &[u32]| {
            let counts = places.iter().filter(|&&place| place > 0);
            counts
                .map(|&place| f64::from(self.sums[place as usize - 1].count))
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
                let mut half = Sums::default();
                half.add(&sums[place as usize - 1], 0.5);
                sums[place as usize - 1] = half.clone();
                sums.push(half);
                places.push(sums.len() as u32);
            }
        });
    }

    /// What is to be learned from all that: for every address the number of an insight, counted from 1, and the insights.
    pub(super) fn insights(&self, tree: &CellTree) -> (Vec<u32>, Vec<Insight>) {
        let families = tree.families(TO_FAMILY);
        let mut of_families: std::collections::BTreeMap<(u32, usize), Sums> = Default::default();
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
        let mut places = vec![0; self.places.len()];
        let mut insights = Vec::with_capacity(self.sums.len());
        for (address, &place) in observed {
            insights.push(self.sums[place as usize - 1].insight(&of_families[&family(address)]));
            places[address] = insights.len() as u32;
        }
        (places, insights)
    }
}
