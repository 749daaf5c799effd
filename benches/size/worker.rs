//! The process that measures one subject. It loads and builds, then renders whenever a line arrives on standard input,
//! and tells what it measured in lines of JSON.

use std::error::Error;
use std::io;
use std::num::{NonZeroU32, NonZeroUsize};
use std::time::Instant;

use cohort::{Budget, ExrOptions, LoadOptions, Render, Scene, Settings, StopFlag, write_exr};
use serde::{Deserialize, Serialize};

use super::memory;
use super::subject::Subject;

/// Told once the scene is ready.
#[derive(Serialize, Deserialize)]
pub struct Prepared {
    /// Resident memory that loading the scene added, in MiB.
    pub load_mib: f64,
    /// Seconds to build the acceleration structure.
    pub build_seconds: f64,
    /// Resident memory that it added, in MiB.
    pub bvh_mib: f64,
}

/// Told after each run.
#[derive(Serialize, Deserialize)]
pub struct Run {
    /// Seconds to render the image once, from an empty film to a full one.
    pub seconds: f64,
    /// Those of them that were spent inside Embree.
    pub embree_seconds: f64,
    /// The most resident memory of the process so far, in MiB.
    pub peak_mib: f64,
}

/// Serves until standard input ends.
pub fn serve(subject: &Subject) -> Result<(), Box<dyn Error>> {
    let at_start = memory::resident()?;
    let scene = Scene::built_in(&LoadOptions {
        definitions: vec![("res".into(), subject.side.to_string())],
        models: Some(subject.models.clone()),
    })?;
    let loaded = memory::resident()?;
    let samples = NonZeroU32::new(subject.samples).ok_or("a subject needs samples")?;
    let settings = Settings {
        budget: Budget::SamplesPerPixel(samples),
        threads: NonZeroUsize::MIN,
        ..Settings::default()
    };
    let render = Render::new(scene.into(), settings)?;
    let prepared = Prepared {
        load_mib: loaded - at_start,
        build_seconds: render.build_time().as_secs_f64(),
        bvh_mib: memory::resident()? - loaded,
    };
    println!("{}", serde_json::to_string(&prepared)?);

    let paths = subject.pixels() * u64::from(subject.samples);
    let repeats = subject.least_paths.div_ceil(paths);
    for line in io::stdin().lines() {
        line?;
        let start = Instant::now();
        let mut outcome = render.run(&StopFlag::new(), &());
        let mut in_embree = outcome.statistics.intersection_time;
        for _ in 1..repeats {
            outcome = render.run(&StopFlag::new(), &());
            in_embree += outcome.statistics.intersection_time;
        }
        let seconds = start.elapsed().as_secs_f64() / repeats as f64;
        // Not timed, but who renders has this memory to find as well.
        let image = outcome.film.image();
        write_exr(
            &subject.models.join("image.exr"),
            &image,
            &ExrOptions::default(),
        )?;
        let run = Run {
            seconds,
            embree_seconds: in_embree.as_secs_f64() / repeats as f64,
            peak_mib: memory::peak()?,
        };
        println!("{}", serde_json::to_string(&run)?);
    }
    Ok(())
}
