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
use cohort::walk::{StrategyKind, StrategyOptions};

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

/// The settings of a render by a strategy with its defaults.
fn settings(colour: ColourMode, strategy: StrategyKind) -> Settings {
    Settings {
        colour,
        strategy: strategy
            .build(&StrategyOptions::default())
            .expect("defaults are valid"),
        ..Settings::default()
    }
}

/// A scene that Mitsuba renders too.
struct Case<'a> {
    what: String,
    path: &'a Path,
    /// What the scene reads.
    inputs: &'a [PathBuf],
    definitions: &'a [(String, String)],
    colour: ColourMode,
    /// Images of Mitsuba's, of 32 samples per pixel each.
    references: u32,
}

impl Case<'_> {
    /// Compares our images by each of `strategies` with Mitsuba's.
    fn check(&self, strategies: &[StrategyKind]) {
        let Some(mitsuba) = Mitsuba::find(&self.what) else {
            return;
        };
        let Some(scene) = load(self.path, self.definitions) else {
            return;
        };
        let reference = Reference {
            scene: self.path,
            inputs: self.inputs,
            definitions: self.definitions,
            colour: self.colour,
            max_depth: None,
            seeds: self.references,
            spp: 32,
        };
        let reference = mitsuba.render(&reference, scene.film.crop.size);
        for &strategy in strategies {
            let ours = replicates(&scene, settings(self.colour, strategy), 0..24, 20);
            let what = format!("{} by {strategy}", self.what);
            Comparison::new(what, &ours, &reference, 4).assert();
        }
    }
}

/// By every strategy: here paths are as long as it takes for strategies to differ.
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
        let case = Case {
            what: file.to_owned(),
            path: &folder.join(file),
            inputs: &inputs,
            definitions: &[("res".to_owned(), "64".to_owned())],
            colour,
            references: 48,
        };
        case.check(&StrategyKind::ALL);
    }
}

/// A photographed sky and serialized meshes, with surfaces that are diffuse.
#[test]
fn material_preview() {
    let Some(suite) = suite("the material preview of Mitsuba's suite") else {
        return;
    };
    let folder = suite.join("scenes/matpreview");
    let inputs = ["envmap.exr", "matpreview.serialized"].map(|file| folder.join(file));
    for (colour, name) in COLOURS {
        let case = Case {
            what: format!("material preview, {name}"),
            path: &files::of_project("tests/scenes/preview.xml"),
            inputs: &inputs,
            definitions: &[("suite".to_owned(), suite.display().to_string())],
            colour,
            references: 24,
        };
        case.check(&[StrategyKind::Roulette]);
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
        check_by_the_suites_rule(path, &scene, &[StrategyKind::Roulette]);
    }
}

/// A few of them, with different surfaces and lights, by every other strategy: mirrors under a photographed sky, rough glass and rough plastics
/// by a lamp, a textured spot.
#[test]
fn scenes_with_their_own_references_by_every_strategy() {
    const SCENES: [&str; 4] = [
        "infinite_mirrors/scene_path.xml",
        "bsdf_spheres/test_roughdielectric_path.xml",
        "bsdf_spheres/test_roughplastic_linear_path.xml",
        "spot_light/test_spot_direct.xml",
    ];
    let Some(suite) = suite("scenes of Mitsuba's suite by every strategy") else {
        return;
    };
    let others: Vec<StrategyKind> = StrategyKind::ALL
        .into_iter()
        .filter(|&kind| kind != StrategyKind::Roulette)
        .collect();
    for file in SCENES {
        let path = suite.join("tests/scenes").join(file);
        let Some(scene) = load(&path, &[]) else {
            panic!("{file} was skipped");
        };
        check_by_the_suites_rule(&path, &scene, &others);
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

/// Renders `scene`, which `path` holds, by each of `strategies` in all colours, and compares that with the images that come with it:
/// z-tests of all pixels and channels, of which 99.75 % must pass at the corrected threshold.
fn check_by_the_suites_rule(path: &Path, scene: &Arc<Scene>, strategies: &[StrategyKind]) {
    let spp = scene.sampler.sample_count;
    for (colour, name) in COLOURS {
        let reference = |suffix: &str| {
            let file = reference_file(path, &format!("{name}{suffix}"));
            read_exr(&file).unwrap_or_else(|error| panic!("{error}"))
        };
        let (reference, variance) = (reference(""), reference("_var"));
        for &strategy in strategies {
            let settings = settings(colour, strategy);
            let ours = replicates_with_rare_highlights(scene, settings, 0..8, spp.div_ceil(8));
            let share = share_that_passes(&ours.blocks(1), &reference, &variance, spp);
            let what = format!("{}, {name}, {strategy}", path.display());
            println!("{what}: {:.3} % pass", 100.0 * share);
            assert!(
                share >= 0.9975,
                "{what}: only {:.3} % of the pixels pass",
                100.0 * share
            );
        }
    }
}

/// The share of pixels and channels of `ours` that may be `reference`, rendered with `spp` samples per pixel, of which `variance` is that of one.
fn share_that_passes(
    ours: &[Vec<Estimate>; 3],
    reference: &Image,
    variance: &Image,
    spp: u32,
) -> f64 {
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
    passing as f64 / (3 * ours[0].len()) as f64
}
