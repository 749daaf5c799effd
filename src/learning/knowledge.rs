//! What was learned so far, as it is asked for while paths are traced.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::lobe::LobeMoments;
use super::{CellTree, Experience, GuidedShare, LobeClass, Moments, PixelKnowledge, SquareWarp};
use crate::lanes::{CHUNK, VectorLanes};
use crate::sampling::{FRAME_CLASSES, Frame};
use crate::scene::{GroupWeights, ImageSize};

/// Halvings along each axis with which cells begin.
const FIRST_HALVINGS: u32 = 3;

/// What is known of the light that arrives in a cell at surfaces that face one way.
///
/// What is asked for together lies in one line of the cache.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[repr(C, align(32))]
pub struct Insight {
    /// What paths that go on there bring back, wherever they come from.
    pub moments: Moments,
    /// Whether directions gain by being drawn from where it comes.
    pub guides: bool,
    /// How many of them, at surfaces with broad lobes of their own; it means nothing where they do not gain.
    pub mixed_share: GuidedShare,
    /// From where, on the square that directions are drawn from; uniform where they do not gain.
    pub warp: SquareWarp,
}

impl Insight {
    /// Where nothing was observed.
    pub(super) const NONE: Self = Self {
        moments: Moments::NONE,
        guides: false,
        mixed_share: GuidedShare::UNKNOWN,
        warp: SquareWarp::UNIFORM,
    };
}

/// What is known of all places, by number; number 0 is where nothing was observed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Insights {
    /// The number of each address.
    pub places: Vec<u32>,
    /// What is known of paths that go on there.
    pub of_paths: Vec<Insight>,
    /// The same for each class of lobes, where surfaces have any.
    pub of_lobes: Vec<Option<Box<LobeMoments>>>,
    /// And of the groups of lights: apart, for both are asked for at different times, and these are so small that they stay in the cache.
    pub of_lights: Vec<GroupWeights>,
}

impl Insights {
    /// Nothing was observed at any of so many `addresses`.
    pub fn nothing(addresses: usize) -> Self {
        Self {
            places: vec![0; addresses],
            of_paths: vec![Insight::NONE],
            of_lobes: vec![None],
            of_lights: vec![GroupWeights::EQUAL],
        }
    }
}

/// What was learned; it changes between passes only.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Knowledge {
    tree: CellTree,
    insights: Insights,
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
            insights: Insights::nothing(tree.cells() as usize * FRAME_CLASSES),
            tree,
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

    /// The addresses of the first `count` of some vertices: at `positions`, with the unit shading normals `normals` on the sides that are seen; all in
    /// world space.
    #[inline(always)]
    pub(crate) fn addresses(
        &self,
        positions: &VectorLanes<CHUNK>,
        normals: &VectorLanes<CHUNK>,
        count: usize,
    ) -> [u32; CHUNK] {
        let mut addresses = self.tree.cells_at(positions, count);
        for (lane, address) in addresses.iter_mut().enumerate() {
            let class = Frame::class(normals.get(lane));
            *address = address
                .wrapping_mul(FRAME_CLASSES as u32)
                .wrapping_add(class);
        }
        addresses
    }

    /// Which insight belongs to an address.
    #[inline(always)]
    pub fn insight_number(&self, address: u32) -> u32 {
        self.insights.places[address as usize]
    }

    /// Insight number `number`.
    #[inline(always)]
    pub fn insight(&self, number: u32) -> &Insight {
        &self.insights.of_paths[number as usize]
    }

    /// What paths bring back that go on where insight number `number` is, at a surface with lobes of class `lobe` if it has any.
    #[inline(always)]
    pub fn moments(&self, number: u32, lobe: Option<LobeClass>) -> &Moments {
        let of_lobes = || self.insights.of_lobes[number as usize].as_ref();
        match lobe.and_then(|class| Some(of_lobes()?.of(class))) {
            Some(moments) => moments,
            None => &self.insight(number).moments,
        }
    }

    /// By how much the light of each group differs from what is guessed, where insight number `number` is.
    #[inline(always)]
    pub fn group_weights(&self, number: u32) -> &GroupWeights {
        &self.insights.of_lights[number as usize]
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
        self.insights = self.experience.insights(&self.tree);
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
        let lights = Vec::new();
        gathering.add(
            0,
            Observations {
                segments,
                lights,
                pixels,
            },
        );
        knowledge.give_back(gathering.into_experience());
        knowledge.learn();
    }

    impl Knowledge {
        fn address(&self, position: Vec3, normal: Vec3) -> u32 {
            let mut lanes = [VectorLanes::default(); 2];
            lanes[0].put(0, position);
            lanes[1].put(0, normal);
            self.addresses(&lanes[0], &lanes[1], 1)[0]
        }

        fn insight_at(&self, position: Vec3, normal: Vec3) -> &Insight {
            self.insight(self.insight_number(self.address(position, normal)))
        }
    }

    fn observation(address: u32, value: f32) -> Observation {
        Observation {
            address,
            lobe: None,
            bin: None,
            odds: None,
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
        assert_eq!(*knowledge.insight_at(place, Vec3::X), Insight::NONE);
        teach(&mut knowledge, vec![observation(address, 5.0)]);
        let mean = |place, normal| knowledge.insight_at(place, normal).moments.mean;
        assert_eq!(mean(place, Vec3::X), 5.0);
        assert_eq!(mean(place + 0.02, Vec3::new(0.8, 0.6, 0.0)), 5.0);
        let nothing = |place, normal| *knowledge.insight_at(place, normal) == Insight::NONE;
        assert!(nothing(place, Vec3::NEG_X));
        assert!(nothing(place + 0.5, Vec3::X));
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
            let of = |place| knowledge.insight_at(place, Vec3::Y);
            let means = places.map(|place| of(place).moments.mean);
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
            let insight_at = |knowledge: &Knowledge| knowledge.insight_at(place, Vec3::Y).clone();
            assert_eq!(insight_at(&knowledge), insight_at(&before));
        }
    }
}
