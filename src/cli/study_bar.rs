//! What is told while a study runs.

use cohort::study::{Plan, StudyObserver};
use indicatif::{ProgressBar, ProgressStyle};

/// The progress bar of a study.
pub struct StudyBar {
    bar: ProgressBar,
    names: Vec<String>,
    repetitions: u32,
}

impl StudyBar {
    const STEPS: f64 = 10_000.0;

    /// A bar on the standard error, if that is a terminal.
    pub fn new(plan: &Plan) -> Self {
        let template = "{wide_bar} {percent:>3} % | {msg} | {elapsed} gone, {eta} left";
        // The template is a constant; if it were wrong, a plain bar would do.
        let style =
            ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
        let names = plan.competitors.iter().map(|planned| planned.name.clone());
        Self {
            bar: ProgressBar::new(Self::STEPS as u64).with_style(style),
            names: names.collect(),
            repetitions: plan.repetitions.get(),
        }
    }

    /// Takes the bar away.
    pub fn clear(&self) {
        self.bar.finish_and_clear();
    }
}

impl StudyObserver for StudyBar {
    fn reference(&self, share: f64) {
        self.bar.set_position((share * Self::STEPS) as u64);
        self.bar.set_message("reference");
        if share >= 1.0 {
            self.bar.reset();
        }
    }

    fn turn(&self, repetition: usize, share: f64, competitor: usize) {
        let done = (repetition as f64 + share) / f64::from(self.repetitions);
        self.bar.set_position((done * Self::STEPS) as u64);
        self.bar.set_message(format!(
            "repetition {} of {}: {}",
            repetition + 1,
            self.repetitions,
            self.names[competitor]
        ));
    }
}
