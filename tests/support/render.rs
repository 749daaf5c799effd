//! Rendering a scene many times.

use std::num::NonZeroU32;
use std::sync::Arc;
use std::time::Duration;

use cohort::render::{Budget, Render, Settings, StopFlag};
use cohort::scene::{LoadOptions, Scene};

use super::files;
use super::replicates::Replicates;

/// `tests/scenes/many-emitters.xml` of `side` x `side` pixels: several lights, shapes of all kinds.
pub fn many_emitters(side: u32) -> Arc<Scene> {
    let options = LoadOptions {
        definitions: vec![("size".into(), side.to_string())],
        models: None,
    };
    let path = files::of_project("tests/scenes/many-emitters.xml");
    Arc::new(Scene::load(path, &options).expect("the scene can be loaded"))
}

/// Renders with `settings` one image for each of `seeds`, with `spp` samples per pixel.
///
/// On the way it proves of every image that no sample was dropped, and, if there are samples enough for the film to
/// know the noise of its pixels, that this is the noise which the images do have.
pub fn replicates(
    scene: &Arc<Scene>,
    settings: Settings,
    seeds: std::ops::Range<u64>,
    spp: u32,
) -> Replicates {
    let what = format!("{} {:?}", scene.name, settings.strategy);
    let (replicates, believed) = render_all(scene, in_full_passes(settings, spp), seeds, spp);
    if let Some(believed) = believed {
        check_believed_noise(&what, &replicates, believed);
    }
    replicates
}

/// As [`replicates`], for scenes whose noise is made by samples so rare and bright, such as highlights of a point on polished
/// surfaces, that a few images do not tell how large it is.
#[allow(dead_code)]
pub fn replicates_with_rare_highlights(
    scene: &Arc<Scene>,
    settings: Settings,
    seeds: std::ops::Range<u64>,
    spp: u32,
) -> Replicates {
    render_all(scene, in_full_passes(settings, spp), seeds, spp).0
}

/// As [`replicates_with_rare_highlights`], in growing passes of 1, 1, 2, 4, 8 … samples: a render that learns does so after each, so that a few
/// samples are enough to see what becomes of what it has learned.
#[allow(dead_code)]
pub fn replicates_in_growing_passes(
    scene: &Arc<Scene>,
    settings: Settings,
    seeds: std::ops::Range<u64>,
    spp: u32,
) -> Replicates {
    let budget = Budget::Time(Duration::MAX);
    let settings = Settings { budget, ..settings };
    render_all(scene, settings, seeds, spp).0
}

fn in_full_passes(settings: Settings, spp: u32) -> Settings {
    let budget = samples_per_pixel(spp);
    Settings { budget, ..settings }
}

fn samples_per_pixel(spp: u32) -> Budget {
    Budget::SamplesPerPixel(NonZeroU32::new(spp).expect("there are samples"))
}

/// The images, and the mean variance of a pixel in three channels that their films believe in.
fn render_all(
    scene: &Arc<Scene>,
    settings: Settings,
    seeds: std::ops::Range<u64>,
    spp: u32,
) -> (Replicates, Option<[f64; 3]>) {
    let what = format!("{} {:?}", scene.name, settings.strategy);
    let render = Render::new(Arc::clone(scene), settings).expect("the scene can be rendered");
    let mut replicates = Replicates::new(scene.film.crop.size);
    let mut believed = Some([0.0; 3]);
    let count = (seeds.end - seeds.start) as f64;
    for seed in seeds {
        let mut state = render.start(seed);
        let until = samples_per_pixel(spp);
        let ended = render.advance(&mut state, until, &StopFlag::new(), &());
        let outcome = state.into_outcome(ended);
        assert_eq!(
            (
                outcome.statistics.dropped.total(),
                outcome.statistics.walk.dropped()
            ),
            (0, 0),
            "{what}: dropped samples: {:?} {:?}",
            outcome.statistics.dropped,
            outcome.statistics.walk
        );
        if let (Some(sum), Some(variance)) = (&mut believed, outcome.film.variance()) {
            let mean = variance.mean();
            (0..3).for_each(|channel| sum[channel] += mean[channel] / count);
        } else {
            believed = None;
        }
        replicates.push(outcome.film.image().pixels().to_vec());
    }
    (replicates, believed)
}

/// Where all samples are the same but for single-precision rounding, their noise is not random: this share of the
/// squared mean does not count.
const ROUNDING: f64 = 1e-8;

/// Compares the variance of pixels that the film believed in, in the mean over the image, with the one between images.
fn check_believed_noise(what: &str, replicates: &Replicates, believed: [f64; 3]) {
    for (channel, pixels) in replicates.blocks(1).iter().enumerate() {
        let per_image = replicates.count() as f64;
        let seen = pixels
            .iter()
            .map(|pixel| pixel.variance * per_image)
            .sum::<f64>()
            / pixels.len() as f64;
        let mean = pixels.iter().map(|pixel| pixel.mean).sum::<f64>() / pixels.len() as f64;
        let ratio = believed[channel] / seen;
        // Of some thousand pixels and a dozen images or more; rare bright samples make up the rest.
        assert!(
            (0.8..1.25).contains(&ratio) || seen <= ROUNDING * mean * mean,
            "{what}: channel {channel}: the film says that the variance of a pixel is {}, and it is {seen}",
            believed[channel]
        );
    }
}
