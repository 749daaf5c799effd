//! Scenes of Mitsuba's own render test suite, by the rules of that suite.
//!
//! `COHORT_SUITE` names the folder with its `scenes/` and `tests/scenes/`. Scenes that use plugins which Cohort does not
//! have are skipped, with the reason.

mod support;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use cohort::film::{Image, read_exr};
use cohort::render::{ColourMode, Settings, WavelengthCount};
use cohort::scene::{LoadOptions, Scene};

use support::comparison::Comparison;
use support::estimate::{Estimate, sidak_threshold};
use support::files;
use support::mitsuba::{Mitsuba, Reference};
use support::render::{replicates, replicates_with_rare_highlights};

/// The variable that names the suite.
const SUITE: &str = "COHORT_SUITE";

const COLOURS: [(ColourMode, &str); 2] = [
    (ColourMode::Rgb, "rgb"),
    (ColourMode::Spectral(WavelengthCount::Four), "spectral"),
];

/// The suite, or `None` after saying that `what` is skipped.
fn suite(what: &str) -> Option<PathBuf> {
    let folder = std::env::var_os(SUITE).map(PathBuf::from);
    if folder.is_none() {
        files::say_skipped(what, &format!("{SUITE} does not name a folder"));
    }
    folder
}

/// Loads a scene, or says why it is skipped.
fn load(path: &Path, definitions: &[(String, String)]) -> Option<Arc<Scene>> {
    let options = LoadOptions {
        definitions: definitions.to_vec(),
        models: None,
    };
    match Scene::load(path, &options) {
        Ok(scene) => Some(Arc::new(scene)),
        Err(error) => {
            let reason = error.to_string();
            assert!(
                reason.contains("support"),
                "{}: not loaded, for another reason than a plugin that is not supported: {reason}",
                path.display()
            );
            files::say_skipped(&path.display().to_string(), &reason.replace('\n', " "));
            None
        }
    }
}

/// All files below `folder` that end like this, in order.
fn files_below(folder: &Path, ends_with: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder)
            .unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
        for entry in entries {
            let path = entry.expect("the folder can be read").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.to_string_lossy().ends_with(ends_with) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

#[test]
fn cornell_boxes() {
    let Some(suite) = suite("the Cornell boxes of Mitsuba's suite") else {
        return;
    };
    let folder = suite.join("scenes/cbox");
    let mut inputs = files_below(&folder, ".xml");
    inputs.extend(files_below(&folder, ".obj"));
    for (file, colour) in [
        ("cbox-rgb.xml", ColourMode::Rgb),
        ("cbox-spectral.xml", ColourMode::default()),
    ] {
        let path = folder.join(file);
        let Some(mitsuba) = Mitsuba::find(file) else {
            return;
        };
        let definitions = [("res".to_owned(), "64".to_owned())];
        let Some(scene) = load(&path, &definitions) else {
            continue;
        };
        let reference = Reference {
            scene: &path,
            inputs: &inputs,
            definitions: &definitions,
            colour,
            max_depth: None,
            seeds: 48,
            spp: 32,
        };
        let reference = mitsuba.render(&reference, scene.film.crop.size);
        let settings = Settings {
            colour,
            ..Settings::default()
        };
        let ours = replicates(&scene, settings, 0..24, 20);
        Comparison::new(file, &ours, &reference, 4).assert();
    }
}

/// A photographed sky and serialized meshes, with surfaces that are diffuse.
#[test]
fn material_preview() {
    let Some(suite) = suite("the material preview of Mitsuba's suite") else {
        return;
    };
    let path = files::of_project("tests/scenes/preview.xml");
    let folder = suite.join("scenes/matpreview");
    let inputs = [
        folder.join("envmap.exr"),
        folder.join("matpreview.serialized"),
    ];
    let definitions = [("suite".to_owned(), suite.display().to_string())];
    for (colour, name) in COLOURS {
        let Some(mitsuba) = Mitsuba::find("the material preview") else {
            return;
        };
        let Some(scene) = load(&path, &definitions) else {
            return;
        };
        let reference = Reference {
            scene: &path,
            inputs: &inputs,
            definitions: &definitions,
            colour,
            max_depth: None,
            seeds: 24,
            spp: 32,
        };
        let reference = mitsuba.render(&reference, scene.film.crop.size);
        let settings = Settings {
            colour,
            ..Settings::default()
        };
        let ours = replicates(&scene, settings, 0..24, 20);
        let what = format!("material preview, {name}");
        Comparison::new(what, &ours, &reference, 4).assert();
    }
}

/// Every scene whose plugins we have, against the image that comes with it.
#[test]
fn scenes_with_their_own_references() {
    let Some(suite) = suite("the scenes of Mitsuba's suite") else {
        return;
    };
    let scenes = files_below(&suite.join("tests/scenes"), ".xml");
    assert!(!scenes.is_empty(), "{SUITE} has no tests/scenes");
    for path in scenes.iter().filter(|path| is_scene(path)) {
        let Some(scene) = load(path, &[]) else {
            continue;
        };
        for (colour, name) in COLOURS {
            let settings = Settings {
                colour,
                ..Settings::default()
            };
            let spp = scene.sampler.sample_count;
            let ours = replicates_with_rare_highlights(&scene, settings, 0..8, spp.div_ceil(8));
            let reference = |suffix: &str| {
                let file = reference_file(path, &format!("{name}{suffix}"));
                read_exr(&file).unwrap_or_else(|error| panic!("{error}"))
            };
            check_by_the_suites_rule(
                path,
                &ours.blocks(1),
                &reference(""),
                &reference("_var"),
                spp,
            );
        }
    }
}

/// Fragments that are included by scenes are no scenes.
fn is_scene(path: &Path) -> bool {
    !path
        .iter()
        .any(|part| part == "fragments" || part == "include")
}

/// `test_NAME_INTEGRATOR.xml` has its references at `refs/test_NAME_ref_….exr`.
fn reference_file(scene: &Path, what: &str) -> PathBuf {
    let stem = scene
        .file_stem()
        .expect("a scene has a name")
        .to_string_lossy();
    let name = stem
        .rsplit_once('_')
        .map_or(&*stem, |(name, _integrator)| name);
    scene
        .with_file_name("refs")
        .join(format!("{name}_ref_{what}.exr"))
}

/// The variance that the suite gives pixels of its references whose second moment, rounded, left them less.
const LEAST_VARIANCE: f64 = 1e-4;

/// z-tests of all pixels and channels; 99.75 % must pass at the corrected threshold.
fn check_by_the_suites_rule(
    scene: &Path,
    ours: &[Vec<Estimate>; 3],
    reference: &Image,
    variance: &Image,
    spp: u32,
) {
    let threshold = sidak_threshold(0.01, 3 * ours[0].len());
    let mut passing = 0;
    for (channel, pixels) in ours.iter().enumerate() {
        let expected = reference.pixels().iter().zip(variance.pixels());
        for (pixel, (mean, variance)) in pixels.iter().zip(expected) {
            let expected = Estimate {
                mean: f64::from(mean[channel]),
                variance: f64::from(variance[channel]).max(LEAST_VARIANCE) / f64::from(spp),
                count: spp as usize,
            };
            passing += usize::from(pixel.z_of_difference(&expected).abs() <= threshold);
        }
    }
    let share = passing as f64 / (3 * ours[0].len()) as f64;
    println!("{}: {:.3} % pass", scene.display(), 100.0 * share);
    assert!(
        share >= 0.9975,
        "{}: only {:.3} % of the pixels pass",
        scene.display(),
        100.0 * share
    );
}
