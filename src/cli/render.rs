//! `cohort render`

use std::error::Error;
use std::num::{NonZeroU32, NonZeroUsize};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use clap::{Args, ValueEnum};
use cohort::embree::BuildQuality;
use cohort::film::{ExrOptions, write_exr, write_png};
use cohort::render::{
    Budget, ColourMode, Ended, MAX_THREADS, Render, Settings, StopFlag, metadata,
};
use cohort::scene::{FilmDescription, LoadOptions, PathIntegrator, Scene};
use cohort::transport::DirectLight;

use super::output::OutputFiles;
use super::report::{Bar, summarise, tell, warn_of_darkness};
use super::strategy_args::StrategyArgs;

/// Render a scene into an EXR, with a PNG beside it
#[derive(Args)]
pub struct RenderArgs {
    /// Scene file in Mitsuba 3's XML format; without one, the built-in Cornell box with a knot
    scene: Option<PathBuf>,

    /// The EXR to write [default: the scene's name in the current folder]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    /// Camera paths per pixel [default: what the scene says]
    #[arg(long, value_name = "N", conflicts_with = "time", value_parser = parse_count)]
    spp: Option<NonZeroU32>,

    /// Wall-clock time to render, without loading, such as 90s, 30m or 1h30m
    #[arg(long, value_name = "DURATION", value_parser = parse_time)]
    time: Option<Duration>,

    /// Threads that load and render [default: all cores]
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    threads: Option<NonZeroUsize>,

    /// Seed of all random numbers [default: what the scene says]
    #[arg(long, value_name = "N", value_parser = parse_seed)]
    seed: Option<u64>,

    /// Size of the image in pixels, such as 800x800 [default: what the scene says]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    size: Option<(i64, i64)>,

    /// Render in three channels instead of wavelengths
    #[arg(long)]
    rgb: bool,

    /// Set one of the scene's $names
    #[arg(short = 'D', value_name = "NAME=VALUE", value_parser = parse_definition)]
    definitions: Vec<(String, String)>,

    /// Folder with the models that the scene calls $models [default: the scene's own choice]
    #[arg(long, value_name = "DIR", env = "COHORT_MODELS")]
    models: Option<PathBuf>,

    /// How direct light is found
    #[arg(long, value_name = "HOW", value_enum, default_value_t = Direct::NextEvent)]
    direct: Direct,

    /// Most segments of a path, camera ray included [default: what the scene says]
    #[arg(long, value_name = "N", value_parser = parse_count)]
    max_depth: Option<NonZeroU32>,

    /// Watertight intersection, somewhat slower
    #[arg(long)]
    robust: bool,

    /// Effort in building the acceleration structure
    #[arg(long, value_name = "EFFORT", value_enum, default_value_t = Quality::High)]
    build_quality: Quality,

