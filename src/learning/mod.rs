//! What the paths of a render teach: where light comes from, how much its estimates vary, and what following a path costs.
//!
//! A render learns in *lessons*: while it traces the first passes it records what every path segment brought back ([`Observation`]); after such
//! a pass all of it is put into [`Knowledge`], which then stays as it is until the next lesson. So nothing that decides about a path has seen that
//! path, and every image is unbiased whatever was learned, or mislearned. Observations are put in in a fixed order: the same knowledge
//! for any number of threads.
//!
//! - [`cell_tree`]: space, divided where there are many observations
//! - [`experience`]: all observations, for each cell and each of six classes of normals
//! - [`gathering`]: observations of tiles, in their order
//! - [`lobe`]: where the lobes of glossy surfaces point
//! - [`mixture`]: how many directions are guided where surfaces have lobes of their own
//! - [`moments`]: what paths bring back and cost
//! - [`observation`]: what is observed
//! - [`pixels`]: how bright the image is
//! - [`place_sums`]: the sums of one place, and what they say of it
//! - [`reliance`]: which of it a render goes by
//! - [`square_warp`]: a histogram that warps the unit square from which directions are drawn
//! - [`light_sums`]: which groups of lights send more than is guessed
//! - [`knowledge`]: what is asked while paths are traced

pub mod cell_tree;
pub mod experience;
pub mod gathering;
pub mod knowledge;
pub mod light_sums;
pub mod lobe;
pub mod mixture;
pub mod moments;
pub mod observation;
pub mod pixels;
pub mod place_sums;
pub mod reliance;
pub mod square_warp;

pub use cell_tree::CellTree;
pub use experience::Experience;
pub use gathering::{Gathering, Observations};
use knowledge::Insights;
pub use knowledge::{Insight, Knowledge};
pub use lobe::LobeClass;
pub use mixture::{GuidedShare, MixedDirection, Odds};
pub use moments::Moments;
pub use observation::{LightObservation, Observation, PixelObservation};
pub use pixels::PixelKnowledge;
pub use reliance::Reliance;
pub use square_warp::{Bin, SquareWarp};
