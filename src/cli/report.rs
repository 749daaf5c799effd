//! What is told while a render runs and after it. Where nobody listens any more (a closed pipe), it is not told.

use std::fmt::{Display, Write as _};
use std::io::Write as _;

use cohort::render::{Observer, Outcome, Progress, Render};
use cohort::scene::Scene;
use indicatif::{ProgressBar, ProgressStyle};

use super::output::{OutputFiles, peak_memory};

/// Tells an error or a warning, or how things go, on the standard error.
pub fn tell(message: impl Display) {
    let _ = writeln!(std::io::stderr(), "cohort: {message}");
}

/// Warns of what makes a scene's image black.
pub fn warn_of_darkness(scene: &Scene) {
    if scene.emitters.is_empty() {
        tell("warning: the scene has no emitter, so the image will be black");
    } else if scene.integrator.max_depth == Some(0) {
        tell("warning: the scene's `max_depth` is 0, so the image will be black");
    }
}

/// The progress bar.
pub struct Bar(ProgressBar);

impl Bar {
    const STEPS: u64 = 10_000;

    /// A bar on the standard error, if that is a terminal.
    pub fn new() -> Self {
        let template = "{wide_bar} {percent:>3} % | {msg} | {elapsed} gone, {eta} left";
        // The template is a constant; if it were wrong, a plain bar would do.
        let style =
            ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
        Self(ProgressBar::new(Self::STEPS).with_style(style))
    }

    /// Takes the bar away.
    pub fn clear(&self) {
        self.0.finish_and_clear();
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
pub fn summarise(render: &Render, outcome: &Outcome, files: &OutputFiles) {
    let text = summary(render, outcome, files);
    let _ = std::io::stdout().write_all(text.as_bytes());
    let unseen = outcome.film.pixels().filter(|pixel| pixel.samples == 0);
    match unseen.count() {
        0 => {}
        count => tell(format_args!(
            "warning: {count} pixels are black because the render ended before their first sample"
        )),
    }
}

fn summary(render: &Render, outcome: &Outcome, files: &OutputFiles) -> String {
    let statistics = &outcome.statistics;
    let seconds = outcome.duration.as_secs_f64();
    let pixels = outcome.film.size().pixels() as f64;
    let samples = statistics.camera_paths as f64 / pixels;
    let mut text = format!("{}\n{}\n", files.exr.display(), files.png.display());
    // Writing to a string cannot fail.
    let _ = writeln!(
        text,
        "{} by {}: {samples:.2} samples per pixel in {seconds:.2} s ({:.4} s per sample per pixel), {}",
        render.engine().scene().name,
        render.engine().strategy().name(),
        if samples > 0.0 {
            seconds / samples
        } else {
            0.0
        },
        outcome.ended.name(),
    );
    let _ = writeln!(
        text,
        "{:.3} million rays/s, {:.1} % of the time inside Embree {}, longest path {} segments{}",
        statistics.all_rays() as f64 / seconds * 1e-6,
        100.0 * statistics.intersection_share(),
        render.engine().embree_version(),
        statistics.deepest,
        peak_memory().map_or(String::new(), |mib| format!(", peak memory {mib:.0} MiB")),
    );
    let dropped = &statistics.dropped;
    if dropped.total() > 0 {
        let _ = writeln!(
            text,
            "dropped: {} samples not a number, {} infinite, {} negative; {} batches cut off at the bounce limit",
            dropped.nan, dropped.infinite, dropped.negative, dropped.endless
        );
    }
    if statistics.walk.dropped() > 0 {
        let _ = writeln!(
            text,
            "dropped: {} particles whose importance was no number",
            statistics.walk.dropped()
        );
    }
    text
}
