//! After its first batch, a thread traces without asking for memory.

use std::alloc::System;
use std::error::Error;
use std::sync::Arc;

use cohort::film::{Film, FilmSums};
use cohort::render::{Render, Settings};
use cohort::sampling::{SamplerKind, StreamKey};
use cohort::scene::{LoadOptions, Scene};
use cohort::spectrum::{Rgb, Spectral};
use cohort::transport::{TileJob, TraceBatches, Tracer};
use cohort::walk::{StrategyKind, StrategyOptions};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};

/// Counts every allocation of this program, but for those inside Embree.
#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Not under the test harness, whose own thread allocates beside.
fn main() -> Result<(), Box<dyn Error>> {
    // Once: the threads that make the mesh put their own things in order afterwards.
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
                    };
                    let region = Region::new(ALLOCATOR);
                    tracer.trace(render.engine(), &job, &mut film.tiles_mut()[0]);
                    let change = region.change();
                    allocations.push(change.allocations + change.reallocations);
                }
                println!("{kind}, {sampler}: {allocations:?}");
                assert!(allocations[0] > 0, "nothing was counted");
                assert_eq!(allocations[1..], [0; 3], "{kind}, {sampler}");
            }
        }
    }
    Ok(())
}
