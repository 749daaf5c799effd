//! The paper's scenes by every strategy, against Mitsuba 3.
//!
//! Images by Cohort and by Mitsuba must differ by noise alone: in every block of 4 x 4 pixels, in single pixels by
//! the rule of Mitsuba's own render tests, and in the mean.
//!
//! The mean is taken over the pixels that show reflected light. The lamp would be half of the image's mean although it
//! says nothing of light transport, and the pixels on its edge would be most of the noise; it is compared in the blocks.

mod support;

use std::num::NonZeroU32;
use std::path::PathBuf;
use std::sync::Arc;

use cohort::render::{ColourMode, Settings};
use cohort::scene::mesh::{knot, write_ply};
use cohort::scene::{LoadOptions, Scene};
use cohort::transport::DirectLight;
use cohort::walk::{Rounding, Scope, StrategyKind, StrategyOptions};

use support::comparison::{CHANNEL_NAMES, Comparison, assert_equal_within};
use support::estimate::Estimate;
use support::files;
use support::mitsuba::{Mitsuba, Reference};
use support::render::replicates;
use support::replicates::Replicates;

/// Side of the images in pixels.
const SIDE: u32 = 128;
/// Side of the blocks in pixels.
const BLOCK: usize = 4;
/// Luminance above which a pixel shows the lamp.
const LAMP: f64 = 1.0;
/// The means of what is reflected must be equal within this share.
const MEAN_WITHIN: f64 = 0.002;

/// A scene of the project with its mesh.
struct Model {
    scene: PathBuf,
    folder: PathBuf,
    mesh: PathBuf,
}

impl Model {
    /// The box with the knot, whose mesh is written for Mitsuba.
    fn knot() -> Self {
        let folder = files::kept_folder("models");
        let mesh = folder.join("knot.ply");
        files::put(&mesh, |draft| {
            write_ply(draft, &knot::knot(knot::DEFAULT_TRIANGLES))
                .expect("the knot can be written");
        });
        Self {
            scene: files::of_project("scenes/cornell-knot.xml"),
            folder,
            mesh,
        }
    }

    /// The box with the Armadillo, if `COHORT_MODELS` says where it is.
    fn armadillo() -> Option<Self> {
        let Some(folder) = std::env::var_os("COHORT_MODELS").map(PathBuf::from) else {
            let why = "COHORT_MODELS does not name a folder with armadillo.ply";
            files::say_skipped("cornell-armadillo against Mitsuba", why);
            return None;
        };
        Some(Self {
            scene: files::of_project("scenes/cornell-armadillo.xml"),
            mesh: folder.join("armadillo.ply"),
            folder,
        })
    }

    fn definitions(&self, side: u32) -> Vec<(String, String)> {
        vec![
            ("models".into(), self.folder.display().to_string()),
            ("res".into(), side.to_string()),
        ]
    }

    fn load(&self, side: u32) -> Arc<Scene> {
        let options = LoadOptions {
            definitions: self.definitions(side),
            models: None,
        };
        Arc::new(Scene::load(&self.scene, &options).expect("the scene can be loaded"))
    }

    /// Mitsuba's images.
    fn reference(&self, mitsuba: &Mitsuba, job: &Job, seeds: u32, spp: u32) -> Replicates {
        let scene = self.load(job.side);
        let reference = Reference {
            scene: &self.scene,
            inputs: std::slice::from_ref(&self.mesh),
            definitions: &self.definitions(job.side),
            colour: job.colour,
            max_depth: job.max_depth,
            seeds,
            spp,
        };
        mitsuba.render(&reference, scene.film.crop.size)
    }
}

/// What both renderers are told.
#[derive(Clone, Copy)]
struct Job {
    side: u32,
    colour: ColourMode,
    max_depth: Option<u32>,
}

/// A strategy with its settings.
#[derive(Clone, Copy)]
struct Walk {
    kind: StrategyKind,
    options: StrategyOptions,
    direct_light: DirectLight,
    /// The greatest depth, where the strategy needs one and the job says nothing.
    max_depth: Option<u32>,
    /// Samples per pixel of each image.
    spp: u32,
}

impl Walk {
    fn new(kind: StrategyKind, spp: u32) -> Self {
        Self {
            kind,
            options: StrategyOptions::default(),
            direct_light: DirectLight::NextEvent,
            max_depth: None,
            spp,
        }
    }