    // Last, because its heading holds for all that follows.
    #[command(flatten)]
    strategy: StrategyArgs,
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

fn parse_count(text: &str) -> Result<NonZeroU32, String> {
    let message = |_| format!("it must be a whole number from 1 to {}", u32::MAX);
    text.parse().map_err(message)
}

fn parse_threads(text: &str) -> Result<NonZeroUsize, String> {
    let message = |_| format!("it must be a whole number from 1 to {MAX_THREADS}");
    text.parse().map_err(message)
}

fn parse_seed(text: &str) -> Result<u64, String> {
    let message = |_| format!("it must be a whole number from 0 to {}", u64::MAX);
    text.parse().map_err(message)
}

fn parse_size(text: &str) -> Result<(i64, i64), String> {
    let sides = text
        .split_once('x')
        .and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    let (width, height) =
        sides.ok_or_else(|| "a size is written WxH, such as 800x600".to_owned())?;
    FilmDescription::new(width, height).map_err(|error| error.to_string())?;
    Ok((width, height))
}

fn parse_time(text: &str) -> Result<Duration, String> {
    match humantime::parse_duration(text) {
        Ok(Duration::ZERO) => Err("the time must be longer than 0".to_owned()),
        Ok(time) => Ok(time),
        Err(error) => Err(format!(
            "{error}; a time is written with units, such as 90s, 30m or 1h30m"
        )),
    }
}

fn parse_definition(text: &str) -> Result<(String, String), String> {
    let pair = text
        .split_once('=')
        .map(|(name, value)| (name.to_owned(), value.to_owned()));
    pair.ok_or_else(|| "a definition is written name=value".to_owned())
}

/// Runs the subcommand.
pub fn run(arguments: RenderArgs) -> Result<ExitCode, Box<dyn Error>> {
    let files = OutputFiles::check(&arguments.output_path())?;
    // A wrong setting is told before a scene is loaded, which can take long.
    let default_depth = PathIntegrator::default().roulette_depth;
    arguments.strategy.build(default_depth)?;
    let scene = arguments.load()?;
    warn_of_darkness(&scene);
    let settings = arguments.settings(&scene)?;
    let render = Render::new(Arc::new(scene), settings)?;
    let stop = stop_on_interrupt()?;
    let bar = Bar::new();
    let outcome = render.run(&stop, &bar);
    bar.clear();

    let film = &render.engine().scene().film;
    let image = outcome.film.image();
    let options = ExrOptions {
        format: film.pixel_format,
        half_precision: film.half_precision,
        samples: outcome.film.unequal_samples(),
        attributes: metadata(&render, &outcome),
        ..ExrOptions::default()
    };
    write_exr(&files.exr, &image, &options)?;
    write_png(&files.png, &image)?;
    summarise(&render, &outcome, &files);
    Ok(match outcome.ended {
        Ended::Complete | Ended::OutOfTime => ExitCode::SUCCESS,
        Ended::Interrupted => ExitCode::from(130),
    })
}

impl RenderArgs {
    fn output_path(&self) -> PathBuf {
        let by_default = || {
            let stem = self.scene.as_ref().and_then(|scene| scene.file_stem());
            let mut name = stem.unwrap_or("cornell-knot".as_ref()).to_owned();
            name.push(".exr");
            name.into()
        };
        self.output.clone().unwrap_or_else(by_default)
    }

    fn threads(&self) -> NonZeroUsize {
        self.threads.unwrap_or(Settings::default().threads)
    }

    fn load(&self) -> Result<Scene, Box<dyn Error>> {
        let options = LoadOptions {
            definitions: self.definitions.clone(),
            models: self.models.clone(),
        };
        // Loading takes as many threads as rendering may, and not the global pool's, which has all cores.
        let threads = self.threads().get().min(MAX_THREADS);
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()?;
        let mut scene = pool.install(|| match &self.scene {
            Some(path) => Scene::load(path, &options),
            None => Scene::built_in(&options),
        })?;
        if let Some((width, height)) = self.size {
            scene.film = scene.film.resized(width, height)?;
        }
        Ok(scene)
    }

    fn settings(&self, scene: &Scene) -> Result<Settings, Box<dyn Error>> {
        let of_scene = NonZeroU32::new(scene.sampler.sample_count).unwrap_or(NonZeroU32::MIN);
        Ok(Settings {
            strategy: self.strategy.build(scene.integrator.roulette_depth)?,
            budget: match self.time {
                Some(time) => Budget::Time(time),
                None => Budget::SamplesPerPixel(self.spp.unwrap_or(of_scene)),
            },
            threads: self.threads(),
            seed: self.seed.unwrap_or(scene.sampler.seed),
            colour: if self.rgb {
                ColourMode::Rgb
            } else {
                ColourMode::Spectral
            },
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

/// A flag that Ctrl-C raises; a second Ctrl-C ends the program at once.
fn stop_on_interrupt() -> Result<StopFlag, ctrlc::Error> {
    let stop = StopFlag::new();
    let raised = stop.clone();
    ctrlc::set_handler(move || {
        if raised.is_raised() {
            std::process::exit(130);
        }
        tell("stopping; what there is will be written (Ctrl-C again to lose it)");
        raised.raise();
    })?;
    Ok(stop)
}
