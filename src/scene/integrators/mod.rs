//! Integrators: how deep paths go, and which are shown.

mod direct;
mod moment;
mod path;

use super::error::SceneError;
use super::xml::Object;

/// What a scene file says of the paths.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PathIntegrator {
    /// Most segments of a path, camera ray included; `None` for no limit. 1 shows emitters only, 2 adds direct light.
    pub max_depth: Option<u32>,
    /// From which number of segments on `throughput-roulette` may end a path.
    pub roulette_depth: u32,
    /// Whether area lights and surroundings are invisible to the camera.
    pub hide_emitters: bool,
    /// How often paths branch at every surface.
    pub samples: SurfaceSamples,
    /// What the channels are called in which the scene asks for the moments of its samples; none where it does not.
    pub moments: Option<String>,
}

/// How many samples are taken at every surface that a path reaches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceSamples {
    /// Points of emitters; 0 leaves all light to be found by the directions.
    pub emitters: u32,
    /// Directions of the bsdf, for each that the strategy decides on.
    pub directions: u32,
}

impl Default for SurfaceSamples {
    /// One of each.
    fn default() -> Self {
        Self {
            emitters: 1,
            directions: 1,
        }
    }
}

impl Default for PathIntegrator {
    fn default() -> Self {
        Self {
            max_depth: None,
            roulette_depth: 5,
            hide_emitters: false,
            samples: SurfaceSamples::default(),
            moments: None,
        }
    }
}

/// The integrator of a scene file.
pub(super) fn load(object: &Object) -> Result<PathIntegrator, SceneError> {
    match object.plugin.as_str() {
        "path" => path::load(object),
        "direct" => direct::load(object),
        "moment" => moment::load(object),
        _ => Err(object.unsupported(&["path", "direct", "moment"])),
    }
}

#[cfg(test)]
mod tests;
