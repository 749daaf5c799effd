//! How an image was made, in words.

use super::{Outcome, Render};
use crate::transport::DirectLight;

/// Everything needed to make the image again, and what making it took: name and value, for the attributes of an EXR.
pub fn metadata(render: &Render, outcome: &Outcome) -> Vec<(String, String)> {
    let settings = render.settings();
    let scene = render.engine().scene();
    let statistics = &outcome.statistics;
    let film = &outcome.film;
    let (fewest, most) = film.pixels().fold((u64::MAX, 0), |(low, high), pixel| {
        (low.min(pixel.samples), high.max(pixel.samples))
    });
    // Where they differ, the EXR has a channel with the number of each pixel.
    let samples = if fewest == most {
        format!("{most}")
    } else {
        format!("{fewest} to {most}")
    };
    let seconds = outcome.duration.as_secs_f64();
    let mut list = Vec::new();
    let mut add = |name: &str, value: String| list.push((format!("cohort:{name}"), value));
    add("version", env!("CARGO_PKG_VERSION").into());
    add("embree", render.engine().embree_version().to_string());
    add("cpu", processor_name());
    add("scene", scene.name.clone());
    for (name, value) in what_is_computed(render) {
        add(&name, value);
    }
    add("seed", outcome.seed.to_string());
    add("threads", settings.threads.to_string());
    add("samples", samples);
    add("ended", outcome.ended.name().into());
    add("seconds", format!("{seconds:.3}"));
    add(
        "build-seconds",
        format!("{:.3}", render.build_time().as_secs_f64()),
    );
    add("rays", statistics.all_rays().to_string());
    add("camera-paths", statistics.camera_paths.to_string());
    add(
        "intersection-share",
        format!("{:.3}", statistics.intersection_share()),
    );
    if let Some(reliance) = outcome.reliance {
        add("relied-on", reliance.to_string());
    }
    add("longest-path", statistics.deepest.to_string());
    let dropped = statistics.dropped;
    add("dropped.nan", dropped.nan.to_string());
    add("dropped.infinite", dropped.infinite.to_string());
    add("dropped.negative", dropped.negative.to_string());
    add("dropped.endless-batches", dropped.endless.to_string());
    add("dropped.particles", statistics.walk.dropped().to_string());
    list
}

/// The settings that decide what a render computes and how well, without those that decide how much of it: name and
/// value.
pub fn what_is_computed(render: &Render) -> Vec<(String, String)> {
    let settings = render.settings();
    let strategy = render.engine().strategy();
    let max_depth = settings.max_depth.map(|depth| depth.get()).or(render
        .engine()
        .scene()
        .integrator
        .max_depth);
    let mut list = Vec::new();
    let mut add = |name: &str, value: String| list.push((name.to_owned(), value));
    add("strategy", strategy.name().into());
    for (name, value) in strategy.settings() {
        add(&format!("strategy.{name}"), value);
    }
    add("sampler", settings.sampler.to_string());
    add(
        "guiding",
        if settings.guiding { "on" } else { "off" }.to_owned(),
    );
    add(
        "adaptive",
        if settings.adaptive { "on" } else { "off" }.to_owned(),
    );
    add(
        "trial",
        if settings.trial { "on" } else { "off" }.to_owned(),
    );
    add("colour", settings.colour.name().into());
    add("film-sums", settings.film_sums.name().into());
    add(
        "direct-light",
        match settings.direct_light {
            DirectLight::NextEvent => "next-event".into(),
            DirectLight::Off => "off".into(),
        },
    );
    add(
        "max-depth",
        max_depth.map_or("unlimited".into(), |depth| depth.to_string()),
    );
    add("robust", settings.robust.to_string());
    add(
        "build-quality",
        format!("{:?}", settings.build_quality).to_lowercase(),
    );
    list
}

/// The processor's name, or the architecture where the system does not tell.
pub fn processor_name() -> String {
    let info = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info
        .lines()
        .find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or(std::env::consts::ARCH, |(_, name)| name.trim())
        .to_owned()
}
