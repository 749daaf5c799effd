//! One repetition: competitors take turns until each has used its budget.

use std::time::{Duration, Instant};

use super::kept::{Kept, Record, StudyFolder, UnderWay};
use super::measures::errors;
use super::timeline::Turn;
use super::{Contender, StudyError, StudyObserver};
use crate::render::StopFlag;
use crate::study::reference::Reference;

/// How often what has been rendered is written down, for the case that the program is killed.
const KEEP_INTERVAL: Duration = Duration::from_secs(120);

/// What images are held against.
pub struct Judge<'a> {
    /// The truth, as far as it is known.
    pub reference: &'a Reference,
    /// Which pixels see a light directly.
    pub lit: &'a [bool],
    /// Whether to measure FLIP.
    pub flip: bool,
}

/// Goes on with the repetition that is under way in `kept`, or with one that the contenders have just begun. Returns whether it is complete:
/// otherwise `stop` was raised, and `kept` is written down.
///
/// # Errors
/// A contender fails, or the disk refuses.
pub fn race(
    contenders: &mut [Box<dyn Contender>],
    turns: &[Turn],
    judge: &Judge,
    folder: &StudyFolder,
    kept: &mut Kept,
    stop: &StopFlag,
    observer: &dyn StudyObserver,
) -> Result<bool, StudyError> {
    let repetition = kept.complete.len();
    let mut under_way = kept.under_way.take().unwrap_or_default();
    under_way.records.resize(contenders.len(), Vec::new());
    for (contender, state) in contenders.iter_mut().zip(under_way.states.drain(..)) {
        contender.restore(&state)?;
    }
    let mut last_kept = Instant::now();
    let first_turn = under_way.turn;
    for (index, turn) in turns.iter().enumerate().skip(first_turn) {
        under_way.turn = index;
        // Nobody is always the first after a snapshot, when caches are cold.
        let count = contenders.len();
        for place in 0..count {
            observer.turn(
                repetition,
                (index * count + place) as f64 / (turns.len() * count) as f64,
                (index + place) % count,
            );
            contenders[(index + place) % count].advance(turn.until, stop)?;
            if stop.is_raised() {
                keep(contenders, &mut under_way, folder, kept)?;
                return Ok(false);
            }
        }
        if turn.is_snapshot {
            for (contender, records) in contenders.iter().zip(&mut under_way.records) {
                records.push(Record {
                    standing: contender.standing(),
                    errors: errors(&contender.image(), judge.reference, judge.lit, judge.flip),
                });
            }
        }
        under_way.turn = index + 1;
        if last_kept.elapsed() >= KEEP_INTERVAL && index + 1 < turns.len() {
            keep(contenders, &mut under_way, folder, kept)?;
            last_kept = Instant::now();
        }
    }
    kept.complete.push(under_way.records);
    Ok(true)
}

/// Writes down how far everybody is; the bulk of it, the states, does not stay in memory.
fn keep(
    contenders: &[Box<dyn Contender>],
    under_way: &mut UnderWay,
    folder: &StudyFolder,
    kept: &mut Kept,
) -> Result<(), StudyError> {
    for contender in contenders {
        under_way.states.push(contender.save()?);
    }
    kept.under_way = Some(std::mem::take(under_way));
    folder.keep(kept)?;
    *under_way = kept.under_way.take().unwrap_or_default();
    under_way.states.clear();
    Ok(())
}
