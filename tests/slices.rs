//! A render in slices is the render in one go, whatever the slices, and though it is saved and loaded between them.

mod support;

use std::num::{NonZeroU32, NonZeroU64, NonZeroUsize};
use std::time::Duration;

use cohort::film::Film;
use cohort::render::{Budget, Ended, Render, RenderState, Settings, StopFlag};
use cohort::sampling::SamplerKind;
use cohort::walk::{StrategyKind, StrategyOptions};

use support::render::many_emitters;

fn settings(strategy: StrategyKind, budget: Budget, threads: usize) -> Settings {
    Settings {
        strategy: strategy
            .build(&StrategyOptions::default())
            .expect("defaults are valid"),
        budget,
        threads: NonZeroUsize::new(threads).expect("there is a thread"),
        ..Settings::default()
    }
}

fn render(strategy: StrategyKind, budget: Budget, threads: usize) -> Render {
    prepared(40, settings(strategy, budget, threads))
}

/// A square image with so many pixels on each side.
fn prepared(side: u32, settings: Settings) -> Render {
    Render::new(many_emitters(side), settings).expect("the scene can be rendered")
}

/// Four tiles, of which three are cut.
const SIDE: u32 = 24;

fn spp(samples: u32) -> Budget {
    Budget::SamplesPerPixel(NonZeroU32::new(samples).expect("there are samples"))
}

fn rays(count: u64) -> Budget {
    Budget::Rays(NonZeroU64::new(count).expect("there are rays"))
}

const OPEN: Budget = Budget::Time(Duration::MAX);

fn advance(render: &Render, state: &mut RenderState, until: Budget) -> Ended {
    render.advance(state, until, &StopFlag::new(), &())
}

fn saved_and_loaded(state: &RenderState) -> RenderState {
    let bytes = postcard::to_stdvec(state).expect("a state can be written");
    let loaded = postcard::from_bytes(&bytes).expect("a state can be read");
    assert!(&loaded == state, "something was lost");
    loaded
}

fn fewest_samples(film: &Film) -> u64 {
    film.pixels().map(|pixel| pixel.samples).min().unwrap_or(0)
}

/// Checks that every pixel of `film` is what it is in the one of `at_once` where it has as many samples.
fn check_pixels(film: &Film, at_once: &[Film], what: &str) {
    for (index, tile) in film.tiles().iter().enumerate() {
        for (place, pixel) in tile.pixels.iter().enumerate() {
            let same = at_once
                .iter()
                .map(|film| film.tiles()[index].pixels.get(place))
                .find(|other| other.samples == pixel.samples);
            assert!(
                pixel.samples == 0 || same == Some(pixel),
                "{what}: pixel {place} of tile {index} with {} samples",
                pixel.samples
            );
        }
    }
}

