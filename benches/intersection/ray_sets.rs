//! The rays: recorded from batches of a real render, tiles all over the image.

use std::error::Error;
use std::num::NonZeroUsize;
use std::sync::Arc;

use cohort::embree::Rays;
use cohort::film::Film;
use cohort::learning::Reliance;
use cohort::sampling::StreamKey;
use cohort::spectrum::Spectral;
use cohort::transport::{PathCounts, RecordedRays, TileJob, Tracer};
use cohort::{Render, Scene, Settings};

use crate::calls::Query;

/// Rays of a stretch: consecutive ones of the engine's streams, and the length of the stream calls.
pub const STRETCH: usize = 1024;

/// Camera paths per pixel of a batch: those of a full pass.
const SAMPLES: u32 = 16;

/// Rays of one kind.
pub struct RaySet {
    pub name: &'static str,
    /// What is asked about them.
    pub query: Query,
    /// [`STRETCH`] rays each, from different tiles.
    pub stretches: Vec<Rays>,
}

/// Where the rays of a kind are in what was recorded of a batch; `None` when no path got that far.
type Find = fn(&RecordedRays) -> Option<&Rays>;

const KINDS: [(&str, Query, Find); 6] = [
    ("primary", Query::Nearest, |batch| batch.segments.first()),
    ("bounce 1", Query::Nearest, |batch| batch.segments.get(1)),
    ("bounce 2", Query::Nearest, |batch| batch.segments.get(2)),
    ("bounce 4", Query::Nearest, |batch| batch.segments.get(4)),
    ("shadow 1", Query::Occluded, |batch| batch.shadows.first()),
    ("shadow 2", Query::Occluded, |batch| batch.shadows.get(1)),
];

/// Renders tiles at `stretches` places of the image and takes a stretch of each kind of rays from each place.
pub fn record(scene: &Arc<Scene>, stretches: usize) -> Result<Vec<RaySet>, Box<dyn Error>> {
    let settings = Settings {
        threads: NonZeroUsize::MIN,
        ..Settings::default()
    };
    let (seed, sums) = (settings.seed, settings.film_sums);
    let render = Render::new(scene.clone(), settings)?;
    let mut film = Film::new(scene.film.crop.size, sums);
    let mut tracer = Tracer::<Spectral<4>>::default();
    let tiles = film.tiles().len();
    let mut record = |tile: usize| {
        let key = StreamKey {
            seed,
            tile: tile as u32,
            pass: 0,
        };
        let job = TileJob {
            key,
            counts: PathCounts::Even(SAMPLES),
            weight: f64::from(SAMPLES),
            knowledge: None,
            learns: false,
            reliance: Reliance::ALL,
        };
        tracer.record(render.engine(), &job, &mut film.tiles_mut()[tile])
    };

    let mut sets = KINDS.map(|(name, query, _)| RaySet {
        name,
        query,
        stretches: Vec::new(),
    });
    for place in 0..stretches {
        let first = (2 * place + 1) * tiles / (2 * stretches);
        let mut parts: [Vec<Ray>; KINDS.len()] = Default::default();
        // Where one tile has too few rays of a kind, the tiles after it add theirs.
        for tile in 0..tiles {
            if parts.iter().all(|part| part.len() == STRETCH) {
                break;
            }
            let batch = record((first + tile) % tiles);
            for (part, (_, _, find)) in parts.iter_mut().zip(KINDS) {
                let missing = STRETCH - part.len();
                part.extend(find(&batch).into_iter().flat_map(rays_of).take(missing));
            }
        }
        for (set, part) in sets.iter_mut().zip(parts) {
            if part.len() < STRETCH {
                return Err(format!("{} has too few rays: {}", scene.name, set.name).into());
            }
            set.stretches.push(stream(&part));
        }
    }
    Ok(sets.into())
}

/// Origin, direction, tnear and tfar.
type Ray = ([f32; 3], [f32; 3], f32, f32);

fn rays_of(rays: &Rays) -> impl Iterator<Item = Ray> {
    (0..rays.len()).map(|i| {
        (
            rays.origin(i),
            rays.direction(i),
            rays.tnear(i),
            rays.tfar(i),
        )
    })
}

fn stream(rays: &[Ray]) -> Rays {
    let mut stream = Rays::new();
    stream.resize(rays.len());
    for (i, &(origin, direction, tnear, tfar)) in rays.iter().enumerate() {
        stream.set(i, origin, direction, tnear, tfar);
    }
    stream
}
