//! A Python process with Mitsuba 3 in it, which has loaded the scene and renders chunks of samples.

use std::ffi::OsString;
use std::num::NonZeroUsize;
use std::path::PathBuf;

use thiserror::Error;

use super::MitsubaVariant;
use super::wire::{Chunk, Reply, Start, Wire};
use crate::scene::ImageSize;

/// The environment variable that names a Python with the package `mitsuba`; without it, `python3` is asked.
pub const PYTHON: &str = "COHORT_MITSUBA_PYTHON";

/// The most camera paths of one chunk. Variants that compile keep all of them in memory at once.
const PATHS_AT_ONCE: usize = 4_000_000;

/// What Mitsuba is to render, and how.
#[derive(Clone, Debug)]
pub struct PeerSpec {
    /// The variant.
    pub variant: MitsubaVariant,
    /// The scene file.
    pub scene: PathBuf,
    /// Values of the scene's `$name`s; those that it does not use are ignored.
    pub definitions: Vec<(String, String)>,
    /// Size of the image, instead of what the scene says.
    pub size: ImageSize,
    /// Rendering threads.
    pub threads: NonZeroUsize,
    /// The most segments of a path, instead of what the scene says; 1 shows lights alone.
    pub max_depth: Option<u32>,
}

/// Mitsuba with the scene loaded and its kernels compiled, in a process that ends when this is dropped.
#[derive(Debug)]
pub struct MitsubaPeer {
    wire: Wire,
    scene: PathBuf,
    size: ImageSize,
    version: String,
    seconds_per_sample: f64,
}

/// Independent samples of every pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct PeerChunk {
    /// Their mean, linear sRGB, row by row from the top.
    pub image: Vec<[f32; 3]>,
    /// Samples per pixel: those asked for, unless the scene's sampler takes certain numbers only.
    pub samples_per_pixel: u32,
    /// Wall-clock seconds.
    pub seconds: f64,
}

/// Why there is no image by Mitsuba.
#[derive(Debug, Error)]
pub enum PeerError {
    /// There is no such program.
    #[error(
        "cannot start {} to run Mitsuba: {source}; {PYTHON} may name a Python that has the package `mitsuba`",
        python.display()
    )]
    NoPython {
        /// What was called.
        python: PathBuf,
        /// Why it did not start.
        source: std::io::Error,
    },
    /// The package, or one that it needs, is missing.
    #[error(
        "{} has no working package `mitsuba` ({message}); install it by `pip install mitsuba numpy`, or name a Python that has it in {PYTHON}",
        python.display()
    )]
    NoPackage {
        /// What was called.
        python: PathBuf,
        /// Python's message.
        message: String,
    },
    /// The package cannot change the size of a scene's film.
    #[error("Mitsuba {version} is too old: version 3.7 or newer is needed")]
    TooOld {
        /// What is there.
        version: String,
    },
    /// There is no such variant.
    #[error("Mitsuba has no variant `{variant}`; this one has {}", offered.join(", "))]
    UnknownVariant {
        /// What was asked for.
        variant: String,
        /// What there is.
        offered: Vec<String>,
    },
    /// There is such a variant, but it does not work here.
    #[error(
        "Mitsuba's variant `{variant}` does not work here: {message}{}",
        hint(variant)
    )]
    UnusableVariant {
        /// What was asked for.
        variant: String,
        /// Mitsuba's message.
        message: String,
    },
    /// Mitsuba refuses the scene.
    #[error("Mitsuba cannot load {}: {message}", scene.display())]
    BadScene {
        /// The scene file.
        scene: PathBuf,
        /// Mitsuba's message.
        message: String,
    },
    /// Mitsuba fails in rendering.
    #[error("Mitsuba cannot render {}: {message}", scene.display())]
    CannotRender {
        /// The scene file.
        scene: PathBuf,
        /// Mitsuba's message.
        message: String,
    },
    /// The process ended although nobody asked it to.
    #[error("Mitsuba's process ended unexpectedly ({status}){log}")]
    Died {
        /// How it ended.
        status: String,
        /// The last lines that it printed, each after a line break.
        log: String,
    },
    /// It answered what was not asked.
    #[error("Mitsuba's process gave an answer that makes no sense: {line}")]
    Garbled {
        /// The answer.
        line: String,
    },
    /// A request cannot be written as JSON, because of a path that is no Unicode.
    #[error("Mitsuba cannot be told what to render: {0}")]
    Request(serde_json::Error),
    /// There is no place for what the process prints.
    #[error("cannot make a temporary file for what Mitsuba prints: {0}")]
    Log(std::io::Error),
    /// Samples of another size were to be added.
    #[error("a study of {} x {} pixels cannot go on with {} x {}", kept.width, kept.height, new.width, new.height)]
    OtherSize {
        /// Size of the image so far.
        kept: ImageSize,
        /// Size that Mitsuba renders.
        new: ImageSize,
    },
}

