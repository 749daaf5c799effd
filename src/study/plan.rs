//! What a study is to do.

use std::num::{NonZeroU32, NonZeroUsize};
use std::path::PathBuf;

use sha2::{Digest, Sha256};

use super::peer::MitsubaVariant;
use super::results::{Crop, StudyKind};
use super::{EntrySettings, StudyError};
use crate::render::{Budget, ColourMode, fingerprint};
use crate::walk::StrategyKind;

/// What a study is to do.
#[derive(Clone, Debug)]
pub struct Plan {
    /// What is varied.
    pub kind: StudyKind,
    /// Who takes part; the first is the baseline.
    pub competitors: Vec<Planned>,
    /// What each may use in each repetition.
    pub budget: Budget,
    /// Independent repetitions.
    pub repetitions: NonZeroU32,
    /// Most snapshots of a repetition.
    pub snapshots: u32,
    /// Seed from which all others are derived.
    pub seed: u64,
    /// How colours are carried, unless a competitor says otherwise.
    pub colour: ColourMode,
    /// Rendering threads of each competitor.
    pub threads: NonZeroUsize,
    /// What errors are measured against.
    pub reference: ReferencePlan,
    /// Whether to measure FLIP.
    pub flip: bool,
    /// The relative MSE to which times are given; `None` takes what the baseline reaches.
    pub target: Option<f64>,
    /// Parts to be shown enlarged; where there are none, the study looks for telling ones.
    pub crops: Vec<Crop>,
    /// The scene as the user named it, and its text: two studies are the same only if these are.
    pub scene: SceneSource,
    /// The command that the user gave.
    pub command: String,
}

/// Where the scene came from.
#[derive(Clone, Debug)]
pub struct SceneSource {
    /// Name, for people.
    pub name: String,
    /// The file, unless it is the built-in scene.
    pub file: Option<PathBuf>,
    /// The values of its `$name`s.
    pub definitions: Vec<(String, String)>,
}

/// One who takes part.
#[derive(Clone, Debug)]
pub struct Planned {
    /// Name, unique in the study.
    pub name: String,
    /// How it renders.
    pub how: How,
    /// What is varied, in a study of settings: none for the baseline.
    pub variation: Option<Variation>,
}

/// How one who takes part renders.
#[derive(Clone, Debug)]
pub enum How {
    /// By this program.
    Ours(EntrySettings),
    /// By Mitsuba 3, with the scene's own integrator.
    Mitsuba(MitsubaVariant),
}

/// A setting and its value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variation {
    /// The setting, such as `wavelengths`.
    pub axis: &'static str,
    /// Its value.
    pub value: String,
    /// Whether that is the program's default.
    pub is_default: bool,
}

/// What errors are measured against.
#[derive(Clone, Debug)]
pub enum ReferencePlan {
    /// An EXR.
    File(PathBuf),
    /// A render by a strategy and with random numbers that no competitor has.
    Render {
        /// When it is done.
        budget: Budget,
        /// Its threads.
        threads: NonZeroUsize,
        /// Its settings but for the strategy.
        settings: EntrySettings,
    },
}

/// Strategies that may render a reference, the best first.
const REFERENCE_STRATEGIES: [StrategyKind; 5] = [
    StrategyKind::ThroughputRoulette,
    StrategyKind::Roulette,
    StrategyKind::ParticleFilter,
    StrategyKind::GoWithTheWinners,
    StrategyKind::PaperParticleFilter,
];

impl Plan {
    /// Checks what can be checked before any time is spent.
    ///
    /// # Errors
    /// Nobody takes part, two have one name, or no strategy is left for the reference.
    pub fn check(&self) -> Result<(), StudyError> {
        if self.competitors.is_empty() {
            return Err(StudyError::Nobody);
        }
        for (index, competitor) in self.competitors.iter().enumerate() {
            let same = |other: &Planned| other.name == competitor.name;
            if self.competitors[..index].iter().any(same) {
                return Err(StudyError::Twice(competitor.name.clone()));
            }
        }
        let counts_rays = matches!(self.budget, Budget::Rays(_));
        for competitor in &self.competitors {
            if counts_rays && matches!(competitor.how, How::Mitsuba(_)) {
                return Err(StudyError::UncountedRays(competitor.name.clone()));
            }
        }
        match self.reference {
            ReferencePlan::File(_) => Ok(()),
            ReferencePlan::Render { .. } => self.reference_strategy().map(|_| ()),
        }
    }

    /// The best strategy that no competitor uses.
    ///
    /// # Errors
    /// All are used.
    pub fn reference_strategy(&self) -> Result<StrategyKind, StudyError> {
        let uses = |strategy: StrategyKind| {
            self.competitors.iter().any(
                |competitor| matches!(&competitor.how, How::Ours(entry) if entry.strategy == strategy),
            )
        };
        let mut free = REFERENCE_STRATEGIES
            .into_iter()
            .filter(|&strategy| !uses(strategy));
        free.next().ok_or(StudyError::NoReferenceStrategy)
    }

    /// The seed of a competitor, counted from 0. No two have the same, nor has the reference.
    pub fn seed_of(&self, competitor: usize) -> u64 {
        mixed(self.seed, competitor as u64 + 1)
    }

    /// The seed of the reference.
    pub fn reference_seed(&self) -> u64 {
        mixed(self.seed, 0)
    }

    /// What tells this study from any other: everything that its numbers depend on.
    pub fn fingerprint(&self, scene_text: &[u8]) -> String {
        let Self {
            kind,
            competitors,
            budget,
            repetitions,
            snapshots,
            seed,
            colour,
            threads,
            reference,
            flip,
            target: _,
            crops: _,
            scene,
            command: _,
        } = self;
        let what = format!(
            "{kind:?} {competitors:?} {budget:?} {repetitions} {snapshots} {seed} {colour:?} {threads} {reference:?} {flip} {scene:?}"
        );
        fingerprint(&what, scene_text)
    }
}

/// A seed for a part of a study.
pub(super) fn mixed(seed: u64, part: u64) -> u64 {
    let mut hash = Sha256::new();
    hash.update(seed.to_le_bytes());
    hash.update(part.to_le_bytes());
    let digest = hash.finalize();
    digest[..8]
        .iter()
        .fold(0, |sum, &byte| (sum << 8) | u64::from(byte))
}
