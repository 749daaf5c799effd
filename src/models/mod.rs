//! The models of the project's scenes: where they lie, and how a missing one is made or fetched.
//!
//! The knot is generated. The Armadillo and Lucy come from the Stanford 3D Scanning Repository, one
//! way through: `download` to a temporary file and check it, `unpack` it to a PLY, read that,
//! [`simplify`] it where the scene wants fewer triangles, and write the result beside its final
//! name, which it gets last. Whatever fails, no partial file is left.

mod directories;
mod download;
mod error;
mod original;
mod provide;
mod simplify;
mod unpack;

pub use directories::{DEFAULT_DIRECTORY, DIRECTORY_VARIABLE, ModelDirectories};
pub use error::ModelsError;
pub use original::{Original, Packing, STANFORD};
pub use provide::{Origin, Provided, Provider};
pub use simplify::simplify;

#[cfg(test)]
mod test_server;
#[cfg(test)]
mod tests;

/// Stanford's terms for its models, as the user of a download must know them.
pub const STANFORD_TERMS: &str = "\
The model is courtesy of the Stanford Computer Graphics Laboratory (the Stanford 3D Scanning
Repository, http://graphics.stanford.edu/data/3Dscanrep/). You may use it for research, mirror it
freely and publish images of it in scholarly work, with credit to the laboratory; commercial use
needs its permission. Lucy is a religious figure: show her in good taste, undamaged and unmorphed.";

/// A model of one of the project's scenes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// The procedural knot of `scenes/cornell-knot.xml`.
    Knot,
    /// The Stanford Armadillo of `scenes/cornell-armadillo.xml`.
    Armadillo,
    /// The Stanford Lucy of `scenes/cornell-lucy.xml`.
    Lucy,
}

impl Model {
    /// Every model.
    pub const ALL: [Self; 3] = [Self::Knot, Self::Armadillo, Self::Lucy];

    /// The name of its file in a folder of models, as the scenes refer to it.
    pub fn file_name(self) -> &'static str {
        match self {
            Self::Knot => "knot.ply",
            Self::Armadillo => "armadillo.ply",
            Self::Lucy => "lucy.ply",
        }
    }

    /// What Stanford offers of it; nothing of the knot, which is made here.
    pub fn original(self) -> Option<&'static Original<'static>> {
        match self {
            Self::Knot => None,
            Self::Armadillo => Some(&original::ARMADILLO),
            Self::Lucy => Some(&original::LUCY),
        }
    }
}