fn hint(variant: &str) -> &'static str {
    if variant.starts_with("llvm_") {
        "; `apt install libllvm19` has what it needs, and DRJIT_LIBLLVM_PATH may name another LLVM (16 or newer)"
    } else {
        ""
    }
}

impl MitsubaPeer {
    /// Starts Python, checks the package and the variant, loads the scene, and renders some images that do not count,
    /// until everything is compiled.
    pub fn start(spec: PeerSpec) -> Result<Self, PeerError> {
        let python = std::env::var_os(PYTHON).unwrap_or_else(|| OsString::from("python3"));
        let mut wire = Wire::open(&python)?;
        let definitions = spec.definitions.into_iter();
        let reply = wire.ask(&Start {
            variant: spec.variant.name(),
            threads: spec.threads.get(),
            scene: &spec.scene,
            definitions: definitions
                .map(|(name, value)| (name, value.into()))
                .collect(),
            width: spec.size.width,
            height: spec.size.height,
            max_depth: spec.max_depth,
        })?;
        let variant = spec.variant.name().to_owned();
        match reply {
            Reply::Started {
                mitsuba,
                drjit,
                seconds_per_sample,
            } => Ok(Self {
                wire,
                scene: spec.scene,
                size: spec.size,
                version: format!("Mitsuba {mitsuba} {variant} (Dr.Jit {drjit})"),
                seconds_per_sample,
            }),
            Reply::NoPackage { message } => Err(PeerError::NoPackage {
                python: python.into(),
                message,
            }),
            Reply::TooOld { version } => Err(PeerError::TooOld { version }),
            Reply::UnknownVariant { offered } => {
                Err(PeerError::UnknownVariant { variant, offered })
            }
            Reply::UnusableVariant { message } => {
                Err(PeerError::UnusableVariant { variant, message })
            }
            other => Err(refusal(&spec.scene, other)),
        }
    }

    /// Renders this many samples per pixel, at most [`Self::most_samples`]. Images by seeds of one
    /// [`SeedSequence`](super::SeedSequence) are independent.
    pub fn render(&mut self, spp: u32, seed: u32) -> Result<PeerChunk, PeerError> {
        let reply = self.wire.ask(&Chunk { spp, seed })?;
        let Reply::Rendered { spp, seconds } = reply else {
            return Err(refusal(&self.scene, reply));
        };
        Ok(PeerChunk {
            image: self.wire.read_image(self.size.pixels())?,
            samples_per_pixel: spp,
            seconds,
        })
    }

    /// Versions of Mitsuba and Dr.Jit, and the variant.
    pub fn version(&self) -> &str {
        &self.version
    }

    /// Size of the images.
    pub fn size(&self) -> ImageSize {
        self.size
    }

    /// Seconds that one sample of every pixel took before counting began.
    pub fn seconds_per_sample(&self) -> f64 {
        self.seconds_per_sample
    }

    /// The most samples per pixel of one chunk, so that there is memory for it.
    pub fn most_samples(&self) -> u32 {
        (PATHS_AT_ONCE / self.size.pixels()).max(1) as u32
    }

    /// The identity of the process.
    pub fn process(&self) -> u32 {
        self.wire.process()
    }
}

/// A reply that is no answer to what was asked, as an error.
fn refusal(scene: &std::path::Path, reply: Reply) -> PeerError {
    let scene = scene.to_owned();
    match reply {
        Reply::BadScene { message } => PeerError::BadScene { scene, message },
        Reply::CannotRender { message } => PeerError::CannotRender { scene, message },
        other => PeerError::Garbled {
            line: format!("{other:?}"),
        },
    }
}
