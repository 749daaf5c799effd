//! Loads a scene file (or takes the built-in scene, smaller), renders it with progress, and writes an EXR and a PNG.
//!
//!     cargo run --release --example render_scene [SCENE.xml] [OUT.exr]

use std::error::Error;
use std::path::PathBuf;

use cohort::render::metadata;
use cohort::{
    Budget, ExrOptions, LoadOptions, Observer, Progress, Render, Scene, Settings, StopFlag,
    write_exr, write_png,
};

/// Prints how far the render is.
struct Printer;

impl Observer for Printer {
    fn progress(&self, progress: &Progress) {
        let percent = 100.0 * progress.share;
        eprintln!("{percent:3.0} %, {} rays", progress.rays);
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args_os().skip(1).map(PathBuf::from);
    let scene = match arguments.next() {
        Some(path) => Scene::load(path, &LoadOptions::default())?,
        None => Scene::built_in(&LoadOptions {
            definitions: vec![("res".into(), "128".into())],
            ..LoadOptions::default()
        })?,
    };
    let exr = arguments
        .next()
        .unwrap_or_else(|| std::env::temp_dir().join("render_scene.exr"));

    let settings = Settings {
        budget: Budget::SamplesPerPixel(32.try_into()?),
        ..Settings::default()
    };
    let render = Render::new(scene.into(), settings)?;
    let outcome = render.run(&StopFlag::new(), &Printer);

    let image = outcome.film.image();
    let options = ExrOptions {
        attributes: metadata(&render, &outcome),
        ..ExrOptions::default()
    };
    write_exr(&exr, &image, &options)?;
    write_png(&exr.with_extension("png"), &image)?;
    println!(
        "{} after {:.1} s",
        exr.display(),
        outcome.duration.as_secs_f64()
    );
    Ok(())
}
