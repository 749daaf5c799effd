//! Which of many lights next-event estimation looks at: each by what it can contribute.
//!
//! Lights that have a place stand in a [tree](tree::LightTree); of those that are infinitely far away it is guessed that each sends as much as the whole tree.
//! What is guessed of [groups] of lights is multiplied by what renders learn of them. Wherever light can arrive, it has a positive probability.

mod bounds;
mod branch;
mod cone;
mod emitters;
mod groups;
mod importance;
mod tree;

pub use bounds::LightBounds;
pub use cone::Cone;
pub use groups::{ChosenGroup, GROUPS, GroupWeights};

use glam::Vec3;

use super::Shape;
use super::emitters::Emitter;
use crate::lanes::CHUNK;
use branch::PlacedLight;
use emitters::Place;
use groups::LightGroups;

/// A way to choose one of a scene's emitters.
#[derive(Clone, Debug)]
pub struct LightChoice(Kind);

#[derive(Clone, Debug)]
enum Kind {
    /// There is no light.
    None,
    /// There is no choice.
    Only(usize),
    Several(LightGroups),
}

/// A surface to which light is to be found.
#[derive(Clone, Copy, Debug, Default)]
pub struct Receiver {
    /// Position in world space.
    pub position: Vec3,
    /// Unit shading normal in world space, on the side from which it is looked at.
    pub normal: Vec3,
    /// Whether light that arrives on the other side can be scattered to this one.
    pub scatters_below: bool,
}

/// For which surface an emitter is to be chosen, and from what.
#[derive(Clone, Copy, Debug, Default)]
pub struct LightQuestion<'a> {
    /// The surface.
    pub receiver: Receiver,
    /// By what the guess of each group is to be multiplied, if anything is known of that.
    pub weights: Option<&'a GroupWeights>,
    /// A uniform number in [0, 1).
    pub u: f32,
}

/// An emitter chosen for a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChosenLight {
    /// Its number among the scene's emitters.
    pub emitter: usize,
    /// The probability of this choice, positive.
    pub probability: f32,
    /// What is left of the uniform number, itself uniform in [0, 1).
    pub remainder: f32,
    /// The group to which it belongs; `None` where there was no choice, or no weights.
    pub group: Option<ChosenGroup>,
}

impl LightChoice {
    /// The choice among `emitters`; `shapes` are the scene's. Those that send nothing are never chosen.
    pub fn new(emitters: &[Emitter], shapes: &[Shape]) -> Self {
        let mut distant = Vec::new();
        let mut placed: Vec<PlacedLight> = Vec::new();
        for (index, emitter) in emitters.iter().enumerate() {
            match Place::of(emitter, shapes) {
                Some(Place::Distant) => distant.push(index as u32),
                Some(Place::Near(bounds)) => placed.push(PlacedLight {
                    emitter: index as u32,
                    bounds,
                }),
                None => {}
            }
        }
        Self(match (&distant[..], &placed[..]) {
            ([], []) => Kind::None,
            (&[only], []) => Kind::Only(only as usize),
            ([], [only]) => Kind::Only(only.emitter as usize),
            _ => {
                let greatest = placed
                    .iter()
                    .map(|light| light.bounds.power)
                    .fold(0.0, f32::max);
                for light in &mut placed {
                    // Powers are guessed by luminance, and a lamp without any may still light what another eye sees.
                    let power = (light.bounds.power / greatest).max(LEAST_POWER);
                    light.bounds.power = if power.is_nan() { 1.0 } else { power };
                }
                Kind::Several(LightGroups::new(distant, placed))
            }
        })
    }

    /// The emitter that is always chosen, if there is only one.
    #[inline]
    pub fn only(&self) -> Option<usize> {
        match self.0 {
            Kind::Only(emitter) => Some(emitter),
            Kind::None | Kind::Several(_) => None,
        }
    }

    /// Whether the choice depends on the surface: otherwise there is at most one light.
    #[inline]
    pub fn depends_on_surface(&self) -> bool {
        matches!(self.0, Kind::Several(_))
    }

    /// Chooses an emitter for each of many surfaces; `None` where no light can arrive. `chosen` is to be as long as `questions`.
    #[inline(always)]
    pub fn choose(&self, questions: &[LightQuestion<'_>], chosen: &mut [Option<ChosenLight>]) {
        match &self.0 {
            Kind::None => chosen.fill(None),
            &Kind::Only(emitter) => {
                for (question, chosen) in questions.iter().zip(chosen) {
                    *chosen = Some(ChosenLight {
                        emitter,
                        probability: 1.0,
                        remainder: question.u,
                        group: None,
                    });
                }
            }
            Kind::Several(groups) => {
                let chunks = questions.chunks(CHUNK).zip(chosen.chunks_mut(CHUNK));
                for (questions, chosen) in chunks {
                    groups.choose(questions, chosen);
                }
            }
        }
    }

    /// The probability with which [`Self::choose`] chooses `emitter` for the same surface and weights.
    #[inline(always)]
    pub fn probability(
        &self,
        receiver: &Receiver,
        weights: Option<&GroupWeights>,
        emitter: usize,
    ) -> f32 {
        match &self.0 {
            Kind::None => 0.0,
            &Kind::Only(only) => f32::from(u8::from(emitter == only)),
            Kind::Several(groups) => groups.probability(receiver, weights, emitter),
        }
    }
}

/// The greatest number below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

/// The least power of a light, as a share of the greatest.
const LEAST_POWER: f32 = 1e-6;

#[cfg(test)]
mod tests;
