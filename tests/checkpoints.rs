//! A render that is kept in a file goes on from there as if nothing had interrupted it.

mod support;

use std::fs;
use std::num::{NonZeroU32, NonZeroU64, NonZeroUsize};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use cohort::render::{
    Budget, Checkpoint, CheckpointError, Ended, Observer, Outcome, Progress, Render, Settings,
    StopFlag,
};
use cohort::sampling::SamplerKind;

use support::render::many_emitters;

const SCENE_TEXT: &[u8] = b"many emitters";

fn rays(count: u64) -> Budget {
    Budget::Rays(NonZeroU64::new(count).expect("there are rays"))
}

/// A render that learns and has sequences, with a budget and with changes of its settings.
fn prepared(budget: Budget, change: impl FnOnce(&mut Settings)) -> Render {
    let mut settings = Settings {
        budget,
        threads: NonZeroUsize::MIN,
        sampler: SamplerKind::ArrayQmc,
        guiding: true,
        adaptive: true,
        ..Settings::default()
    };
    change(&mut settings);
    Render::new(many_emitters(24), settings).expect("the scene can be rendered")
}

fn go_on(path: &Path, render: &Render) -> Outcome {
    let (checkpoint, state) =
        Checkpoint::open(path, render, SCENE_TEXT).expect("it is the same render");
    let kept = checkpoint.run(render, state, &StopFlag::new(), &());
    kept.kept.expect("it can be kept");
    kept.outcome
}

fn file(folder: &tempfile::TempDir) -> PathBuf {
    folder.path().join("render.checkpoint")
}

#[test]
fn a_render_goes_on_from_its_file() {
    let folder = tempfile::tempdir().expect("there is a place for files");
    let path = file(&folder);
    let mut outcome = go_on(&path, &prepared(rays(40_000), |_| ()));
    for budget in [41_000, 200_000] {
        let render = prepared(rays(budget), |_| ());
        let (_, state) = Checkpoint::open(&path, &render, SCENE_TEXT).expect("it is the same");
        assert!(state.film() == &outcome.film && state.duration() == outcome.duration);
        outcome = go_on(&path, &render);
    }
    let at_once = prepared(rays(200_000), |_| ()).run(&StopFlag::new(), &());
    assert_eq!(outcome.ended, Ended::OutOfRays);
    assert_eq!(outcome.statistics.all_rays(), at_once.statistics.all_rays());
    assert!(outcome.film == at_once.film, "the image is another");
    // Done already.
    let again = go_on(&path, &prepared(rays(200_000), |_| ()));
    assert!(again.film == outcome.film, "the image is another");
}

#[test]
fn a_larger_number_of_samples_goes_on_with_a_render_that_is_done() {
    let spp = |samples| Budget::SamplesPerPixel(NonZeroU32::new(samples).expect("not zero"));
    let folder = tempfile::tempdir().expect("there is a place for files");
    let path = file(&folder);
    let small = go_on(
        &path,
        &prepared(spp(8), |settings| settings.adaptive = false),
    );
    let larger = go_on(
        &path,
        &prepared(spp(64), |settings| settings.adaptive = false),
    );
    assert_eq!(larger.ended, Ended::Complete);
    assert!(larger.film.pixels().all(|pixel| pixel.samples == 64));
    assert!(larger.statistics.all_rays() > 4 * small.statistics.all_rays());
}

#[test]
fn another_render_is_refused() {
    let folder = tempfile::tempdir().expect("there is a place for files");
    let path = file(&folder);
    go_on(&path, &prepared(rays(10_000), |_| ()));
    let refuses = |change: fn(&mut Settings), text: &[u8]| {
        let render = prepared(rays(10_000), change);
        match Checkpoint::open(&path, &render, text) {
            Err(CheckpointError::AnotherRender(refused)) => refused == path,
            _ => false,
        }
    };
    assert!(refuses(|settings| settings.seed += 1, SCENE_TEXT));
    assert!(refuses(|settings| settings.guiding = false, SCENE_TEXT));
    assert!(refuses(|_| (), b"another scene"));
    let two = NonZeroUsize::new(2).expect("two is not zero");
    let render = prepared(rays(10_000), |settings| settings.threads = two);
    assert!(Checkpoint::open(&path, &render, SCENE_TEXT).is_ok());
}

#[test]
fn a_damaged_file_is_refused() {
    let folder = tempfile::tempdir().expect("there is a place for files");
    let path = file(&folder);
    let render = prepared(rays(10_000), |_| ());
    go_on(&path, &render);
    let whole = fs::read(&path).expect("it was kept");
    for place in [0, 1, 70, whole.len() / 2, whole.len() - 1] {
        let mut damaged = whole.clone();
        damaged[place] ^= 4;
        fs::write(&path, damaged).expect("it can be written");
        let error = Checkpoint::open(&path, &render, SCENE_TEXT).expect_err("it is damaged");
        assert!(error.to_string().contains("damaged"), "{error}");
    }
}

/// Looks whether there is a file while a render is under way.
struct Looks<'p> {
    path: &'p Path,
    has_seen: AtomicBool,
}

impl Observer for Looks<'_> {
    fn progress(&self, _progress: &Progress) {
        self.has_seen
            .fetch_or(self.path.exists(), Ordering::Relaxed);
    }
}

#[test]
fn it_is_kept_while_it_is_under_way() {
    let folder = tempfile::tempdir().expect("there is a place for files");
    let path = file(&folder);
    let render = prepared(Budget::Time(Duration::from_secs(2)), |_| ());
    let (checkpoint, state) =
        Checkpoint::open(&path, &render, SCENE_TEXT).expect("there is no other render");
    let looks = Looks {
        path: &path,
        has_seen: AtomicBool::new(false),
    };
    let checkpoint = checkpoint.every(Duration::from_millis(1));
    let kept = checkpoint.run(&render, state, &StopFlag::new(), &looks);
    assert_eq!(kept.outcome.ended, Ended::OutOfTime);
    assert!(looks.has_seen.into_inner(), "nothing was kept on the way");
}
