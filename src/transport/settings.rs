//! What the engine can be told.

use serde::Serialize;

use crate::sampling::SamplerKind;
use crate::scene::SurfaceSamples;

/// Whether direct light is also sought by sampling the emitters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum DirectLight {
    /// Next-event estimation at every vertex, combined with hits of emitters by multiple importance sampling.
    #[default]
    NextEvent,
    /// The pure form: light counts when a path hits an emitter.
    Off,
}

/// How light is transported.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TransportSettings {
    /// Most segments of a path, camera ray included; `None` for no limit.
    pub max_depth: Option<u32>,
    /// How direct light is found.
    pub direct_light: DirectLight,
    /// How many samples are taken at every vertex.
    pub samples: SurfaceSamples,
    /// Where the random numbers of paths come from.
    pub sampler: SamplerKind,
    /// Whether directions are guided by what was learned.
    pub guiding: bool,
    /// Whether emitters are invisible to the camera.
    pub hide_emitters: bool,
}