    fn particle_filter(population: Scope, counts: Rounding, spp: u32) -> Self {
        Self {
            options: StrategyOptions {
                population: Some(population),
                counts: Some(counts),
                ..StrategyOptions::default()
            },
            ..Self::new(StrategyKind::ParticleFilter, spp)
        }
    }

    fn settings(&self, job: &Job) -> Settings {
        let strategy = self
            .kind
            .build(&self.options)
            .expect("the options are the strategy's");
        Settings {
            strategy,
            colour: job.colour,
            direct_light: self.direct_light,
            max_depth: job.max_depth.or(self.max_depth).and_then(NonZeroU32::new),
            ..Settings::default()
        }
    }
}

/// How much has to be rendered to know the means well enough for what is asserted of them.
struct Effort {
    /// Images by Mitsuba.
    references: u32,
    /// Samples per pixel of ours, as a multiple of what the strategies stand at.
    factor: u32,
}

impl Effort {
    /// Four wavelengths say little of blue, of which this warm light has little.
    fn in_colour(colour: ColourMode) -> Self {
        match colour {
            ColourMode::Rgb => Self {
                references: 64,
                factor: 2,
            },
            ColourMode::Spectral(_) => Self {
                references: 128,
                factor: 5,
            },
        }
    }
}

/// Every strategy. Those that split the first vertex need fewer samples for the same noise.
fn every_strategy() -> [Walk; StrategyKind::ALL.len()] {
    StrategyKind::ALL.map(|kind| match kind {
        // The light of paths with more than 32 segments is below 1e-4 of the whole: at each reflection a quarter of the
        // light is lost, and some leaves through the open front.
        StrategyKind::FixedDepth => Walk {
            max_depth: Some(32),
            ..Walk::new(kind, 10)
        },
        StrategyKind::Roulette
        | StrategyKind::ThroughputRoulette
        | StrategyKind::AdjointRoulette => Walk::new(kind, 10),
        // They end paths from the first vertex on: cheap paths, and more of them.
        StrategyKind::Ears => Walk::new(kind, 14),
        StrategyKind::ParticleFilter => Walk::new(kind, 20),
        StrategyKind::GoWithTheWinners | StrategyKind::PaperParticleFilter => Walk::new(kind, 9),
    })
}

/// Strategies that end paths only, and that split them too.
const ONE_OF_EACH_KIND: [StrategyKind; 2] = [StrategyKind::Roulette, StrategyKind::ParticleFilter];

/// The number of images of each strategy.
const SEEDS: u64 = 22;

/// Renders `model` by each of `walks` and compares each with Mitsuba, and their pooled mean too.
fn compare_means(model: &Model, colour: ColourMode, walks: &[Walk]) {
    let what = format!("{} in {}", model.scene.display(), colour.name());
    let Some(mitsuba) = Mitsuba::find(&what) else {
        return;
    };
    let job = Job {
        side: SIDE,
        colour,
        max_depth: None,
    };
    let effort = Effort::in_colour(colour);
    let reference = model.reference(&mitsuba, &job, effort.references, 32);
    let reflected = reference.far_from_brighter_than(LAMP);
    let reference_means = reference.means_over(&reflected);
    let scene = model.load(SIDE);
    let mut pooled = reference_means.map(|_| Vec::new());
    for (index, walk) in walks.iter().enumerate() {
        // Strategies with the same seeds have the same camera rays, and their means err together.
        let seeds = SEEDS * index as u64..SEEDS * (index as u64 + 1);
        let spp = effort.factor * walk.spp;
        let ours = replicates(&scene, walk.settings(&job), seeds, spp);
        let name = format!("{what}, {}", walk.kind);
        Comparison::new(&name, &ours, &reference, BLOCK).assert();
        let means = ours.means_over(&reflected);
        for (channel, (mean, expected)) in means.iter().zip(&reference_means).enumerate() {
            println!(
                "    reflected {} {:+.3} % (+-{:.3} %)",
                CHANNEL_NAMES[channel],
                100.0 * (mean.mean / expected.mean - 1.0),
                100.0 * mean.error_of_difference(expected) / expected.mean
            );
            let name = format!("{name}: reflected {}", CHANNEL_NAMES[channel]);
            assert_equal_within(&name, MEAN_WITHIN, mean, expected);
            pooled[channel].push(*mean);
        }
    }
    for (channel, (means, expected)) in pooled.iter().zip(&reference_means).enumerate() {
        let name = format!(
            "{what}, these strategies together: reflected {}",
            CHANNEL_NAMES[channel]
        );
        let mean = pool(means);
        println!(
            "{name}: {:+.3} %",
            100.0 * (mean.mean / expected.mean - 1.0)
        );
        assert_equal_within(&name, MEAN_WITHIN, &mean, expected);
    }
}

