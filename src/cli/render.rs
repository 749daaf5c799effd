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
    Budget, ColourMode, Ended, Observer, Outcome, Progress, Render, Settings, StopFlag, metadata,
};
use cohort::scene::{LoadOptions, Scene};
use cohort::transport::DirectLight;
use cohort::walk::{Rounding, Scope, Strategy, StrategyKind, StrategyOptions};
use indicatif::{ProgressBar, ProgressStyle};

use super::output::{OutputFiles, peak_memory};

/// Render a scene into an EXR, with a PNG beside it
#[derive(Args)]
pub struct RenderArgs {
    /// Scene file in Mitsuba 3's XML format; without one, the built-in Cornell box with a knot
    scene: Option<PathBuf>,

    /// The EXR to write [default: the scene's name in the current folder]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    #[command(flatten)]
    strategy: StrategyArgs,

    /// Camera paths per pixel [default: what the scene says]
    #[arg(long, value_name = "N", conflicts_with = "time")]
    spp: Option<NonZeroU32>,

    /// Wall-clock time to render, without loading, such as 90s, 30m or 1h30m
    #[arg(long, value_name = "DURATION", value_parser = humantime::parse_duration)]
    time: Option<Duration>,

    /// Threads that load and render [default: all cores]
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,

    /// Seed of all random numbers [default: what the scene says]
    #[arg(long, value_name = "N")]
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
    #[arg(long, value_enum, default_value_t = Direct::NextEvent)]
    direct: Direct,

    /// Most segments of a path, camera ray included [default: what the scene says]
    #[arg(long, value_name = "N")]
    max_depth: Option<NonZeroU32>,

    /// Watertight intersection, 15 to 25 % slower
    #[arg(long)]
    robust: bool,

    /// Effort in building the acceleration structure
    #[arg(long, value_enum, default_value_t = Quality::High)]
    build_quality: Quality,
}

/// Which strategy, and its settings.
#[derive(Args)]
#[command(next_help_heading = "Strategy")]
struct StrategyArgs {
    /// Who decides how long paths are followed: fixed-depth, roulette, throughput-roulette, go-with-the-winners,
    /// particle-filter or paper-particle-filter
    #[arg(long, value_name = "NAME", default_value_t = StrategyKind::Roulette)]
    strategy: StrategyKind,

    /// roulette: importance below which a path may end (the paper's T) [default: 0.1]
    #[arg(long, value_name = "T")]
    threshold: Option<f32>,

    /// roulette: probability of ending (the paper's P) [default: 0.5]
    #[arg(long, value_name = "P")]
    termination: Option<f32>,

    /// throughput-roulette: number of segments from which on a path may end [default: the scene's rr_depth]
    #[arg(long, value_name = "N")]
    from_depth: Option<u32>,

    /// go-with-the-winners, particle-filter: most children of a vertex of full importance [default: 10, or 1 for
    /// the populations pixel and tile]
    #[arg(long, value_name = "N")]
    n_max: Option<f32>,

    /// particle-filter: which paths are resampled together: camera-path, pixel or tile [default: pixel]
    #[arg(long, value_name = "NAME")]
    population: Option<Scope>,

