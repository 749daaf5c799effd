//! The precision of a film's sums changes its roundings, and nothing else.

mod support;

use std::num::NonZeroU32;
use std::sync::Arc;

use cohort::film::{Film, FilmSums};
use cohort::render::{Budget, Render, Settings, StopFlag};
use cohort::scene::{LoadOptions, Scene};
use cohort::walk::{StrategyKind, StrategyOptions};

use support::files;

#[test]
fn sums_of_any_precision_are_the_same_but_for_rounding() {
    let options = LoadOptions {
        definitions: vec![("size".into(), "24".into())],
        models: None,
    };
    let path = files::of_project("tests/scenes/many-emitters.xml");
    let scene = Arc::new(Scene::load(path, &options).expect("the scene can be loaded"));
    // One adds up single samples, the other those of a population first.
    for strategy in [StrategyKind::Roulette, StrategyKind::ParticleFilter] {
        let film = |film_sums| -> Film {
            let settings = Settings {
                strategy: strategy
                    .build(&StrategyOptions::default())
                    .expect("defaults are valid"),
                budget: Budget::SamplesPerPixel(NonZeroU32::new(64).expect("there are samples")),
                film_sums,
                ..Settings::default()
            };
            let render =
                Render::new(Arc::clone(&scene), settings).expect("the scene can be rendered");
            render.run(&StopFlag::new(), &()).film
        };
        let [single, double, compensated] =
            [FilmSums::Single, FilmSums::Double, FilmSums::Compensated].map(film);
        let largest_deviation = |film: &Film| {
            let pixels = film.pixels().zip(double.pixels());
            let deviations = pixels.flat_map(|(pixel, exact)| {
                assert_eq!(
                    (pixel.samples, pixel.units),
                    (exact.samples, exact.units),
                    "{strategy}"
                );
                let (mean, exact) = (pixel.mean(), exact.mean());
                (0..3).map(move |channel| (mean[channel] - exact[channel]).abs())
            });
            deviations.fold(0.0, f64::max)
        };
        let (rough, fine) = (largest_deviation(&single), largest_deviation(&compensated));
        println!("{strategy}: single {rough:e}, compensated {fine:e}");
        assert!(rough > 1e-8 && rough < 1e-4, "{strategy}: {rough:e}");
        assert!(fine < 0.01 * rough, "{strategy}: {fine:e} of {rough:e}");
    }
}
