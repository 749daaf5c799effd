//! After its first batch, a thread traces without asking for memory.

use std::error::Error;
use std::num::NonZeroU32;
use std::sync::Arc;

use cohort::film::{Film, FilmSums};
use cohort::learning::{Gathering, Knowledge, Reliance};
use cohort::render::{Render, Settings};
use cohort::sampling::{SamplerKind, StreamKey};
use cohort::scene::{LoadOptions, Scene};
use cohort::spectrum::{Rgb, Spectral};
use cohort::transport::{PathCounts, TileJob, TraceBatches, Tracer};
use cohort::walk::{StrategyKind, StrategyOptions};

/// Counts the allocations of this thread, but for those inside Embree: threads that made the mesh, and that of the test harness, put
/// their own things in order beside.
#[test]
fn a_thread_traces_without_asking_for_memory() -> Result<(), Box<dyn Error>> {
    let scene = scene()?;
    for kind in StrategyKind::ALL {
        for sampler in SamplerKind::ALL {
            let render = render(&scene, kind, sampler)?;
            for mut tracer in tracers() {
                let what = format!("{kind}, {sampler}");
                check(&render, &mut *tracer, None, 1, &what);
            }
        }
    }
    Ok(())
}

/// Nor does one whose directions are guided, once the lessons are over.
#[test]
fn a_guided_thread_traces_without_asking_for_memory() -> Result<(), Box<dyn Error>> {
    let scene = scene()?;
    for kind in [StrategyKind::Roulette, StrategyKind::ParticleFilter] {
        for sampler in SamplerKind::ALL {
            let render = render(&scene, kind, sampler)?;
            for mut teacher in tracers() {
                let knowledge = lesson(&render, &mut *teacher);
                for mut tracer in tracers() {
                    let what = format!("guided {kind}, {sampler}");
                    // Weights vary, and populations with them.
                    check(&render, &mut *tracer, Some(&knowledge), 4, &what);
                }
                // What recorded the lesson has room for more than it needs now.
                let mut film = Film::new(scene.film.crop.size, FilmSums::default());
                let tile = &mut film.tiles_mut()[0];
                let job = job(9, Some(&knowledge));
                teacher.trace(render.engine(), &job, tile);
                let trace = || teacher.trace(render.engine(), &job, tile);
                let allocations = allocation_counter::measure(trace).count_total;
                assert_eq!(allocations, 0, "{kind}, {sampler}, after a lesson");
            }
        }
    }
    Ok(())
}

fn scene() -> Result<Arc<Scene>, Box<dyn Error>> {
    Ok(Arc::new(Scene::built_in(&LoadOptions {
        definitions: vec![("res".into(), "32".into())],
        ..LoadOptions::default()
    })?))
}

fn render(
    scene: &Arc<Scene>,
    kind: StrategyKind,
    sampler: SamplerKind,
) -> Result<Render, Box<dyn Error>> {
    let settings = Settings {
        strategy: kind.build(&StrategyOptions::default())?,
        sampler,
        // For the strategy that never ends a path.
        max_depth: NonZeroU32::new(12),
        ..Settings::default()
    };
    Ok(Render::new(Arc::clone(scene), settings)?)
}

fn tracers() -> [Box<dyn TraceBatches>; 2] {
    [
        Box::<Tracer<Rgb>>::default(),
        Box::<Tracer<Spectral<4>>>::default(),
    ]
}

/// A pass of the first tile.
fn job(pass: u32, knowledge: Option<&Knowledge>) -> TileJob<'_> {
    TileJob {
        key: StreamKey {
            seed: 1,
            tile: 0,
            pass,
        },
        counts: PathCounts::Even(16),
        weight: 16.0,
        knowledge,
        learns: false,
        reliance: Reliance::ALL,
    }
}

/// What is learned from one batch.
fn lesson(render: &Render, tracer: &mut dyn TraceBatches) -> Knowledge {
    let size = render.engine().scene().film.crop.size;
    let mut film = Film::new(size, FilmSums::default());
    let mut knowledge = Knowledge::nothing(render.engine().bounds(), size);
    let mut gathering = Gathering::new(knowledge.take_experience(), 0);
    let job = TileJob {
        learns: true,
        reliance: Reliance::ALL,
        ..job(8, Some(&knowledge))
    };
    tracer.trace(render.engine(), &job, &mut film.tiles_mut()[0]);
    let observations = tracer.take_observations();
    assert!(!observations.segments.is_empty(), "nothing was observed");
    gathering.add(0, observations);
    knowledge.give_back(gathering.into_experience());
    knowledge.learn();
    knowledge
}

/// Traces batches, and checks that only the `first` of them ask for memory.
fn check(
    render: &Render,
    tracer: &mut dyn TraceBatches,
    knowledge: Option<&Knowledge>,
    first: u32,
    what: &str,
) {
    let size = render.engine().scene().film.crop.size;
    let mut film = Film::new(size, FilmSums::default());
    let mut allocations = Vec::with_capacity(16);
    for pass in 0..first + 3 {
        let tile = &mut film.tiles_mut()[0];
        let job = job(pass, knowledge);
        let trace = || tracer.trace(render.engine(), &job, tile);
        allocations.push(allocation_counter::measure(trace).count_total);
    }
    println!("{what}: {allocations:?}");
    assert!(allocations[0] > 0, "nothing was counted");
    assert_eq!(allocations[first as usize..], [0; 3], "{what}");
}