    /// particle-filter: how counts are drawn: multinomial, stratified, systematic, residual or residual-stratified
    /// [default: systematic]
    #[arg(long, value_name = "NAME")]
    counts: Option<Rounding>,
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

fn parse_size(text: &str) -> Result<(i64, i64), String> {
    let sides = text
        .split_once('x')
        .and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    sides.ok_or_else(|| "a size is written WxH, such as 800x600".to_owned())
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
    let scene = arguments.load()?;
    let settings = arguments.settings(&scene)?;
    let render = Render::new(Arc::new(scene), settings)?;
    let stop = stop_on_interrupt()?;
    let bar = Bar::new();
    let outcome = render.run(&stop, &bar);
    bar.0.finish_and_clear();

    let film = &render.engine().scene().film;
    let image = outcome.film.image();
    let options = ExrOptions {
        format: film.pixel_format,
        half_precision: film.half_precision,
        attributes: metadata(&render, &outcome),
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
        let of_scene = || self.scene.as_ref()?.file_stem().map(PathBuf::from);
        let by_default = || {
            of_scene()
                .unwrap_or_else(|| "cornell-knot".into())
                .with_extension("exr")
        };
        self.output.clone().unwrap_or_else(by_default)
    }

    fn load(&self) -> Result<Scene, Box<dyn Error>> {
        let options = LoadOptions {
            definitions: self.definitions.clone(),
            models: self.models.clone(),
        };
        let mut scene = match &self.scene {
            Some(path) => Scene::load(path, &options)?,
            None => Scene::built_in(&options)?,
        };
        if let Some((width, height)) = self.size {
            scene.film = scene.film.resized(width, height)?;
        }
        Ok(scene)
    }

    fn settings(&self, scene: &Scene) -> Result<Settings, Box<dyn Error>> {
        let default = Settings::default();
        let of_scene = NonZeroU32::new(scene.sampler.sample_count).unwrap_or(NonZeroU32::MIN);
        Ok(Settings {
            strategy: self.strategy.build(scene)?,
            budget: match self.time {
                Some(time) => Budget::Time(time),
                None => Budget::SamplesPerPixel(self.spp.unwrap_or(of_scene)),
            },
            threads: self.threads.unwrap_or(default.threads),
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

impl StrategyArgs {
    fn build(&self, scene: &Scene) -> Result<Box<dyn Strategy>, Box<dyn Error>> {
        let of_scene = match self.strategy {
            StrategyKind::ThroughputRoulette => Some(scene.integrator.roulette_depth),
            _ => None,
        };
        Ok(self.strategy.build(&StrategyOptions {
            threshold: self.threshold,
            termination: self.termination,
            from_depth: self.from_depth.or(of_scene),
            n_max: self.n_max,
            population: self.population,
            counts: self.counts,
        })?)
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
        eprintln!("stopping; what there is will be written (Ctrl-C again to lose it)");
        raised.raise();
    })?;
    Ok(stop)
}

/// The progress bar.
struct Bar(ProgressBar);

impl Bar {
    const STEPS: u64 = 10_000;

    fn new() -> Self {
        let template = "{wide_bar} {percent:>3} % | {msg} | {elapsed} gone, {eta} left";
        // The template is a constant; if it were wrong, a plain bar would do.
        let style =
            ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
        Self(ProgressBar::new(Self::STEPS).with_style(style))
    }
}

impl Observer for Bar {
    fn progress(&self, progress: &Progress) {
        let rays_per_second = progress.rays as f64 / progress.elapsed.as_secs_f64().max(1e-9);
        self.0
            .set_position((progress.share * Self::STEPS as f64) as u64);
        self.0.set_message(format!(
            "{:.1} samples per pixel, {:.2} Mrays/s",
            progress.samples_per_pixel,
            rays_per_second * 1e-6
        ));
    }
}

/// Says what was made and what it took.
fn summarise(render: &Render, outcome: &Outcome, files: &OutputFiles) {
    let statistics = &outcome.statistics;
    let seconds = outcome.duration.as_secs_f64();
    let pixels = outcome.film.size().pixels() as f64;
    let samples = statistics.camera_paths as f64 / pixels;
    println!("{}\n{}", files.exr.display(), files.png.display());
    println!(
        "{} by {}: {samples:.2} samples per pixel in {seconds:.2} s ({:.4} s per sample per pixel), {}",
        render.engine().scene().name,
        render.engine().strategy().name(),
        seconds / samples.max(f64::MIN_POSITIVE),
        outcome.ended.name(),
    );
    println!(
        "{:.3} million rays/s, {:.1} % of the time inside Embree {}, longest path {} segments{}",
        statistics.all_rays() as f64 / seconds * 1e-6,
        100.0 * statistics.intersection_share(),
        render.engine().embree_version(),
        statistics.deepest,
        peak_memory().map_or(String::new(), |mib| format!(", peak memory {mib:.0} MiB")),
    );
    let dropped = &statistics.dropped;
    if dropped.total() > 0 {
        println!(
            "dropped: {} samples not a number, {} infinite, {} negative; {} batches cut off at the bounce limit",
            dropped.nan, dropped.infinite, dropped.negative, dropped.endless
        );
    }
    if statistics.walk.dropped() > 0 {
        println!(
            "dropped: {} particles whose importance was no number",
            statistics.walk.dropped()
        );
    }
}
