//! The same scene looks the same whichever Embree renders it.
//!
//! `scripts/test-debian13.sh` runs this test on two systems with `COHORT_EXCHANGE` naming one folder: each leaves its
//! images there under the name of its Embree, and compares them with those that it finds.

mod support;

use std::path::Path;
use std::sync::Arc;

use cohort::embree;
use cohort::scene::{ImageSize, LoadOptions, Scene};
use cohort::{ExrOptions, Image, Settings, read_exr, write_exr};

use support::comparison::Comparison;
use support::files::say_skipped;
use support::render::replicates;
use support::replicates::Replicates;

const SIDE: i64 = 64;
const IMAGES: u64 = 12;
const SAMPLES: u32 = 32;

#[test]
fn images_agree_across_versions_of_embree() {
    let Some(folder) = std::env::var_os("COHORT_EXCHANGE") else {
        say_skipped(
            "the comparison across versions of Embree",
            "COHORT_EXCHANGE names no folder",
        );
        return;
    };
    let folder = Path::new(&folder);
    let version = embree::version().expect("Embree works");
    let mut scene = Scene::built_in(&LoadOptions::default()).expect("the built-in scene loads");
    scene.film = scene
        .film
        .resized(SIDE, SIDE)
        .expect("the size is possible");
    let size = scene.film.size;
    let scene = Arc::new(scene);
    // The seeds differ from version to version, so that the noise is independent.
    let first = u64::from(version.major) * IMAGES;
    let ours = replicates(&scene, Settings::default(), first..first + IMAGES, SAMPLES);
    for (index, pixels) in ours.images().enumerate() {
        let mut image = Image::black(size);
        for (place, &pixel) in pixels.iter().enumerate() {
            *image.pixel_mut(place as u32 % size.width, place as u32 / size.width) = pixel;
        }
        let path = folder.join(format!("embree-{version}-{index}.exr"));
        write_exr(&path, &image, &ExrOptions::default()).expect("the folder can be written");
    }
    let theirs = other_images(folder, &format!("embree-{version}-"), size);
    if theirs.count() < 2 {
        say_skipped("the comparison", "no other Embree has left its images yet");
        return;
    }
    Comparison::new(format!("Embree {version} and another"), &ours, &theirs, 8).assert();
}

fn other_images(folder: &Path, own_prefix: &str, size: ImageSize) -> Replicates {
    let mut images = Replicates::new(size);
    for entry in std::fs::read_dir(folder).expect("the folder can be read") {
        let path = entry.expect("the folder can be read").path();
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        if name.starts_with("embree-") && !name.starts_with(own_prefix) {
            images.push(read_exr(&path).expect("an image").pixels().to_vec());
        }
    }
    images
}
