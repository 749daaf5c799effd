//! What a render can be told beside the scene.

use std::num::{NonZeroU32, NonZeroU64, NonZeroUsize};
use std::time::Duration;

use crate::embree::BuildQuality;
use crate::film::FilmSums;
use crate::sampling::SamplerKind;
use crate::spectrum::{Rgb, Spectral};
use crate::transport::{DirectLight, TraceBatches, Tracer};
use crate::walk::{Roulette, Strategy};

/// When a render is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Budget {
    /// When every pixel has so many camera paths; in the mean over all pixels, where the render is adaptive.
    SamplesPerPixel(NonZeroU32),
    /// After so much wall-clock time, counted from when the scene is loaded and its acceleration structure is built.
    Time(Duration),
    /// Once so many rays, shadow rays included, are traced; what is under way then is finished.
    Rays(NonZeroU64),
}

/// How colours are carried along paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColourMode {
    /// Wavelengths that are drawn for each path.
    Spectral(WavelengthCount),
    /// Three channels.
    Rgb,
}

/// How many wavelengths a path carries. The image is the same on average: more of them leave less colour noise, for
/// more time per path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum WavelengthCount {
    /// One, as in the spectral renderers of old.
    One,
    /// Four, which fill a vector register.
    #[default]
    Four,
    /// Eight.
    Eight,
}

impl Default for ColourMode {
    /// Four wavelengths.
    fn default() -> Self {
        Self::Spectral(WavelengthCount::default())
    }
}

impl ColourMode {
    /// The name in metadata.
    pub fn name(self) -> &'static str {
        match self {
            Self::Spectral(WavelengthCount::One) => "spectral, 1 wavelength a path",
            Self::Spectral(WavelengthCount::Four) => "spectral, 4 wavelengths a path",
            Self::Spectral(WavelengthCount::Eight) => "spectral, 8 wavelengths a path",
            Self::Rgb => "rgb",
        }
    }

    /// A thread's memory for tracing in this mode.
    pub(super) fn tracer(self) -> Box<dyn TraceBatches> {
        match self {
            Self::Spectral(WavelengthCount::One) => Box::<Tracer<Spectral<1>>>::default(),
            Self::Spectral(WavelengthCount::Four) => Box::<Tracer<Spectral<4>>>::default(),
            Self::Spectral(WavelengthCount::Eight) => Box::<Tracer<Spectral<8>>>::default(),
            Self::Rgb => Box::<Tracer<Rgb>>::default(),
        }
    }
}

/// The settings of a render. Start from [`Settings::default`] and change what matters.
#[derive(Debug)]
pub struct Settings {
    /// Who decides how long paths are followed.
    pub strategy: Box<dyn Strategy>,
    /// When the render is done.
    pub budget: Budget,
    /// Threads that build the acceleration structure and that trace paths.
    pub threads: NonZeroUsize,
    /// Seed of all random streams.
    pub seed: u64,
    /// How colours are carried.
    pub colour: ColourMode,
    /// In which numbers pixels add up their samples.
    pub film_sums: FilmSums,
    /// Where the random numbers of paths come from.
    pub sampler: SamplerKind,
    /// Whether directions are guided by what was learned of where light comes from.
    pub guiding: bool,
    /// Whether pixels in which one path leaves much error get more of them.
    pub adaptive: bool,
    /// Whether what was learned is tried against doing without, and left aside where it does not pay.
    pub trial: bool,
    /// How direct light is found.
    pub direct_light: DirectLight,
    /// Most segments of a path, camera ray included; `None` takes what the scene says.
    pub max_depth: Option<NonZeroU32>,
    /// Watertight intersection, at some cost in ray rate.
    pub robust: bool,
    /// Effort in building the acceleration structure. More of it did not make rays faster where it was measured
    /// (`docs/accuracy.md`).
    pub build_quality: BuildQuality,
}

impl Default for Settings {
    /// Roulette as in the paper, 64 samples per pixel, all cores, seed 0, spectral, next-event estimation.
    fn default() -> Self {
        Self {
            strategy: Box::new(Roulette::default()),
            budget: Budget::SamplesPerPixel(NonZeroU32::MIN.saturating_add(63)),
            threads: std::thread::available_parallelism().unwrap_or(NonZeroUsize::MIN),
            seed: 0,
            colour: ColourMode::default(),
            film_sums: FilmSums::default(),
            sampler: SamplerKind::default(),
            guiding: false,
            adaptive: false,
            trial: false,
            direct_light: DirectLight::default(),
            max_depth: None,
            robust: false,
            build_quality: BuildQuality::Low,
        }
    }
}
