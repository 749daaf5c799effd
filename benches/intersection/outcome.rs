//! Everything that was measured.

use cohort::embree::Coherence;

use crate::builds::{BuildReport, Variant};
use crate::duel::Speed;

/// The results of a run, in the order of measuring.
#[derive(Default)]
pub struct Outcome {
    pub rows: Vec<Row>,
    pub builds: Vec<BuildReport>,
}

/// One call with one kind of rays.
pub struct Row {
    pub scene: &'static str,
    pub variant: Variant,
    pub rays: &'static str,
    pub call: &'static str,
    pub coherence: Coherence,
    pub speed: Speed,
}

impl Row {
    /// `coherent` or `incoherent`: what Embree was told.
    pub fn coherence_name(&self) -> &'static str {
        match self.coherence {
            Coherence::Coherent => "coherent",
            Coherence::Incoherent => "incoherent",
        }
    }
}
