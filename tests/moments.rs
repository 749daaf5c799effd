//! The second moments of samples, for which the integrator `moment` asks.

mod support;

use std::num::{NonZeroU32, NonZeroUsize};
use std::sync::Arc;

use cohort::film::Image;
use cohort::render::{
    Budget, ColourMode, Ended, Render, RenderState, Settings, StopFlag, WavelengthCount,
};
use cohort::scene::{LoadOptions, Scene};
use cohort::walk::{StrategyKind, StrategyOptions};

use support::files;

fn scene(filter: &str) -> Arc<Scene> {
    let options = LoadOptions {
        definitions: vec![("filter".into(), filter.into())],
        models: None,
    };
    let path = files::of_project("tests/scenes/moments.xml");
    Arc::new(Scene::load(path, &options).expect("the scene can be loaded"))
}

fn spp(samples: u32) -> Budget {
    Budget::SamplesPerPixel(NonZeroU32::new(samples).expect("there are samples"))
}

fn advance(render: &Render, state: &mut RenderState, until: Budget) -> Ended {
    render.advance(state, until, &StopFlag::new(), &())
}

fn moments(state: &RenderState) -> Image {
    let moments = state.film().second_moments();
    moments.expect("the scene asks for them")
}

/// A mean and its standard error.
type Estimate = [f64; 2];

/// Mitsuba 3.9.1: the means of the channels `m2_inner.X` to `m2_inner.Z` over the quarters of the image, row by row, and their errors:
/// `a = np.array([mi.render(scene, spp=1024, seed=1000 + i)[..., -3:] for i in range(32)])`,
/// `q = a.reshape(32, 2, 8, 2, 8, 3).mean((2, 4))`
struct Expected {
    colour: ColourMode,
    filter: &'static str,
    quarters: [[Estimate; 3]; 4],
}

const SPECTRAL: ColourMode = ColourMode::Spectral(WavelengthCount::Four);

/// The one estimator that both programs share: one lamp, light by one reflection.
const EXPECTED: [Expected; 4] = [
    Expected {
        colour: ColourMode::Rgb,
        filter: "box",
        quarters: [
            [[2.87546, 2.8e-3], [3.20075, 3.1e-3], [1.58149, 1.5e-3]],
            [[2.1e-4, 5e-6], [3.7e-4, 6e-6], [5.6e-4, 7e-6]],
            [[0.01567, 1.1e-5], [0.01875, 1.3e-5], [0.00348, 4e-6]],
            [[0.00227, 6e-6], [0.00275, 6e-6], [0.00067, 4e-6]],
        ],
    },
    Expected {
        colour: ColourMode::Rgb,
        filter: "gaussian",
        quarters: [
            [[2.82379, 2.3e-3], [3.14324, 2.5e-3], [1.55308, 1.2e-3]],
            [[0.05088, 2.6e-4], [0.05676, 2.9e-4], [0.02840, 1.5e-4]],
            [[0.01562, 1.1e-5], [0.01870, 1.3e-5], [0.00349, 4e-6]],
            [[0.00235, 5e-6], [0.00286, 5e-6], [0.00071, 4e-6]],
        ],
    },
    Expected {
        colour: SPECTRAL,
        filter: "box",
        quarters: [
            [[2.89865, 2.1e-3], [3.20060, 2.2e-3], [1.91891, 2.7e-3]],
            [[2.4e-4, 5e-6], [3.9e-4, 6e-6], [7.4e-4, 9e-6]],
            [[0.01575, 1.5e-5], [0.01851, 1.5e-5], [0.00388, 6e-6]],
            [[0.00228, 6e-6], [0.00271, 6e-6], [0.00077, 5e-6]],
        ],
    },
    Expected {
        colour: SPECTRAL,
        filter: "gaussian",
        quarters: [
            [[2.84790, 2.0e-3], [3.14450, 2.2e-3], [1.88554, 2.6e-3]],
            [[0.05155, 2.5e-4], [0.05710, 2.6e-4], [0.03450, 1.9e-4]],
            [[0.01570, 1.3e-5], [0.01845, 1.4e-5], [0.00388, 6e-6]],
            [[0.00237, 5e-6], [0.00282, 5e-6], [0.00082, 5e-6]],
        ],
    },
];