/// What is rendered: independent samples, and whatever passes leave to the passes after them.
fn cases(budget: Budget, threads: usize) -> [(&'static str, Render); 3] {
    let alone = settings(StrategyKind::Roulette, budget, threads);
    let together = || settings(StrategyKind::ParticleFilter, budget, threads);
    let learning = Settings {
        sampler: SamplerKind::ArrayQmc,
        guiding: true,
        ..together()
    };
    [
        ("roulette", prepared(SIDE, alone)),
        ("a population", prepared(SIDE, together())),
        ("a sorted, guided population", prepared(SIDE, learning)),
    ]
}

/// Two renders take turns in slices, slice k `until` the budget of k, and each is compared with itself in one go. Tells in which cases all
/// slices ended with a pass.
fn check_slices(budget: Budget, until: impl Fn(u32) -> Budget) -> Vec<String> {
    let mut only_whole_passes = Vec::new();
    for (case, (name, alone)) in cases(budget, 1).into_iter().enumerate() {
        let at_once = |seed| {
            let film = |samples| {
                let mut state = alone.start(seed);
                assert_eq!(
                    advance(&alone, &mut state, spp(samples)),
                    Ended::Complete,
                    "{samples}"
                );
                state.film().clone()
            };
            // After these the growing passes end.
            [1, 2, 4, 8, 16, 32].map(film)
        };
        let at_once = [3, 4].map(at_once);
        for threads in [1, 2] {
            let what = format!("{name} on {threads} threads");
            let (_, render) = &cases(budget, threads)[case];
            let mut states = [3, 4].map(|seed| render.start(seed));
            let mut within_a_pass = false;
            let is_short = |state: &RenderState| fewest_samples(state.film()) < 4;
            for slice in 1.. {
                if !states.iter().any(is_short) {
                    break;
                }
                let taking_turns = states.iter_mut().zip(&at_once);
                for (state, at_once) in taking_turns.filter(|(state, _)| is_short(state)) {
                    *state = saved_and_loaded(state);
                    let ended = advance(render, state, until(slice));
                    assert!(matches!(ended, Ended::OutOfTime | Ended::OutOfRays));
                    check_pixels(state.film(), at_once, &what);
                    within_a_pass |= state.film().unequal_samples().is_some();
                }
            }
            for (state, at_once) in states.iter_mut().zip(&at_once) {
                assert_eq!(advance(render, state, spp(32)), Ended::Complete);
                assert!(state.film() == &at_once[5], "{what}: 32 samples");
                let paths = u64::from(SIDE * SIDE) * 32;
                assert_eq!(state.statistics().camera_paths, paths);
                let before = state.clone();
                assert_eq!(advance(render, state, spp(20)), Ended::Complete);
                assert!(state.film() == before.film(), "{what}: it went on");
            }
            if !within_a_pass {
                only_whole_passes.push(what);
            }
        }
    }
    only_whole_passes
}

#[test]
fn slices_by_rays_change_no_bit() {
    let only_whole_passes = check_slices(rays(1 << 40), |slice| rays(997 * u64::from(slice)));
    assert_eq!(only_whole_passes, [""; 0]);
}

#[test]
fn slices_by_time_change_no_bit() {
    // Where these end is the machine's affair.
    check_slices(OPEN, |slice| {
        Budget::Time(Duration::from_micros(500) * slice)
    });
}

#[test]
fn a_number_of_samples_has_an_end() {
    let render = render(StrategyKind::Roulette, spp(20), 2);
    let whole = render.run(&StopFlag::new(), &());
    assert_eq!(whole.ended, Ended::Complete);
    assert_eq!(fewest_samples(&whole.film), 20);
    let mut state = render.start(whole.seed);
    for slice in 1.. {
        if advance(&render, &mut state, rays(5000 * slice)) == Ended::Complete {
            break;
        }
    }
    assert!(state.film() == &whole.film, "20 samples in slices");
    assert_eq!(advance(&render, &mut state, OPEN), Ended::Complete);
    assert!(state.film() == &whole.film, "it went on");
}

#[test]
fn rays_are_counted_from_the_start() {
    let render = render(StrategyKind::Roulette, OPEN, 1);
    let mut state = render.start(0);
    // The first batch is the first tile once.
    assert_eq!(advance(&render, &mut state, rays(1)), Ended::OutOfRays);
    assert_eq!(state.statistics().camera_paths, 256);
    let traced = state.statistics().all_rays();
    assert_eq!(advance(&render, &mut state, rays(traced)), Ended::OutOfRays);
    assert_eq!(state.statistics().all_rays(), traced);
    assert_eq!(
        advance(&render, &mut state, rays(traced + 1)),
        Ended::OutOfRays
    );
    assert_eq!(state.statistics().camera_paths, 512);
}

#[test]
fn time_is_counted_from_the_start() {
    let render = render(StrategyKind::Roulette, OPEN, 1);
    let mut state = render.start(0);
    let slice = Duration::from_millis(20);
    assert_eq!(
        advance(&render, &mut state, Budget::Time(slice)),
        Ended::OutOfTime
    );
    let (film, duration) = (state.film().clone(), state.duration());
    assert!(duration > Duration::ZERO);
    // What is over stays over, and what lies between advances does not count.
    std::thread::sleep(3 * slice);
    assert_eq!(
        advance(&render, &mut state, Budget::Time(duration)),
        Ended::OutOfTime
    );
    assert!(state.film() == &film, "it went on");
    assert!(state.duration() < duration + slice);
    assert_eq!(
        advance(&render, &mut state, Budget::Time(duration + 2 * slice)),
        Ended::OutOfTime
    );
    assert!(state.film() != &film, "it did not go on");
}

#[test]
fn a_raised_flag_stops_at_once() {
    let render = render(StrategyKind::Roulette, OPEN, 2);
    let mut state = render.start(0);
    let stop = StopFlag::new();
    stop.raise();
    let ended = render.advance(&mut state, OPEN, &stop, &());
    assert_eq!(ended, Ended::Interrupted);
    assert_eq!(state.statistics().camera_paths, 0);
}

#[test]
fn a_state_of_another_image_does_not_fit() {
    let render = render(StrategyKind::Roulette, OPEN, 1);
    let other =
        Render::new(many_emitters(41), Settings::default()).expect("the scene can be rendered");
    assert!(render.fits(&render.start(5)) && !render.fits(&other.start(5)));
}