/// The mean of independent estimates, weighted by how well they are known.
fn pool(estimates: &[Estimate]) -> Estimate {
    let weight = |estimate: &Estimate| 1.0 / estimate.variance;
    let total: f64 = estimates.iter().map(weight).sum();
    Estimate {
        mean: estimates.iter().map(|e| weight(e) * e.mean).sum::<f64>() / total,
        variance: 1.0 / total,
        count: estimates.iter().map(|e| e.count).sum(),
    }
}

#[test]
fn knot_in_rgb_by_every_strategy() {
    compare_means(&Model::knot(), ColourMode::Rgb, &every_strategy());
}

#[test]
fn knot_in_wavelengths_by_every_strategy() {
    compare_means(&Model::knot(), ColourMode::default(), &every_strategy());
}

#[test]
fn armadillo_in_rgb_by_every_strategy() {
    if let Some(model) = Model::armadillo() {
        compare_means(&model, ColourMode::Rgb, &every_strategy());
    }
}

/// The knot is walked in wavelengths by every strategy, the Armadillo in RGB: what is left is the mesh in wavelengths.
#[test]
fn armadillo_in_wavelengths() {
    if let Some(model) = Model::armadillo() {
        let walks = every_strategy()
            .into_iter()
            .filter(|walk| ONE_OF_EACH_KIND.contains(&walk.kind))
            .collect::<Vec<_>>();
        compare_means(&model, ColourMode::default(), &walks);
    }
}

/// Compares the knot at half the size by each of `walks`, in blocks only.
fn compare_walks(job: &Job, walks: &[(String, Walk)]) {
    let Some(mitsuba) = Mitsuba::find("ways to walk in cornell-knot.xml") else {
        return;
    };
    let model = Model::knot();
    let reference = model.reference(&mitsuba, job, 64, 32);
    let scene = model.load(job.side);
    for (name, walk) in walks {
        let ours = replicates(&scene, walk.settings(job), 0..SEEDS, walk.spp);
        let comparison = Comparison::new(name, &ours, &reference, BLOCK);
        match walk.direct_light {
            DirectLight::NextEvent => comparison.assert(),
            DirectLight::Off => comparison.without_single_pixels().assert(),
        }
    }
}

#[test]
fn every_population_and_every_way_to_draw() {
    let job = Job {
        side: SIDE / 2,
        colour: ColourMode::Rgb,
        max_depth: None,
    };
    let walks: Vec<(String, Walk)> = Scope::JOINT
        .into_iter()
        .flat_map(|population| Rounding::ALL.map(|counts| (population, counts)))
        .map(|(population, counts)| {
            let spp = if population == Scope::CameraPath {
                9
            } else {
                18
            };
            let name = format!("particle-filter, population {population}, counts {counts}");
            (name, Walk::particle_filter(population, counts, spp))
        })
        .collect();
    compare_walks(&job, &walks);
}

#[test]
fn paths_of_at_most_eight_segments() {
    let job = Job {
        side: SIDE / 2,
        colour: ColourMode::default(),
        max_depth: Some(8),
    };
    let walks =
        StrategyKind::ALL.map(|kind| (format!("at most 8 segments, {kind}"), Walk::new(kind, 18)));
    compare_walks(&job, &walks);
}

#[test]
fn without_next_event_estimation() {
    let job = Job {
        side: SIDE / 2,
        colour: ColourMode::Rgb,
        max_depth: None,
    };
    let walks = [
        StrategyKind::Roulette,
        StrategyKind::GoWithTheWinners,
        StrategyKind::ParticleFilter,
    ]
    .map(|kind| {
        let walk = Walk {
            direct_light: DirectLight::Off,
            ..Walk::new(kind, 64)
        };
        (format!("{kind}, direct light off"), walk)
    });
    compare_walks(&job, &walks);
}
