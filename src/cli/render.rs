//! `cohort render`

use std::error::Error;
use std::num::{NonZeroU32, NonZeroU64, NonZeroUsize};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use clap::{Args, ValueEnum};
use cohort::embree::BuildQuality;
use cohort::film::{ExrMoments, ExrOptions, Film, FilmSums, Image, write_exr, write_png};
use cohort::render::{
    Budget, Checkpoint, ColourMode, Ended, KeptOutcome, Render, Settings, WavelengthCount, metadata,
};
use cohort::sampling::SamplerKind;
use cohort::scene::{PathIntegrator, Scene};
use cohort::transport::DirectLight;

use super::interrupt::stop_on_interrupt;
use super::output::OutputFiles;
use super::parse::{Switch, parse_count, parse_rays, parse_seed, parse_threads, parse_time};
use super::report::{Bar, summarise, tell, warn_of_darkness};
use super::scene_args::SceneArgs;
use super::strategy_args::StrategyArgs;

/// Render a scene into an EXR, with a PNG beside it
#[derive(Args)]
pub struct RenderArgs {
    #[command(flatten)]
    scene: SceneArgs,

    /// The EXR to write [default: the scene's name in the current folder]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    /// Camera paths per pixel [default: what the scene says]
    #[arg(long, value_name = "N", conflicts_with_all = ["time", "rays"], value_parser = parse_count)]
    spp: Option<NonZeroU32>,

    /// Wall-clock time to render, without loading, such as 90s, 30m or 1h30m
    #[arg(long, value_name = "DURATION", conflicts_with = "rays", value_parser = parse_time)]
    time: Option<Duration>,

    /// Rays to trace, shadow rays included
    #[arg(long, value_name = "N", value_parser = parse_rays)]
    rays: Option<NonZeroU64>,

    /// A file that keeps how far the render is, every minute and at its end, and from which it goes on if it is there; budgets count from the very
    /// beginning, and a larger one goes on with a render that is done. Models, textures and included files must be the same as before
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,

    /// Threads that load and render [default: all cores]
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    threads: Option<NonZeroUsize>,

    /// Seed of all random numbers [default: what the scene says]
    #[arg(long, value_name = "N", value_parser = parse_seed)]
    seed: Option<u64>,

    /// Wavelengths that each path carries
    #[arg(long, value_name = "N", value_enum, default_value_t = Wavelengths::Four, conflicts_with = "rgb")]
    wavelengths: Wavelengths,

    /// Render in three channels instead of wavelengths
    #[arg(long)]
    rgb: bool,

    /// Precision in which pixels add up their samples
    #[arg(long, value_name = "PRECISION", value_enum, default_value_t = Sums::Double)]
    sums: Sums,

    /// Where the random numbers of paths come from: independent, sobol or array-qmc [default: independent, or array-qmc where
    /// no strategy is named]
    #[arg(long, value_name = "NAME")]
    sampler: Option<SamplerKind>,

    /// Whether directions are guided, and lights chosen, by where light was found to come from [default: off, or on where no strategy is named]
    #[arg(long, value_name = "SWITCH", value_enum)]
    guiding: Option<Switch>,

    /// Whether pixels in which one path leaves much error get more of them: a number of samples is then that of all in the mean
    #[arg(long, value_name = "SWITCH", value_enum, default_value_t = Switch::Off)]
    adaptive: Switch,

    /// Whether what was learned is tried against doing without, and left aside where it does not pay
    #[arg(long, value_name = "SWITCH", value_enum, default_value_t = Switch::Off)]
    trial: Switch,

    /// How direct light is found
    #[arg(long, value_name = "HOW", value_enum, default_value_t = Direct::NextEvent)]
    direct: Direct,

    /// Most segments of a path, camera ray included [default: what the scene says]
    #[arg(long, value_name = "N", value_parser = parse_count)]
    max_depth: Option<NonZeroU32>,

    /// Also write the variance of every pixel's mean, as channels variance.R, variance.G and variance.B (by sequences, an upper estimate)
    #[arg(long)]
    variance: bool,

    /// Watertight intersection, somewhat slower
    #[arg(long)]
    robust: bool,

    /// Effort in building the acceleration structure
    #[arg(long, value_name = "EFFORT", value_enum, default_value_t = Quality::Low)]
    build_quality: Quality,

    // Last, because its heading holds for all that follows.
    #[command(flatten)]
    strategy: StrategyArgs,
}

#[derive(Clone, Copy, ValueEnum)]
enum Wavelengths {
    #[value(name = "1")]
    One,
    #[value(name = "4")]
    Four,
    #[value(name = "8")]
    Eight,
}

#[derive(Clone, Copy, ValueEnum)]
enum Sums {
    /// 32 bits
    Single,
    /// 64 bits
    Double,
    /// 32 bits, and 32 more for what those lose
    Compensated,
}

#[derive(Clone, Copy, ValueEnum)]
enum Direct {
    /// Sample the emitters at every vertex, combined by multiple importance sampling
    NextEvent,
    /// Count light when a path hits an emitter
    Off,
}

#[derive(Clone, Copy, ValueEnum)]
enum Quality {
    Low,
    Medium,
    High,
}

