//! What a study found: the contents of `results.json`, from which every other file of the report is made.
//!
//! `docs/results.md` explains the fields to those who read the file with other programs.

use serde::{Deserialize, Serialize};

use super::statistics::Interval;

/// The version of the schema. It grows when a field changes its meaning or goes.
pub const SCHEMA: u32 = 2;

/// Everything that a study found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Results {
    /// [`SCHEMA`].
    pub schema: u32,
    /// What was varied.
    pub kind: StudyKind,
    /// The scene.
    pub scene: SceneFacts,
    /// What all competitors had in common.
    pub conditions: Conditions,
    /// What errors were measured against.
    pub reference: ReferenceFacts,
    /// Where and with what it ran.
    pub machine: Machine,
    /// The commands that make these results again.
    pub commands: Vec<String>,
    /// The competitors in the order of the command; the first is the baseline.
    pub competitors: Vec<Competitor>,
    /// Every pair of competitors, the earlier one of the command first.
    pub pairs: Vec<Pair>,
    /// Parts of the image to be shown enlarged, from those that the user named or from where competitors differ most.
    pub crops: Vec<Crop>,
}

/// What a study varied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StudyKind {
    /// Strategies, and other renderers: `cohort compare`.
    Compare,
    /// Settings of one strategy: `cohort accuracy`.
    Accuracy,
}

/// The scene that was rendered.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneFacts {
    /// The scene file as given, or the name of the built-in scene.
    pub name: String,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The share of pixels that see a light directly, in [0, 1]. See [`Errors`].
    pub lit_share: f64,
}

/// What all competitors had in common.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Conditions {
    /// What each competitor may use in each repetition.
    pub budget: StudyBudget,
    /// Rendering threads.
    pub threads: usize,
    /// Independent repetitions.
    pub repetitions: u32,
    /// Seed from which those of all repetitions are derived.
    pub seed: u64,
    /// How colours are carried, unless a competitor says otherwise.
    pub colour: String,
    /// What a competitor uses before it is the next one's turn, in the unit of the budget; `None` with a single turn.
    pub slice: Option<f64>,
    /// The largest deviation of a competitor's time from the planned one, as a share; `None` where the budget is not time.
    pub budget_deviation: Option<f64>,
}

/// A limit on what one competitor may use in one repetition.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StudyBudget {
    /// Seconds of wall-clock time while it runs.
    Seconds(f64),
    /// Camera paths per pixel.
    SamplesPerPixel(u32),
    /// Rays, shadow rays included.
    Rays(u64),
}

/// What errors were measured against.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReferenceFacts {
    /// In words: the file, or how it was rendered.
    pub source: String,
    /// Strategy that rendered it, if it was rendered here.
    pub strategy: Option<String>,
    /// Seconds that rendering it took, if it was rendered here.
    pub seconds: Option<f64>,
    /// Camera paths per pixel, in the mean, if it was rendered here.
    pub samples_per_pixel: Option<f64>,
    /// The mean over all pixels and channels of its estimated variance, which is subtracted from squared errors; `None`
    /// where it is not known, and errors then include those of the reference.
    pub variance: Option<f64>,
    /// The same for the relative squared error.
    pub relative_variance: Option<f64>,
    /// Standard error of its mean luminance, as a share of it.
    pub mean_error: Option<f64>,
}

/// Where and with what a study ran.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// The processor's name.
    pub processor: String,
    /// Processors that the program may use.
    pub processors: usize,
    /// The operating system.
    pub system: String,
    /// When it ended, as in 2026-03-01T12:00:00Z.
    pub date: String,
    /// Names and versions of the programs: Cohort, Embree, and peers.
    pub versions: Vec<(String, String)>,
}

/// One competitor and what it reached.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Competitor {
    /// Name, unique in the study, such as `roulette` or `mitsuba:llvm_ad_rgb`.
    pub name: String,
    /// The settings that make it what it is: name and value.
    pub settings: Vec<(String, String)>,
    /// Files of its images, relative to the folder of the report.
    pub images: Images,
    /// What it had reached at each planned point of the budget, ascending; the last is the whole budget.
    pub snapshots: Vec<Snapshot>,
    /// Slope of log relative MSE over log seconds; -1 for independent samples.
    pub slope: Option<Interval>,
    /// Seconds to the target error.
    pub time_to_error: TimeToError,
    /// Per repetition, samples that were not finite or negative and were dropped.
    pub dropped_samples: Vec<u64>,
    /// Verdict of an accuracy study; `None` in a comparison, and for its baseline.
    pub verdict: Option<Verdict>,
}

/// Files of a competitor's images.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Images {
    /// The mean of all repetitions, EXR.
    pub exr: String,
    /// The same, tone-mapped.
    pub png: String,
    /// The first repetition alone, tone-mapped: the noise that one budget leaves.
    pub one_png: String,
    /// Error of the first repetition, false colour.
    pub error_png: String,
    /// Relative squared error that the top of the false colours stands for.
    pub error_scale: f64,
}

