//! One, four or eight wavelengths a path: the same image, with less and less colour noise.

mod support;

use std::sync::Arc;

use cohort::render::{ColourMode, Settings, WavelengthCount};
use cohort::scene::{LoadOptions, Scene};

use support::estimate::sidak_threshold;
use support::files;
use support::render::replicates;
use support::replicates::Replicates;

/// The mean over all pixels of the variance of red minus green between images, which a grey noise does not have.
fn colour_noise(images: &Replicates) -> f64 {
    let count = images.count() as f64;
    let pixels = images.size.pixels();
    let difference =
        |image: &[[f32; 3]], pixel: usize| f64::from(image[pixel][0] - image[pixel][1]);
    let variance = |pixel: usize| {
        let mean = images.images().map(|i| difference(i, pixel)).sum::<f64>() / count;
        let squares = images
            .images()
            .map(|i| (difference(i, pixel) - mean).powi(2));
        squares.sum::<f64>() / (count - 1.0)
    };
    (0..pixels).map(variance).sum::<f64>() / pixels as f64
}

#[test]
fn more_wavelengths_are_the_same_image_with_less_colour_noise() {
    let options = LoadOptions {
        definitions: vec![("size".into(), "24".into())],
        models: None,
    };
    let path = files::of_project("tests/scenes/colours.xml");
    let scene = Arc::new(Scene::load(path, &options).expect("the scene can be loaded"));
    let with = |count, seeds| {
        let settings = Settings {
            colour: ColourMode::Spectral(count),
            ..Settings::default()
        };
        replicates(&scene, settings, seeds, 32)
    };
    let images = [
        with(WavelengthCount::One, 0..24),
        with(WavelengthCount::Four, 24..48),
        with(WavelengthCount::Eight, 48..72),
    ];
    for (first, second) in [(0, 1), (0, 2), (1, 2)] {
        let (a, b) = (images[first].blocks(8), images[second].blocks(8));
        let blocks = a.iter().flatten().zip(b.iter().flatten());
        let limit = sidak_threshold(1e-3, 3 * blocks.clone().count());
        for (index, (a, b)) in blocks.enumerate() {
            let z = a.z_of_difference(b);
            assert!(z.abs() < limit, "block {index}: {a:?} {b:?}, z = {z}");
        }
    }
    let [one, four, eight] = images.each_ref().map(colour_noise);
    println!("colour noise: {one}, {four}, {eight}");
    assert!(eight < four && four < 0.5 * one, "{one}, {four}, {eight}");
}