/// Runs the subcommand.
pub fn run(arguments: RenderArgs) -> Result<ExitCode, Box<dyn Error>> {
    let files = OutputFiles::check(&arguments.output_path())?;
    if let Some(path) = &arguments.checkpoint {
        files.check_other(path)?;
    }
    // A wrong setting is told before a scene is loaded, which can take long.
    let default_depth = PathIntegrator::default().roulette_depth;
    arguments.strategy.build(default_depth)?;
    let scene = arguments.scene.load(arguments.threads())?;
    warn_of_darkness(&scene);
    let settings = arguments.settings(&scene)?;
    let render = Render::new(Arc::new(scene), settings)?;
    let checkpoint = match &arguments.checkpoint {
        Some(path) => Some(Checkpoint::open(path, &render, &arguments.scene.text()?)?),
        None => None,
    };
    if let (Some(path), Some((_, state))) = (&arguments.checkpoint, &checkpoint)
        && state.statistics().camera_paths > 0
    {
        let (path, seconds) = (path.display(), state.duration().as_secs_f64());
        tell(format!(
            "going on from {path}, after {seconds:.1} s of rendering"
        ));
    }
    let stop =
        stop_on_interrupt("stopping; what there is will be written (Ctrl-C again to lose it)")?;
    let bar = Bar::new();
    let (outcome, kept) = match checkpoint {
        Some((checkpoint, state)) => {
            let KeptOutcome { outcome, kept } = checkpoint.run(&render, state, &stop, &bar);
            (outcome, kept)
        }
        None => (render.run(&stop, &bar), Ok(())),
    };
    bar.clear();
    if let Err(error) = kept {
        tell(format!("warning: {error}"));
    }

    let film = &render.engine().scene().film;
    let image = outcome.film.image();
    let options = ExrOptions {
        format: film.pixel_format,
        half_precision: film.half_precision,
        samples: outcome.film.unequal_samples(),
        variance: arguments
            .variance
            .then(|| variance(&outcome.film))
            .flatten(),
        moments: moments(&render, &outcome.film),
        attributes: metadata(&render, &outcome),
    };
    write_exr(&files.exr, &image, &options)?;
    write_png(&files.png, &image)?;
    summarise(&render, &outcome, &files);
    Ok(match outcome.ended {
        Ended::Complete | Ended::OutOfTime | Ended::OutOfRays => ExitCode::SUCCESS,
        Ended::Interrupted => ExitCode::from(130),
    })
}

/// The variance of every pixel, where the samples tell.
fn variance(film: &Film) -> Option<Image> {
    let variance = film.variance();
    if variance.is_none() {
        tell(
            "warning: no variance is written, for a pixel has only one sample or population, which does not tell how much they differ",
        );
    }
    variance
}

/// The moments of the samples, where the scene asks for them.
fn moments(render: &Render, film: &Film) -> Option<ExrMoments> {
    let name = render.engine().scene().integrator.moments.clone()?;
    let second = film.second_moments()?;
    Some(ExrMoments { name, second })
}

impl RenderArgs {
    fn output_path(&self) -> PathBuf {
        let by_default = || PathBuf::from(format!("{}.exr", self.scene.stem()));
        self.output.clone().unwrap_or_else(by_default)
    }

    fn threads(&self) -> NonZeroUsize {
        self.threads.unwrap_or(Settings::default().threads)
    }

    fn settings(&self, scene: &Scene) -> Result<Settings, Box<dyn Error>> {
        // A strategy that is named comes alone, as in comparisons; otherwise it is what does best together.
        let (sampler, guiding) = if self.strategy.is_named() {
            (SamplerKind::Independent, Switch::Off)
        } else {
            (SamplerKind::ArrayQmc, Switch::On)
        };
        let of_scene = NonZeroU32::new(scene.sampler.sample_count).unwrap_or(NonZeroU32::MIN);
        Ok(Settings {
            strategy: self.strategy.build(scene.integrator.roulette_depth)?,
            budget: match (self.time, self.rays) {
                (Some(time), _) => Budget::Time(time),
                (None, Some(rays)) => Budget::Rays(rays),
                (None, None) => Budget::SamplesPerPixel(self.spp.unwrap_or(of_scene)),
            },
            threads: self.threads(),
            seed: self.seed.unwrap_or(scene.sampler.seed),
            colour: if self.rgb {
                ColourMode::Rgb
            } else {
                ColourMode::Spectral(match self.wavelengths {
                    Wavelengths::One => WavelengthCount::One,
                    Wavelengths::Four => WavelengthCount::Four,
                    Wavelengths::Eight => WavelengthCount::Eight,
                })
            },
            film_sums: match self.sums {
                Sums::Single => FilmSums::Single,
                Sums::Double => FilmSums::Double,
                Sums::Compensated => FilmSums::Compensated,
            },
            sampler: self.sampler.unwrap_or(sampler),
            guiding: self.guiding.unwrap_or(guiding).is_on(),
            adaptive: self.adaptive.is_on(),
            trial: self.trial.is_on(),
            direct_light: match self.direct {
                Direct::NextEvent => DirectLight::NextEvent,
                Direct::Off => DirectLight::Off,
            },
            max_depth: self.max_depth,
            robust: self.robust,
            build_quality: match self.build_quality {
                Quality::Low => BuildQuality::Low,
                Quality::Medium => BuildQuality::Medium,
                Quality::High => BuildQuality::High,
            },
        })
    }
}