/// Where a competitor stood at one point of its budget.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// The planned point, in the unit of the budget.
    pub at: f64,
    /// Seconds, the mean of the repetitions.
    pub seconds: f64,
    /// Camera paths, the mean of the repetitions.
    pub camera_paths: f64,
    /// Rays, shadow rays included, the mean of the repetitions; `None` where the competitor does not count them.
    pub rays: Option<f64>,
    /// Errors with their intervals over the repetitions.
    pub errors: ErrorIntervals,
    /// Errors of every repetition.
    pub repetitions: Vec<Errors>,
}

/// Errors of one image against the reference. Values are linear sRGB; means are over pixels and channels.
///
/// With x the image, r the reference and v the reference's variance, in one channel of one pixel:
/// MSE is the mean of (x - r)^2 - v. Relative MSE is the mean of ((x - r)^2 - v) / (m^2 + e), where m is the mean of the
/// pixel's three channels in the reference and e = (0.01 M)^2 keeps black pixels from counting without limit, M being the
/// mean of the whole reference. Subtracting v makes both unbiased for the error against the truth; single values may be
/// negative where there is hardly any error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Errors {
    /// Mean squared error.
    pub mse: f64,
    /// Relative mean squared error.
    pub relative_mse: f64,
    /// Relative deviation of the mean luminance: mean x / mean r - 1.
    pub bias: f64,
    /// Of pixels that see a light directly.
    pub lit: RegionErrors,
    /// Of all other pixels: reflected light alone.
    pub reflected: RegionErrors,
    /// Mean LDR-FLIP of the tone-mapped images, in [0, 1], if asked for.
    pub flip: Option<f64>,
}

/// Errors of a part of the image, means over its pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RegionErrors {
    /// Mean squared error.
    pub mse: f64,
    /// Relative mean squared error.
    pub relative_mse: f64,
}

/// The same with 95 % intervals over repetitions.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ErrorIntervals {
    /// Mean squared error.
    pub mse: Interval,
    /// Square root of the mean squared error.
    pub rmse: Interval,
    /// Relative mean squared error.
    pub relative_mse: Interval,
    /// Relative deviation of the mean luminance; its interval includes the reference's standard error, if known.
    pub bias: Interval,
    /// Mean squared error where a light is seen directly.
    pub lit_mse: Interval,
    /// Mean squared error elsewhere.
    pub reflected_mse: Interval,
    /// Relative mean squared error where a light is seen directly.
    pub lit_relative_mse: Interval,
    /// Relative mean squared error elsewhere.
    pub reflected_relative_mse: Interval,
    /// The variance between repetitions; `None` for a single repetition.
    pub variance: Option<VarianceIntervals>,
    /// 1 / (MSE x seconds).
    pub efficiency: Interval,
    /// 1 / (relative MSE x seconds).
    pub relative_efficiency: Interval,
    /// 1 / (relative MSE x rays), where rays are counted.
    pub ray_efficiency: Option<Interval>,
    /// Mean LDR-FLIP.
    pub flip: Option<Interval>,
}

/// The variance of one image, estimated between repetitions, as a mean over pixels and channels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct VarianceIntervals {
    /// Over all pixels.
    pub all: Interval,
    /// Over the pixels that see a light directly.
    pub lit: Interval,
    /// Over all other pixels.
    pub reflected: Interval,
}

/// How long a competitor takes to the target error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TimeToError {
    /// The relative MSE aimed at: the user's, or what the baseline has at the end.
    pub relative_mse: f64,
    /// Seconds.
    pub seconds: Option<Interval>,
    /// Whether it lies outside of what was measured and is taken from the slope.
    pub extrapolated: bool,
}

/// Two competitors held against each other at the end of the budget. Ratios above 1 say that the second is better.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pair {
    /// Name of the first.
    pub first: String,
    /// Name of the second.
    pub second: String,
    /// Ratio of efficiencies by relative MSE, which leads: relMSE x seconds of the first / those of the second.
    pub relative_efficiency: Interval,
    /// Ratio of efficiencies by plain MSE.
    pub efficiency: Interval,
    /// Ratio of efficiencies by relative MSE where no light is seen directly.
    pub reflected_efficiency: Interval,
    /// What [`Self::relative_efficiency`] says.
    pub finding: Finding,
}

/// What an interval of a ratio says.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Finding {
    /// The interval holds 1, or there is none: no difference shown.
    NoDifferenceShown,
    /// The second is better.
    SecondBetter,
    /// The first is better.
    FirstBetter,
}

/// What a setting costs and buys against the baseline of an accuracy study.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// The setting that is varied, such as `wavelengths`.
    pub axis: String,
    /// Its value here.
    pub value: String,
    /// Whether this value is the program's default.
    pub is_default: bool,
    /// Seconds per sample per pixel relative to the baseline's: 1.1 costs 10 %.
    pub time_per_sample: Interval,
    /// Root mean square relative error at equal time relative to the baseline's: 0.9 buys 10 %.
    pub error_at_equal_time: Interval,
    /// Bias against the reference, as a share of the mean.
    pub bias: Interval,
    /// Whether the interval of the bias excludes 0.
    pub biased: bool,
    /// In words: "costs x % time, buys y % error".
    pub text: String,
}

/// A part of the image that is shown enlarged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Crop {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}