/// The means over the quarters of an image of 16 x 16 pixels, row by row.
fn quarters(image: &Image) -> [[f64; 3]; 4] {
    let mut sums = [[0.0; 3]; 4];
    for (index, pixel) in image.pixels().iter().enumerate() {
        let quarter = 2 * (index / 128) + index % 16 / 8;
        for (sum, &value) in sums[quarter].iter_mut().zip(pixel) {
            *sum += f64::from(value) / 64.0;
        }
    }
    sums
}

#[test]
fn second_moments_are_mitsubas() {
    const IMAGES: u64 = 32;
    for expected in EXPECTED {
        let (colour, filter) = (expected.colour, expected.filter);
        let settings = Settings {
            colour,
            budget: spp(512),
            ..Settings::default()
        };
        let render = Render::new(scene(filter), settings).expect("the scene can be rendered");
        let images: Vec<[[f64; 3]; 4]> = (0..IMAGES)
            .map(|seed| {
                let mut state = render.start(seed);
                advance(&render, &mut state, spp(512));
                quarters(&moments(&state))
            })
            .collect();
        for (quarter, channels) in expected.quarters.iter().enumerate() {
            for (channel, &[theirs, their_error]) in channels.iter().enumerate() {
                let values = images.iter().map(|image| image[quarter][channel]);
                let count = IMAGES as f64;
                let ours = values.clone().sum::<f64>() / count;
                let squares: f64 = values.map(|value| (value - ours).powi(2)).sum();
                let error = (squares / (count - 1.0) / count + their_error * their_error).sqrt();
                let z = (ours - theirs) / error;
                assert!(
                    z.abs() < 4.5,
                    "{filter}, {}, quarter {quarter}, channel {channel}: {ours} instead of {theirs}, z = {z}",
                    colour.name()
                );
            }
        }
    }
}

/// A quarter of the samples teaches and weighs half: squares that did not would be a seventh too many.
#[test]
fn squares_weigh_what_samples_do() {
    let settings = Settings {
        strategy: StrategyKind::Ears
            .build(&StrategyOptions::default())
            .expect("defaults are valid"),
        colour: ColourMode::Rgb,
        budget: spp(64),
        ..Settings::default()
    };
    let render = Render::new(scene("box"), settings).expect("the scene can be rendered");
    let mut state = render.start(0);
    assert_eq!(advance(&render, &mut state, spp(64)), Ended::Complete);
    let [[_, found, _], ..] = quarters(&moments(&state));
    let [expected, _] = EXPECTED[0].quarters[0][1];
    assert!((found / expected - 1.0).abs() < 0.06, "{found} {expected}");
}

#[test]
fn slices_and_threads_change_no_bit() {
    for strategy in [StrategyKind::Roulette, StrategyKind::ParticleFilter] {
        let render = |threads| {
            let settings = Settings {
                strategy: strategy
                    .build(&StrategyOptions::default())
                    .expect("defaults are valid"),
                budget: spp(40),
                threads: NonZeroUsize::new(threads).expect("there is a thread"),
                ..Settings::default()
            };
            Render::new(scene("gaussian"), settings).expect("the scene can be rendered")
        };
        let alone = render(1);
        let mut at_once = alone.start(5);
        assert_eq!(advance(&alone, &mut at_once, spp(40)), Ended::Complete);
        let three = render(3);
        let mut state = three.start(5);
        for until in 1..200 {
            let rays = Budget::Rays((500 * until).try_into().expect("it is positive"));
            let ended = advance(&three, &mut state, rays);
            let bytes = postcard::to_stdvec(&state).expect("a state can be written");
            state = postcard::from_bytes(&bytes).expect("a state can be read");
            assert!(three.fits(&state));
            if ended == Ended::Complete {
                break;
            }
        }
        assert_eq!(moments(&state), moments(&at_once), "{strategy}");
        assert!(state.film() == at_once.film(), "{strategy}");
    }
}

#[test]
fn films_without_second_moments_do_not_fit() {
    let plain = support::render::many_emitters(16);
    let plain = Render::new(plain, Settings::default()).expect("the scene can be rendered");
    let asked = Render::new(scene("box"), Settings::default()).expect("the scene can be rendered");
    assert_eq!(plain.start(0).film().second_moments(), None);
    assert!(!asked.fits(&plain.start(0)));
    assert!(!plain.fits(&asked.start(0)));
}
