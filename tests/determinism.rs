//! The same inputs and seed give the same bits, whatever the number of threads; other seeds, other noise.

mod support;

use std::num::{NonZeroU32, NonZeroUsize};
use std::sync::Arc;
use std::time::Duration;

use cohort::film::Film;
use cohort::render::{Budget, ColourMode, Render, Settings, StopFlag};
use cohort::sampling::SamplerKind;
use cohort::scene::{LoadOptions, Scene};
use cohort::walk::{ParticleFilter, Rounding, Scope, Strategy, StrategyKind, StrategyOptions};

use support::files;
use support::render::replicates;

/// A scene with everything that draws random numbers: several lights, a wide filter, shapes of all kinds. 40 x 40
/// pixels are nine tiles, some of them not full.
fn scene() -> Arc<Scene> {
    let options = LoadOptions {
        definitions: vec![
            ("filter".into(), "gaussian".into()),
            ("size".into(), "40".into()),
        ],
        models: None,
    };
    let path = files::of_project("tests/scenes/many-emitters.xml");
    Arc::new(Scene::load(path, &options).expect("the scene can be loaded"))
}

fn settings(
    strategy: Box<dyn Strategy>,
    colour: ColourMode,
    threads: usize,
    seed: u64,
) -> Settings {
    Settings {
        strategy,
        colour,
        seed,
        threads: NonZeroUsize::new(threads).expect("there is a thread"),
        // Two passes, the second of them not full.
        budget: Budget::SamplesPerPixel(NonZeroU32::new(20).expect("there are samples")),
        ..Settings::default()
    }
}

fn film(scene: &Arc<Scene>, settings: Settings) -> Film {
    let render = Render::new(Arc::clone(scene), settings).expect("the scene can be rendered");
    render.run(&StopFlag::new(), &()).film
}

/// Every strategy, and the particle filter with every population.
fn strategies() -> Vec<Box<dyn Fn() -> Box<dyn Strategy>>> {
    let mut list: Vec<Box<dyn Fn() -> Box<dyn Strategy>>> = Vec::new();
    for kind in StrategyKind::ALL {
        list.push(Box::new(move || {
            kind.build(&StrategyOptions::default())
                .expect("defaults are valid")
        }));
    }
    for (population, counts) in [
        (Scope::CameraPath, Rounding::Stratified),
        (Scope::Tile, Rounding::Multinomial),
    ] {
        list.push(Box::new(move || {
            Box::new(ParticleFilter::new(2.0, population, counts).expect("the settings are valid"))
        }));
    }
    list
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let scene = scene();
    for strategy in strategies() {
        for colour in [ColourMode::Rgb, ColourMode::default()] {
            let with = |threads| film(&scene, settings(strategy(), colour, threads, 7));
            let one = with(1);
            assert!(
                one.image().mean()[1] > 0.01,
                "{:?}: the image is black",
                strategy()
            );
            for threads in [1, 2, 3] {
                assert!(
                    with(threads) == one,
                    "{:?} in {}: {threads} threads",
                    strategy(),
                    colour.name()
                );
            }
        }
    }
}

#[test]
fn the_number_of_threads_changes_no_bit_of_instances() {
    let path = files::of_project("tests/scenes/instances.xml");
    let scene = Scene::load(path, &LoadOptions::default()).expect("the scene can be loaded");
    let scene = Arc::new(scene);
    for kind in [StrategyKind::Roulette, StrategyKind::ParticleFilter] {
        let with = |threads| {
            let strategy = kind.build(&StrategyOptions::default());
            let strategy = strategy.expect("defaults are valid");
            film(&scene, settings(strategy, ColourMode::Rgb, threads, 7))
        };
        let one = with(1);
        assert!(one.image().mean()[1] > 0.01, "{kind}: the image is black");
        for threads in [2, 3] {
            assert!(with(threads) == one, "{kind}: {threads} threads");
        }
    }
}

/// What is learned does not depend on which tile is ready first.
#[test]
fn the_number_of_threads_changes_no_bit_of_what_is_learned() {
    // Where little is known, and where lamps are seen from everywhere, nothing would be guided.
    let options = LoadOptions {
        definitions: vec![("res".into(), "40".into())],
        models: None,
    };
    let path = files::of_project("scenes/cornell-knot.xml");
    let scene = Scene::load(path, &options).expect("the scene can be loaded");
    let scene = Arc::new(scene);
    for sampler in SamplerKind::ALL {
        for kind in [StrategyKind::Roulette, StrategyKind::ParticleFilter] {
            let with = |threads, guiding| {
                let strategy = kind.build(&StrategyOptions::default());
                let strategy = strategy.expect("defaults are valid");
                let settings = Settings {
                    sampler,
                    guiding,
                    // Lessons after 1, 2, 4, 8, 16 and 32 samples.
                    budget: Budget::Time(Duration::MAX),
                    ..settings(strategy, ColourMode::Rgb, threads, 7)
                };
                let until = Budget::SamplesPerPixel(NonZeroU32::new(40).expect("not zero"));
                let render = Render::new(Arc::clone(&scene), settings);
                let render = render.expect("the scene can be rendered");
                let mut state = render.start(7);
                render.advance(&mut state, until, &StopFlag::new(), &());
                state.film().clone()
            };
            let one = with(1, true);
            assert!(
                one != with(1, false),
                "{kind}, {sampler}: nothing is guided"
            );
            for threads in [1, 2, 3] {
                assert!(
                    with(threads, true) == one,
                    "{kind}, {sampler}: {threads} threads"
                );
            }
        }
    }
}

#[test]
fn another_seed_changes_every_tile() {
    let scene = scene();
    for strategy in strategies() {
        let with = |seed| film(&scene, settings(strategy(), ColourMode::Rgb, 2, seed));
        let (one, other) = (with(1), with(2));
        for (one, other) in one.tiles().iter().zip(other.tiles()) {
            assert!(
                one.pixels != other.pixels,
                "{:?}: tile at {}, {}",
                strategy(),
                one.x,
                one.y
            );
        }
    }
}

#[test]
fn tiles_do_not_share_their_noise() {
    // An image in which all pixels look at the same: whatever differs between its tiles is noise.
    let options = LoadOptions {
        definitions: vec![("size".into(), "48".into())],
        models: None,
    };
    let path = files::of_project("tests/scenes/uniform.xml");
    let scene = Arc::new(Scene::load(path, &options).expect("the scene can be loaded"));
    let strategy = StrategyKind::Roulette
        .build(&StrategyOptions::default())
        .expect("defaults are valid");
    let film = film(&scene, settings(strategy, ColourMode::Rgb, 2, 0));
    let tiles = film.tiles();
    for (index, tile) in tiles.iter().enumerate() {
        for other in &tiles[..index] {
            assert!(
                tile.pixels.get(0) != other.pixels.get(0),
                "two tiles begin alike"
            );
        }
    }
}

/// If two passes drew the same random numbers, the film would believe in twice the samples that it has: its variance
/// would be half of what images with different seeds show. [`replicates`] compares the two.
#[test]
fn passes_do_not_share_their_noise() {
    let scene = scene();
    for strategy in strategies() {
        let settings = settings(strategy(), ColourMode::Rgb, 2, 0);
        replicates(&scene, settings, 0..24, 32);
    }
}
