//! A study from its plan to its report.

use std::path::Path;
use std::sync::Arc;

use super::assemble::{Outcome, assemble};
use super::contender::Repetition;
use super::kept::{Kept, ReferenceCost, StudyFolder};
use super::plan::{How, Planned, ReferencePlan};
use super::race::{Judge, race};
use super::reference::Reference;
use super::report::write_report;
use super::timeline::turns;
use super::{Contender, EntrySettings, MitsubaContender, OurRender, Plan, StudyError, lit};
use crate::film::{ExrOptions, write_exr, write_png};
use crate::render::{Ended, Observer, Progress, Render, StopFlag};
use crate::sampling::SamplerKind;
use crate::scene::Scene;
use crate::study::results::Results;

/// Somebody who wants to know how far a study is.
pub trait StudyObserver: Sync {
    /// The reference is rendered, and this share of it is done.
    fn reference(&self, share: f64);
    /// A competitor begins a turn; the share is of the repetition. All count from 0.
    fn turn(&self, repetition: usize, share: f64, competitor: usize);
}

/// Nobody.
impl StudyObserver for () {
    fn reference(&self, _share: f64) {}
    fn turn(&self, _repetition: usize, _share: f64, _competitor: usize) {}
}

/// Hands the progress of the reference on.
struct OfReference<'a>(&'a dyn StudyObserver);

impl Observer for OfReference<'_> {
    fn progress(&self, progress: &Progress) {
        self.0.reference(progress.share);
    }
}

/// How a run of a study ended.
#[derive(Clone, Debug)]
pub enum StudyEnd {
    /// It is complete, and its report is written.
    Complete(Box<Results>),
    /// It was asked to stop. The same plan on the same folder goes on with it. If at least one repetition is complete,
    /// there is a report of those that are.
    Interrupted(Option<Box<Results>>),
}

/// Runs `plan` on `scene`, in `folder`, until it is complete or `stop` is raised. If the folder holds an interrupted study of
/// the same plan, goes on with that.
///
/// # Errors
/// A plan that is not sound, a scene that cannot be rendered so, a peer that fails, a folder that cannot be written.
pub fn run(
    plan: &Plan,
    scene: &Arc<Scene>,
    scene_text: &[u8],
    folder: &Path,
    stop: &StopFlag,
    observer: &dyn StudyObserver,
) -> Result<StudyEnd, StudyError> {
    plan.check()?;
    let (folder, mut kept) = StudyFolder::open(folder, &plan.fingerprint(scene_text))?;
    // Before the reference, which can take long: settings that are wrong are told at once.
    let mut contenders = contenders(plan, scene)?;
    let Some(reference) = reference(plan, scene, &folder, &mut kept, stop, observer)? else {
        return Ok(StudyEnd::Interrupted(None));
    };
    let lit = lit::pixels_that_see_a_light(scene, plan.threads)?;
    let judge = Judge {
        reference: &reference,
        lit: &lit,
        flip: plan.flip,
    };
    let turns = turns(plan.budget, plan.snapshots);
    let mut is_complete = true;
    while kept.complete.len() < plan.repetitions.get() as usize {
        let repetition = kept.complete.len();
        for (index, contender) in contenders.iter_mut().enumerate() {
            contender.begin(&Repetition {
                index: repetition as u32,
                count: plan.repetitions.get(),
                seed: plan.seed_of(index),
            });
        }
        is_complete = race(
            &mut contenders,
            &turns,
            &judge,
            &folder,
            &mut kept,
            stop,
            observer,
        )?;
        if !is_complete {
            break;
        }
        for (contender, planned) in contenders.iter().zip(&plan.competitors) {
            let path = folder.repetition(&planned.name, repetition);
            write_exr(&path, &contender.image(), &ExrOptions::default())?;
        }
        folder.keep(&kept)?;
    }
    if kept.complete.is_empty() {
        return Ok(StudyEnd::Interrupted(None));
    }
    let results = assemble(&Outcome {
        plan,
        scene,
        contenders: &contenders,
        turns: &turns,
        judge: &judge,
        kept: &kept,
        folder: &folder,
    })?;
    write_report(&results, folder.path())?;
    let results = Box::new(results);
    Ok(if is_complete {
        StudyEnd::Complete(results)
    } else {
        StudyEnd::Interrupted(Some(results))
    })
}

fn contenders(plan: &Plan, scene: &Arc<Scene>) -> Result<Vec<Box<dyn Contender>>, StudyError> {
    let contender = |planned: &Planned| -> Result<Box<dyn Contender>, StudyError> {
        Ok(match &planned.how {
            How::Ours(entry) => Box::new(OurRender::new(Arc::clone(scene), entry, plan.threads)?),
            How::Mitsuba(variant) => {
                Box::new(MitsubaContender::new(plan, scene, &planned.name, variant)?)
            }
        })
    };
    let all = plan.competitors.iter();
    all.map(contender).collect()
}

/// The reference: read, or rendered and written into the folder. `None` if `stop` was raised meanwhile.
fn reference(
    plan: &Plan,
    scene: &Arc<Scene>,
    folder: &StudyFolder,
    kept: &mut Kept,
    stop: &StopFlag,
    observer: &dyn StudyObserver,
) -> Result<Option<Reference>, StudyError> {
    let size = scene.film.crop.size;
    let (budget, threads, settings) = match &plan.reference {
        ReferencePlan::File(path) => return Ok(Some(Reference::from_file(path, size)?)),
        ReferencePlan::Render { .. } if kept.reference_cost.is_some() => {
            return Ok(Some(Reference::from_file(&folder.reference(), size)?));
        }
        ReferencePlan::Render {
            budget,
            threads,
            settings,
        } => (*budget, *threads, settings),
    };
    let entry = EntrySettings {
        strategy: plan.reference_strategy()?,
        // Only of independent samples is the variance known.
        sampler: SamplerKind::Independent,
        ..settings.clone()
    };
    let render = Render::new(Arc::clone(scene), entry.settings(scene, threads)?)?;
    let mut state = match kept.reference.take() {
        Some(state) if render.fits(&state) => state,
        Some(_) => return Err(StudyError::Misfit),
        None => render.start(plan.reference_seed()),
    };
    let ended = render.advance(&mut state, budget, stop, &OfReference(observer));
    if ended == Ended::Interrupted {
        kept.reference = Some(state);
        folder.keep(kept)?;
        return Ok(None);
    }
    let film = state.film();
    let options = ExrOptions {
        variance: film.variance(),
        ..ExrOptions::default()
    };
    write_exr(&folder.reference(), &film.image(), &options)?;
    write_png(&folder.reference().with_extension("png"), &film.image())?;
    kept.reference_cost = Some(ReferenceCost {
        seconds: state.duration().as_secs_f64(),
        samples_per_pixel: state.statistics().camera_paths as f64 / size.pixels() as f64,
    });
    folder.keep(kept)?;
    Ok(Some(Reference::from_file(&folder.reference(), size)?))
}
