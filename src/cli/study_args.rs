//! What `compare` and `accuracy` have in common.

use std::error::Error;
use std::num::{NonZeroU32, NonZeroU64, NonZeroUsize};
use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use clap::Args;
use cohort::render::{Budget, ColourMode, Settings};
use cohort::sampling::SamplerKind;
use cohort::scene::Scene;
use cohort::study::results::{Crop, StudyKind};
use cohort::study::{
    self, EntrySettings, Plan, Planned, ReferencePlan, SceneSource, StudyEnd, report::Answer,
};

use super::interrupt::stop_on_interrupt;
use super::parse::{Switch, parse_count, parse_rays, parse_seed, parse_threads, parse_time};
use super::report::tell;
use super::scene_args::SceneArgs;
use super::study_bar::StudyBar;

/// Budget, repetitions, reference and report of a study.
#[derive(Args)]
pub struct StudyArgs {
    #[command(flatten)]
    scene: SceneArgs,

    /// Folder of the report; a study that was interrupted there goes on [default: the scene's name, a dash and the
    /// subcommand]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,

    /// Wall-clock time of each competitor in each repetition, such as 60s or 30m [default: 60s]
    #[arg(long, value_name = "DURATION", value_parser = parse_time)]
    time: Option<Duration>,

    /// Camera paths per pixel of each instead of a time
    #[arg(long, value_name = "N", conflicts_with = "time", value_parser = parse_count)]
    spp: Option<NonZeroU32>,

    /// Rays of each, shadow rays included, instead of a time
    #[arg(long, value_name = "N", conflicts_with_all = ["time", "spp"], value_parser = parse_rays)]
    rays: Option<NonZeroU64>,

    /// Independent repetitions; intervals need two, and are wide below five
    #[arg(long, value_name = "N", default_value = "5", value_parser = parse_count)]
    repeat: NonZeroU32,

    /// Most points of the budget at which errors are measured: all of it, its half, its quarter …
    #[arg(long, value_name = "N", default_value_t = 8)]
    snapshots: u32,

    /// EXR to measure errors against [default: one is rendered]
    #[arg(long, value_name = "FILE", conflicts_with_all = ["reference_time", "reference_spp"])]
    reference: Option<PathBuf>,

    /// Time to render a reference, on all cores [default: twice what a competitor gets in all repetitions]
    #[arg(long, value_name = "DURATION", conflicts_with = "reference_spp", value_parser = parse_time)]
    reference_time: Option<Duration>,

    /// Camera paths per pixel of the reference instead of a time
    #[arg(long, value_name = "N", value_parser = parse_count)]
    reference_spp: Option<NonZeroU32>,

    /// Rendering threads of each competitor
    #[arg(long, value_name = "N", default_value = "1", value_parser = parse_threads)]
    threads: NonZeroUsize,

    /// Seed from which those of all repetitions and of the reference are derived
    #[arg(long, value_name = "N", default_value = "0", value_parser = parse_seed)]
    seed: u64,

    /// Render in three channels instead of wavelengths
    #[arg(long)]
    rgb: bool,

    /// Where the random numbers of paths come from: independent, sobol or array-qmc
    #[arg(long, value_name = "NAME", default_value_t = SamplerKind::default())]
    sampler: SamplerKind,

    /// Whether directions are guided, and lights chosen, by where light was found to come from
    #[arg(long, value_name = "SWITCH", value_enum, default_value_t = Switch::Off)]
    guiding: Switch,

    /// Whether pixels in which one path leaves much error get more of them
    #[arg(long, value_name = "SWITCH", value_enum, default_value_t = Switch::Off)]
    adaptive: Switch,

    /// Whether what was learned is tried against doing without, and left aside where it does not pay
    #[arg(long, value_name = "SWITCH", value_enum, default_value_t = Switch::Off)]
    trial: Switch,

    /// Measures beside MSE and relative MSE
    #[arg(long, value_name = "NAME", value_enum, value_delimiter = ',')]
    metrics: Vec<Metric>,

    /// Relative MSE to which times are given [default: what the first competitor reaches]
    #[arg(long, value_name = "ERROR", value_parser = parse_error)]
    target: Option<f64>,

    /// Part of the image to be shown enlarged, may be given several times [default: where competitors differ most]
    #[arg(long = "crop", value_name = "X,Y,WxH", value_parser = parse_crop)]
    crops: Vec<Crop>,
}

/// A measure that is made only if asked for.
#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Metric {
    /// LDR-FLIP of the tone-mapped images
    Flip,
}

fn parse_error(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(error) if f64::is_finite(error) && error > 0.0 => Ok(error),
        _ => Err("it must be a number above 0".to_owned()),
    }
}

fn parse_crop(text: &str) -> Result<Crop, String> {
    let parsed = || {
        let (x, rest) = text.split_once(',')?;
        let (y, size) = rest.split_once(',')?;
        let (width, height) = size.split_once('x')?;
        let crop = Crop {
            x: x.trim().parse().ok()?,
            y: y.trim().parse().ok()?,
            width: width.trim().parse().ok()?,
            height: height.trim().parse().ok()?,
        };
        (crop.width > 0 && crop.height > 0).then_some(crop)
    };
    parsed().ok_or_else(|| "a crop is written X,Y,WxH in pixels, such as 300,420,80x80".to_owned())
}

