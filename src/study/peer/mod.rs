//! Mitsuba 3 as a competitor: the same scene file, size, threads and time, and a renderer that is not ours.
//!
//! A [`PeerSpec`] says what is to be rendered, a [`MitsubaPeer`] is a Python process that has loaded it, and a
//! [`PeerState`] adds up its chunks of samples, in turns, until a budget is used.
//!
//! # What is charged
//!
//! The seconds of a chunk are wall-clock time around `mitsuba.render` with everything evaluated: seeding, tracing, and
//! putting samples on the film. Not charged, as for the other competitors: starting Python, loading the scene, building the
//! acceleration structure; the compilation of the kernels of `llvm_*` variants, which happens in renders that are
//! thrown away; and handing the image over.
//!
//! # What is changed in the scene
//!
//! The film gets the study's size, without a crop window, and the pixel format `rgb`; the integrator gets `max_depth` if
//! the study states one. Everything else is as the scene says: reconstruction filter, integrator, Russian roulette
//! (`rr_depth`), and sampler. If the sampler cannot take a number of samples (a `stratified` one
//! takes squares), those that it took are counted.

mod llvm;
mod mitsuba;
mod seeds;
mod state;
mod variant;
mod wire;

pub use mitsuba::{MitsubaPeer, PYTHON, PeerChunk, PeerError, PeerSpec};
pub use seeds::SeedSequence;
pub use state::{PeerState, PeerTarget};
pub use variant::{MitsubaVariant, PeerName, PeerNameError};
