//! What was learned so far, as it is asked for while paths are traced.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::{CellTree, Experience, PixelKnowledge, SquareWarp};
use crate::sampling::{FRAME_CLASSES, Frame};
use crate::scene::ImageSize;

/// Halvings along each axis with which cells begin.
const FIRST_HALVINGS: u32 = 3;

/// What is known of the light that arrives in a cell at surfaces that face one way.
///
/// What is asked for together lies in one line of the cache.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[repr(C, align(32))]
pub struct Insight {
    /// The mean of what a path that goes on there brings back, for albedo 1.
    pub mean: f32,
    /// The mean of its square.
    pub square: f32,
    /// How many rays such a path takes.
    pub cost: f32,
    /// Whether directions gain by being drawn from where it comes.
    pub guides: bool,
    /// From where, on the square that directions are drawn from.
    pub warp: SquareWarp,
}

/// What was learned; it changes between passes only.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Knowledge {
    tree: CellTree,
    /// The insight of each address, counted from 1; 0 where there is none.
    places: Vec<u32>,
    insights: Vec<Insight>,
    /// How often it has changed.
    lessons: u32,
    pixels: PixelKnowledge,
    film: ImageSize,
    experience: Experience,
}

impl Knowledge {
    /// Nothing is known of a scene whose surfaces lie in the box `bounds` (world space).
    pub fn nothing(bounds: [Vec3; 2], film: ImageSize) -> Self {
        let tree = CellTree::new(bounds, FIRST_HALVINGS);
        Self {
            places: vec![0; tree.cells() as usize * FRAME_CLASSES],
            tree,
            insights: Vec::new(),
            lessons: 0,
            pixels: PixelKnowledge::default(),
            film,
            experience: Experience::default(),
        }
    }

    /// How many lessons there have been. Random numbers must depend on it: those of a lesson have decided what was learned.
    pub fn lessons(&self) -> u32 {
        self.lessons
    }

    /// The address of vertices at `position` whose shading normal is `normal`, unit, on the side that is seen; both in world space.
    #[inline]
    pub fn address(&self, position: Vec3, normal: Vec3) -> u32 {
        self.tree.cell(position) * FRAME_CLASSES as u32 + Frame::class(normal)
    }

    /// What is known at an address.
    #[inline(always)]
    pub fn insight(&self, address: u32) -> Option<&Insight> {
        match self.places[address as usize] {
            0 => None,
            place => Some(&self.insights[place as usize - 1]),
        }
    }

    /// What was observed so far, to be added to while this is asked; it is to be [given back](Self::give_back).
    pub fn take_experience(&mut self) -> Experience {
        std::mem::take(&mut self.experience)
    }

    /// Takes back what [`Self::take_experience`] gave.
    pub fn give_back(&mut self, experience: Experience) {
        self.experience = experience;
    }

    /// Learns from all observations so far.
    pub fn learn(&mut self) {
        self.experience.refine(&mut self.tree);
        (self.places, self.insights) = self.experience.insights(&self.tree);
        self.pixels = PixelKnowledge::new(self.experience.pixels(), self.film);
        self.lessons += 1;
    }

    /// No more lessons: forgets the observations.
    pub fn conclude(&mut self) {
        self.experience = Experience::default();
    }

    /// What is known of the pixels; nothing before the first lesson.
    pub fn pixels(&self) -> &PixelKnowledge {
        &self.pixels
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learning::{Gathering, Observation, Observations};

    const FILM: ImageSize = ImageSize {
        width: 1,
        height: 1,
    };

    fn teach(knowledge: &mut Knowledge, segments: Vec<Observation>) {
        let mut gathering = Gathering::new(knowledge.take_experience(), 0);
        let pixels = Vec::new();
        gathering.add(0, Observations { segments, pixels });
        knowledge.give_back(gathering.into_experience());
        knowledge.learn();
    }

    fn observation(address: u32, value: f32) -> Observation {
        Observation {
            address,
            bin: None,
            radiance: value,
            value,
            cost: 1.0,
        }
    }

    #[test]
    fn what_was_observed_at_a_surface_is_known_there_alone() {
        let mut knowledge = Knowledge::nothing([Vec3::ZERO, Vec3::ONE], FILM);
        let place = Vec3::new(0.1, 0.2, 0.3);
        let address = knowledge.address(place, Vec3::X);
        assert!(knowledge.insight(address).is_none());
        teach(&mut knowledge, vec![observation(address, 5.0)]);
        let mean = |place, normal| {
            let insight = knowledge.insight(knowledge.address(place, normal));
            insight.map(|insight| insight.mean)
        };
        assert_eq!(mean(place, Vec3::X), Some(5.0));
        assert_eq!(mean(place + 0.02, Vec3::new(0.8, 0.6, 0.0)), Some(5.0));
        assert_eq!(mean(place, Vec3::NEG_X), None);
        assert_eq!(mean(place + 0.5, Vec3::X), None);
        assert_eq!(knowledge.lessons(), 1);
    }

    /// Addresses change when cells are halved; what was known of a place stays known.
    #[test]
    fn halves_know_what_the_whole_knew() {
        let mut knowledge = Knowledge::nothing([Vec3::ZERO, Vec3::ONE], FILM);
        let places = [0.06, 0.3, 0.9].map(Vec3::splat);
        for lesson in 1..4 {
            let [many, some, few] = places.map(|place| knowledge.address(place, Vec3::Y));
            let of_many = vec![observation(many, 10.0); 40_000];
            let of_some = vec![observation(some, 20.0); 200];
            let of_few = vec![observation(few, 30.0); 2];
            teach(&mut knowledge, [of_many, of_some, of_few].concat());
            let of = |place| {
                knowledge
                    .insight(knowledge.address(place, Vec3::Y))
                    .unwrap()
            };
            let means = places.map(|place| of(place).mean);
            assert!(means[0] < 10.1 && means[0] > 9.9, "{lesson}: {means:?}");
            // At first it is of the family of the many.
            assert!(means[1] > 19.0 && means[1] < 20.1, "{lesson}: {means:?}");
            assert!((means[2] - 30.0).abs() < 1e-3, "{lesson}: {means:?}");
        }
        assert!(knowledge.tree.cells() > 512);
        let before = knowledge.clone();
        knowledge.conclude();
        assert_ne!(knowledge, before);
        for place in places {
            let address = knowledge.address(place, Vec3::Y);
            assert_eq!(knowledge.insight(address), before.insight(address));
        }
    }
}
