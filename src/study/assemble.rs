//! From records and images to results.

use std::num::NonZeroU32;

use super::kept::{Kept, Record, StudyFolder};
use super::machine::this_machine;
use super::measures::Repetitions;
use super::pairs::{self, pairs};
use super::pictures::{Gathered, error_scale, gather, telling_crops, write_images};
use super::plan::{Plan, ReferencePlan};
use super::race::Judge;
use super::results::{
    Competitor, Conditions, Errors, Images, ReferenceFacts, Results, SCHEMA, SceneFacts, Snapshot,
    StudyBudget, VarianceIntervals,
};
use super::statistics::{CoursePoint, slope, time_to_reach};
use super::timeline::Turn;
use super::verdict::verdict;
use super::{Contender, StudyError};
use crate::render::Budget;
use crate::scene::Scene;

/// What a study leaves behind: at least one repetition of everybody.
pub struct Outcome<'a> {
    /// What it did.
    pub plan: &'a Plan,
    /// What it rendered.
    pub scene: &'a Scene,
    /// Who took part.
    pub contenders: &'a [Box<dyn Contender>],
    /// When images were looked at.
    pub turns: &'a [Turn],
    /// What they were held against.
    pub judge: &'a Judge<'a>,
    /// What was recorded.
    pub kept: &'a Kept,
    /// Where the images are.
    pub folder: &'a StudyFolder,
}

/// Computes the results, and writes the images that they name.
///
/// # Errors
/// Images that cannot be read or written.
pub fn assemble(outcome: &Outcome) -> Result<Results, StudyError> {
    let plan = outcome.plan;
    let repetitions = outcome.kept.complete.len();
    let columns: Vec<Course> = (0..plan.competitors.len())
        .map(|competitor| Course::of(&outcome.kept.complete, competitor))
        .collect();
    let gathered: Result<Vec<Gathered>, StudyError> = plan
        .competitors
        .iter()
        .map(|planned| {
            gather(
                outcome.folder,
                &planned.name,
                repetitions,
                outcome.judge.lit,
            )
        })
        .collect();
    let gathered = gathered?;
    let reference = outcome.judge.reference;
    let scale = error_scale(&gathered, reference);
    let target = plan.target.unwrap_or_else(|| columns[0].mean_final_error());
    let mut competitors = Vec::new();
    for (index, planned) in plan.competitors.iter().enumerate() {
        let images = write_images(
            outcome.folder,
            &planned.name,
            &gathered[index],
            reference,
            scale,
        )?;
        competitors.push(competitor(
            outcome,
            &columns,
            index,
            &gathered[index],
            images,
            target,
        ));
    }
    let finals: Vec<pairs::Contender> = plan
        .competitors
        .iter()
        .zip(&columns)
        .map(|(planned, course)| pairs::Contender {
            name: &planned.name,
            repetitions: course.at_the_end(),
        })
        .collect();
    let size = outcome.scene.film.crop.size;
    let lit = outcome.judge.lit;
    Ok(Results {
        schema: SCHEMA,
        kind: plan.kind,
        scene: SceneFacts {
            name: plan.scene.name.clone(),
            width: size.width,
            height: size.height,
            lit_share: lit.iter().filter(|&&lit| lit).count() as f64 / lit.len() as f64,
        },
        conditions: conditions(outcome, &columns),
        reference: reference_facts(outcome),
        machine: this_machine(
            outcome
                .contenders
                .iter()
                .map(|contender| contender.version()),
        ),
        commands: vec![plan.command.clone()],
        pairs: pairs(&finals),
        crops: if plan.crops.is_empty() {
            telling_crops(&gathered, reference)
        } else {
            plan.crops.clone()
        },
        competitors,
    })
}

/// What one competitor reached, snapshot by snapshot; within one, repetition by repetition.
pub(super) struct Course {
    pub(super) snapshots: Vec<Column>,
}

/// One snapshot of all repetitions.
pub(super) struct Column {
    pub(super) errors: Vec<Errors>,
    pub(super) seconds: Vec<f64>,
    pub(super) camera_paths: Vec<f64>,
    pub(super) rays: Option<Vec<f64>>,
    pub(super) dropped: Vec<u64>,
}

impl Course {
    fn of(complete: &[Vec<Vec<Record>>], competitor: usize) -> Self {
        let of_repetitions: Vec<&[Record]> = complete
            .iter()
            .map(|repetition| repetition[competitor].as_slice())
            .collect();
        let column = |snapshot: usize| {
            let records = of_repetitions.iter().map(|records| &records[snapshot]);
            Column {
                errors: records.clone().map(|record| record.errors).collect(),
                seconds: records.clone().map(|r| r.standing.seconds).collect(),
                camera_paths: records
                    .clone()
                    .map(|r| r.standing.camera_paths as f64)
                    .collect(),
                rays: records
                    .clone()
                    .map(|r| r.standing.rays.map(|rays| rays as f64))
                    .collect(),
                dropped: records.map(|record| record.standing.dropped).collect(),
            }
        };
        let count = of_repetitions.iter().map(|records| records.len()).min();
        Self {
            snapshots: (0..count.unwrap_or(0)).map(column).collect(),
        }
    }

    /// The whole budget: there is always a snapshot there.
    pub(super) fn last(&self) -> &Column {
        &self.snapshots[self.snapshots.len() - 1]
    }

