//! After its first batch, a thread traces without asking for memory.

use std::error::Error;
use std::sync::Arc;

use cohort::film::{Film, FilmSums};
use cohort::render::{Render, Settings};
use cohort::sampling::{SamplerKind, StreamKey};
use cohort::scene::{LoadOptions, Scene};
use cohort::spectrum::{Rgb, Spectral};
use cohort::transport::{TileJob, TraceBatches, Tracer};
use cohort::walk::{StrategyKind, StrategyOptions};

/// Counts the allocations of this thread, but for those inside Embree: threads that made the mesh, and that of the test harness, put
/// their own things in order beside.
#[test]
fn a_thread_traces_without_asking_for_memory() -> Result<(), Box<dyn Error>> {
    let scene = Arc::new(Scene::built_in(&LoadOptions {
        definitions: vec![("res".into(), "32".into())],
        ..LoadOptions::default()
    })?);
    let size = scene.film.crop.size;
    for kind in StrategyKind::ALL {
        for sampler in SamplerKind::ALL {
            let settings = Settings {
                strategy: kind.build(&StrategyOptions::default())?,
                sampler,
                // For the strategy that never ends a path.
                max_depth: std::num::NonZeroU32::new(12),
                ..Settings::default()
            };
            let render = Render::new(Arc::clone(&scene), settings)?;
            let tracers: [Box<dyn TraceBatches>; 2] = [
                Box::<Tracer<Rgb>>::default(),
                Box::<Tracer<Spectral<4>>>::default(),
            ];
            for mut tracer in tracers {
                let mut film = Film::new(size, FilmSums::default());
                let mut allocations = Vec::with_capacity(4);
                for pass in 0..4 {
                    let job = TileJob {
                        key: StreamKey {
                            seed: 1,
                            tile: 0,
                            pass,
                        },
                        first_sample: u64::from(pass) * 16,
                        samples: 16,
                        knowledge: None,
                        learns: false,
                    };
                    let tile = &mut film.tiles_mut()[0];
                    let trace = || tracer.trace(render.engine(), &job, tile);
                    allocations.push(allocation_counter::measure(trace).count_total);
                }
                println!("{kind}, {sampler}: {allocations:?}");
                assert!(allocations[0] > 0, "nothing was counted");
                assert_eq!(allocations[1..], [0; 3], "{kind}, {sampler}");
            }
        }
    }
    Ok(())
}