impl StudyArgs {
    /// Runs a study of those whom `competitors` names, given the settings that all have in common.
    pub fn run(
        &self,
        kind: StudyKind,
        competitors: impl FnOnce(EntrySettings) -> Vec<Planned>,
    ) -> Result<ExitCode, Box<dyn Error>> {
        let base = EntrySettings {
            colour: if self.rgb {
                ColourMode::Rgb
            } else {
                Settings::default().colour
            },
            sampler: self.sampler,
            guiding: self.guiding.is_on(),
            adaptive: self.adaptive.is_on(),
            trial: self.trial.is_on(),
            ..EntrySettings::default()
        };
        let plan = Plan {
            kind,
            competitors: competitors(base.clone()),
            budget: self.budget(),
            repetitions: self.repeat,
            snapshots: self.snapshots.max(1),
            seed: self.seed,
            colour: base.colour,
            threads: self.threads,
            reference: self.reference(base),
            flip: self.metrics.contains(&Metric::Flip),
            target: self.target,
            crops: self.crops.clone(),
            scene: SceneSource {
                name: self.scene.name(),
                file: self.scene.file().cloned(),
                definitions: self.scene.definitions(),
            },
            command: command_line(),
        };
        plan.check()?;
        let scene = Arc::new(self.scene.load(Settings::default().threads)?);
        for crop in &plan.crops {
            check_crop(crop, &scene)?;
        }
        let text = self.scene.text()?;
        let folder = self.folder(kind);
        let stop = stop_on_interrupt(
            "stopping; the study can be resumed (Ctrl-C again to lose the turn)",
        )?;
        let bar = StudyBar::new(&plan);
        let end = study::run(&plan, &scene, &text, &folder, &stop, &bar)?;
        bar.clear();
        let page = folder.join("index.html");
        Ok(match end {
            StudyEnd::Complete(results) => {
                let answer = Answer::of(&results);
                tell(&answer.headline);
                answer
                    .findings
                    .iter()
                    .chain(&answer.cautions)
                    .for_each(tell);
                tell(format!("report: {}", page.display()));
                ExitCode::SUCCESS
            }
            StudyEnd::Interrupted(results) => {
                if results.is_some() {
                    tell(format!("report of what is complete: {}", page.display()));
                }
                tell("interrupted; the same command goes on");
                ExitCode::from(130)
            }
        })
    }

    fn budget(&self) -> Budget {
        match (self.spp, self.rays) {
            (Some(samples), _) => Budget::SamplesPerPixel(samples),
            (None, Some(rays)) => Budget::Rays(rays),
            (None, None) => Budget::Time(self.time.unwrap_or(Duration::from_secs(60))),
        }
    }

    fn reference(&self, settings: EntrySettings) -> ReferencePlan {
        if let Some(file) = &self.reference {
            return ReferencePlan::File(file.clone());
        }
        // As many again for each of two: the reference's own error is known, and it should be small.
        let twice = 2 * self.repeat.get();
        let budget = match (self.reference_time, self.reference_spp, self.budget()) {
            (Some(time), _, _) => Budget::Time(time),
            (None, Some(samples), _) => Budget::SamplesPerPixel(samples),
            (None, None, Budget::Time(time)) => Budget::Time(time * twice),
            (None, None, Budget::SamplesPerPixel(samples)) => Budget::SamplesPerPixel(
                samples.saturating_mul(NonZeroU32::MIN.saturating_add(twice - 1)),
            ),
            (None, None, Budget::Rays(rays)) => Budget::Rays(
                rays.saturating_mul(NonZeroU64::MIN.saturating_add(u64::from(twice) - 1)),
            ),
        };
        ReferencePlan::Render {
            budget,
            threads: Settings::default().threads,
            settings,
        }
    }

    fn folder(&self, kind: StudyKind) -> PathBuf {
        let by_default = || {
            let what = match kind {
                StudyKind::Compare => "compare",
                StudyKind::Accuracy => "accuracy",
            };
            PathBuf::from(format!("{}-{what}", self.scene.stem()))
        };
        self.output.clone().unwrap_or_else(by_default)
    }
}

fn check_crop(crop: &Crop, scene: &Scene) -> Result<(), String> {
    let size = scene.film.crop.size;
    let fits = |start: u32, length: u32, side: u32| {
        start.checked_add(length).is_some_and(|end| end <= side)
    };
    if fits(crop.x, crop.width, size.width) && fits(crop.y, crop.height, size.height) {
        return Ok(());
    }
    Err(format!(
        "the crop {},{},{}x{} is not inside of the image, which has {}x{} pixels",
        crop.x, crop.y, crop.width, crop.height, size.width, size.height
    ))
}

/// The command that was given, quoted for a shell.
fn command_line() -> String {
    let quoted = |word: String| {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:,+@%".contains(c);
        if !word.is_empty() && word.chars().all(plain) {
            word
        } else {
            format!("'{}'", word.replace('\'', r"'\''"))
        }
    };
    let words = std::env::args_os().skip(1);
    let words = words.map(|word| quoted(word.to_string_lossy().into_owned()));
    let words: Vec<String> = std::iter::once("cohort".to_owned()).chain(words).collect();
    words.join(" ")
}