    fn at_the_end(&self) -> Repetitions<'_> {
        self.last().repetitions(None)
    }

    fn mean_final_error(&self) -> f64 {
        mean(self.last().errors.iter().map(|errors| errors.relative_mse))
    }

    /// By repetition: error over time.
    fn points(&self) -> Vec<Vec<CoursePoint>> {
        (0..self.last().errors.len())
            .map(|repetition| {
                let point = |column: &Column| CoursePoint {
                    seconds: column.seconds[repetition],
                    error: column.errors[repetition].relative_mse,
                };
                self.snapshots.iter().map(point).collect()
            })
            .collect()
    }
}

impl Column {
    fn repetitions(&self, variance: Option<VarianceIntervals>) -> Repetitions<'_> {
        Repetitions {
            errors: &self.errors,
            seconds: &self.seconds,
            rays: self.rays.as_deref(),
            variance,
        }
    }
}

fn competitor(
    outcome: &Outcome,
    columns: &[Course],
    index: usize,
    gathered: &Gathered,
    images: Images,
    target: f64,
) -> Competitor {
    let course = &columns[index];
    let planned = &outcome.plan.competitors[index];
    let points = course.points();
    let looks = outcome.turns.iter().filter(|turn| turn.is_snapshot);
    let last = course.snapshots.len() - 1;
    let snapshots: Vec<Snapshot> = looks
        .zip(&course.snapshots)
        .enumerate()
        .map(|(number, (turn, column))| {
            // The images that are kept are those of the whole budget.
            let variance = gathered.variance.filter(|_| number == last);
            Snapshot {
                at: amount(turn.until),
                seconds: mean(column.seconds.iter().copied()),
                camera_paths: mean(column.camera_paths.iter().copied()),
                rays: column.rays.as_ref().map(|rays| mean(rays.iter().copied())),
                errors: column
                    .repetitions(variance)
                    .intervals(outcome.judge.reference),
                repetitions: column.errors.clone(),
            }
        })
        .collect();
    let bias = snapshots[last].errors.bias;
    Competitor {
        name: planned.name.clone(),
        settings: outcome.contenders[index].settings(),
        images,
        slope: slope(&points),
        time_to_error: time_to_reach(&points, target),
        dropped_samples: course.last().dropped.clone(),
        verdict: planned
            .variation
            .as_ref()
            .map(|variation| verdict(variation, &columns[0], course, bias)),
        snapshots,
    }
}

fn conditions(outcome: &Outcome, columns: &[Course]) -> Conditions {
    let plan = outcome.plan;
    let seconds = match plan.budget {
        Budget::Time(time) => Some(time.as_secs_f64()),
        Budget::SamplesPerPixel(_) | Budget::Rays(_) => None,
    };
    let used = columns.iter().flat_map(|course| &course.last().seconds);
    let first_turn = outcome.turns.iter().find(|turn| !turn.is_snapshot);
    Conditions {
        budget: match plan.budget {
            Budget::Time(time) => StudyBudget::Seconds(time.as_secs_f64()),
            Budget::SamplesPerPixel(samples) => StudyBudget::SamplesPerPixel(samples.get()),
            Budget::Rays(rays) => StudyBudget::Rays(rays.get()),
        },
        threads: plan.threads.get(),
        repetitions: NonZeroU32::try_from(outcome.kept.complete.len() as u32)
            .map_or(0, NonZeroU32::get),
        seed: plan.seed,
        colour: plan.colour.name().to_owned(),
        slice: first_turn.map(|turn| amount(turn.until)),
        budget_deviation: seconds.map(|planned| {
            used.fold(0.0, |worst: f64, used| {
                worst.max((used / planned - 1.0).abs())
            })
        }),
    }
}

fn reference_facts(outcome: &Outcome) -> ReferenceFacts {
    let plan = outcome.plan;
    let reference = outcome.judge.reference;
    let cost = outcome.kept.reference_cost;
    let strategy = match &plan.reference {
        ReferencePlan::File(_) => None,
        ReferencePlan::Render { .. } => plan.reference_strategy().ok().map(|kind| kind.name()),
    };
    ReferenceFacts {
        source: match (&plan.reference, strategy, cost) {
            (ReferencePlan::File(path), ..) => path.display().to_string(),
            (ReferencePlan::Render { .. }, Some(strategy), Some(cost)) => format!(
                "rendered here by {strategy}: {:.0} samples per pixel in {:.0} s",
                cost.samples_per_pixel, cost.seconds
            ),
            (ReferencePlan::Render { .. }, ..) => "rendered here".to_owned(),
        },
        strategy: strategy.map(str::to_owned),
        seconds: cost.map(|cost| cost.seconds),
        samples_per_pixel: cost.map(|cost| cost.samples_per_pixel),
        variance: reference.variance(),
        relative_variance: reference.relative_variance(),
        mean_error: reference.mean_error(),
    }
}

/// A point of the budget as a number in its unit.
fn amount(budget: Budget) -> f64 {
    match budget {
        Budget::Time(time) => time.as_secs_f64(),
        Budget::SamplesPerPixel(samples) => f64::from(samples.get()),
        Budget::Rays(rays) => rays.get() as f64,
    }
}

pub(super) fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len().max(1) as f64;
    values.sum::<f64>() / count
}
