//! The measures and their intervals on estimators whose errors are known, and on renders.

use rayon::prelude::*;

use super::measures::{Repetitions, bias, errors, relative_error_map, variance_between};
use super::pairs::{Contender, pairs};
use super::reference::Reference;
use super::results::{Errors, Finding};
use super::statistics::{Interval, products};
use super::synthetic::{Synthetic, lit, stream};
use crate::film::Image;
use crate::sampling::RandomStream;
use crate::{LoadOptions, Render, Scene, Settings, StopFlag};

const NOISY: Synthetic = Synthetic {
    deviation: 0.5,
    bias: 0.05,
};
const BETTER: Synthetic = Synthetic {
    deviation: 0.4,
    bias: 0.0,
};

fn repeat(
    estimator: Synthetic,
    n: usize,
    reference: &Reference,
    random: &mut RandomStream,
) -> Vec<Errors> {
    let lit = lit();
    (0..n)
        .map(|_| errors(&estimator.image(random), reference, &lit, false))
        .collect()
}

/// Seconds around `mean` that scatter by 3 %.
fn durations(n: usize, mean: f64, random: &mut RandomStream) -> Vec<f64> {
    let spread = |u: f64| mean * (1.0 + 0.03 * 12_f64.sqrt() * (u - 0.5));
    (0..n).map(|_| spread(random.uniform_f64())).collect()
}

fn column(errors: &[Errors], value: fn(&Errors) -> f64) -> Vec<f64> {
    errors.iter().map(value).collect()
}

#[test]
fn errors_are_those_against_the_truth_whatever_the_reference_lacks() {
    // The reference has an eighth of the image's variance, which would show as 12 % of the MSE.
    let trials = 1500;
    let found: Vec<[f64; 4]> = (0..trials)
        .into_par_iter()
        .map(|trial| {
            let mut random = stream(trial);
            let reference = Synthetic::reference(8, &mut random);
            let image = NOISY.image(&mut random);
            let with = errors(&image, &reference, &lit(), false);
            let plain = Reference::new(reference.image().clone(), None).unwrap();
            let without = errors(&image, &plain, &lit(), false);
            let parts = with.lit.mse / 16.0 + with.reflected.mse * 15.0 / 16.0;
            assert!((parts / with.mse - 1.0).abs() < 1e-12);
            // Better known, for its denominator and the fraction of the bias are not linear in the reference.
            let precise = Synthetic::reference(256, &mut random);
            let relative = errors(&image, &precise, &lit(), false);
            [with.mse, without.mse, relative.relative_mse, relative.bias]
        })
        .collect();
    let excess = Synthetic {
        deviation: 0.5 / 8_f64.sqrt(),
        bias: 0.0,
    };
    let want = [
        NOISY.mse(),
        NOISY.mse() + excess.mse(),
        NOISY.relative_mse(),
        NOISY.bias,
    ];
    for (index, want) in want.into_iter().enumerate() {
        let values: Vec<f64> = found.iter().map(|found| found[index]).collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        let error = (squares / (n - 1.0) / n).sqrt();
        println!("measure {index}: {mean:.5} +- {error:.5}, wanted {want:.5}");
        assert!((mean - want).abs() < 4.0 * error, "measure {index}");
    }
}

#[test]
fn intervals_cover_in_93_to_97_percent_of_1000_trials() {
    let trials = 1000;
    let truths = [
        ("MSE", NOISY.mse()),
        ("relative MSE", NOISY.relative_mse()),
        ("bias", NOISY.bias),
        ("efficiency", 1.0 / (NOISY.mse() * 3.0)),
        (
            "ratio of efficiencies",
            NOISY.mse() * 3.0 / (BETTER.mse() * 4.0),
        ),
    ];
    println!("repetitions  measure                covered of {trials}");
    for n in [5, 8] {
        let covered: Vec<[bool; 5]> = (0..trials)
            .into_par_iter()
            .map(|trial| {
                let mut random = stream(trial + 10_000 * n as u32);
                let reference = Synthetic::reference(128, &mut random);
                let first = repeat(NOISY, n, &reference, &mut random);
                let second = repeat(BETTER, n, &reference, &mut random);
                // The bias is held against a reference no better than the repetitions.
                let rough = Synthetic::reference(n as u32, &mut random);
                let biases = column(&repeat(NOISY, n, &rough, &mut random), |e| e.bias);
                let mse = column(&first, |e| e.mse);
                let work = products(&mse, &durations(n, 3.0, &mut random));
                let others = column(&second, |e| e.mse);
                let other_work = products(&others, &durations(n, 4.0, &mut random));
                let intervals = [
                    Interval::of_positive(&mse),
                    Interval::of_positive(&column(&first, |e| e.relative_mse)),
                    bias(&biases, &rough),
                    Interval::of_positive(&work).reciprocal(),
                    Interval::of_ratio(&work, &other_work),
                ];
                std::array::from_fn(|index| intervals[index].holds(truths[index].1))
            })
            .collect();
        for (index, (name, _)) in truths.into_iter().enumerate() {
            let count = covered.iter().filter(|covered| covered[index]).count();
            println!("{n:11}  {name:21}  {count}");
            assert!((930..=970).contains(&count), "{name} of {n}: {count}");
        }
    }
}

/// In how many trials no difference was shown between estimators, with 5 repetitions each.
fn trials_without_difference(trials: u32, first: Synthetic, second: Synthetic) -> usize {
    let found = (0..trials).into_par_iter().filter(|trial| {
        let mut random = stream(50_000 + trial);
        let reference = Synthetic::reference(64, &mut random);
        let a = repeat(first, 5, &reference, &mut random);
        let b = repeat(second, 5, &reference, &mut random);
        finding(&a, &b) == Finding::NoDifferenceShown
    });
    found.count()
}

fn finding(first: &[Errors], second: &[Errors]) -> Finding {
    let contender = |name, errors| Contender {
        name,
        repetitions: Repetitions {
            errors,
            seconds: &[1.0; 5],
            rays: None,
            variance: None,
        },
    };
    pairs(&[contender("a", first), contender("b", second)])[0].finding
}

#[test]
fn equal_competitors_show_no_difference() {
    let same = trials_without_difference(500, NOISY, NOISY);
    println!("no difference shown in {same} of 500 trials");
    assert!(same >= 465, "{same}");
}

#[test]
fn a_true_difference_is_found() {
    // 0.5 and 0.4 squared: an efficiency 1.58 times as high, with a standard error of about 11 %.
    let missed = trials_without_difference(100, NOISY, BETTER);
    assert!(missed < 25, "{missed}");
    // A fifth, where repetitions scatter by one percent.
    let scatter = [0.99, 1.0, 1.01, 1.003, 0.995];
    let first = scatter.map(|s| of_error(1.2 * s));
    let second = scatter.map(|s| of_error(2.0 - s));
    assert_eq!(finding(&first, &second), Finding::SecondBetter);
    assert_eq!(finding(&second, &first), Finding::FirstBetter);
    // With one repetition nothing is known.
    assert_eq!(
        finding(&first[..1], &second[..1]),
        Finding::NoDifferenceShown
    );
}

fn of_error(relative_mse: f64) -> Errors {
    Errors {
        relative_mse,
        mse: relative_mse,
        ..Errors::default()
    }
}

#[test]
fn equal_renders_with_other_seeds_show_no_difference() {
    let scene = Scene::from_xml(
        r#"<scene version="3.0.0">
            <sensor type="perspective">
                <transform name="to_world"><lookat origin="0, 1, 5" target="0, 0.5, 0"/></transform>
                <film type="hdrfilm"><integer name="width" value="24"/><integer name="height" value="24"/></film>
            </sensor>
            <shape type="sphere"><bsdf type="diffuse"><rgb name="reflectance" value="0.7, 0.4, 0.2"/></bsdf></shape>
            <shape type="rectangle">
                <transform name="to_world">
                    <rotate x="1" angle="-90"/><scale value="4"/><translate y="-1"/>
                </transform>
                <bsdf type="diffuse"><rgb name="reflectance" value="0.6"/></bsdf>
            </shape>
            <emitter type="constant"/>
        </scene>"#,
        &LoadOptions::default(),
    )
    .unwrap();
    let settings = |samples: u32, seed| Settings {
        budget: crate::Budget::SamplesPerPixel(samples.try_into().unwrap()),
        threads: 1.try_into().unwrap(),
        seed,
        ..Settings::default()
    };
    let scene = std::sync::Arc::new(scene);
    let precise = Render::new(scene.clone(), settings(2048, 1)).unwrap();
    let film = precise.run(&StopFlag::new(), &()).film;
    let reference = Reference::new(film.image(), film.variance()).unwrap();
    let lit = vec![false; 24 * 24];
    let render = Render::new(scene, settings(4, 0)).unwrap();
    let mut seed = 100;
    let mut same = 0;
    for _ in 0..100 {
        let mut competitor = || -> Vec<Errors> {
            let mut image = || -> Image {
                seed += 1;
                let mut state = render.start(seed);
                render.advance(&mut state, render.settings().budget, &StopFlag::new(), &());
                state.film().image()
            };
            (0..5)
                .map(|_| errors(&image(), &reference, &lit, false))
                .collect()
        };
        let (a, b) = (competitor(), competitor());
        same += usize::from(finding(&a, &b) == Finding::NoDifferenceShown);
    }
    println!("no difference shown between renders in {same} of 100 trials");
    assert!(same >= 93, "{same}");
}

#[test]
fn all_measures_are_there_and_agree() {
    let mut random = stream(7);
    let reference = Synthetic::reference(64, &mut random);
    let images: Vec<Image> = (0..6).map(|_| BETTER.image(&mut random)).collect();
    let errors: Vec<Errors> = images
        .iter()
        .map(|image| errors(image, &reference, &lit(), true))
        .collect();
    let seconds = durations(6, 2.0, &mut random);
    let rays = [1e6; 6];
    let repetitions = Repetitions {
        errors: &errors,
        seconds: &seconds,
        rays: Some(&rays),
        variance: variance_between(&images, &lit()),
    };
    let found = repetitions.intervals(&reference);
    assert!((found.rmse.estimate.powi(2) / found.mse.estimate - 1.0).abs() < 1e-12);
    let mean_seconds = seconds.iter().sum::<f64>() / 6.0;
    let efficiency = 1.0 / (found.mse.estimate * mean_seconds);
    assert!((found.efficiency.estimate / efficiency - 1.0).abs() < 1e-12);
    let by_rays = 1.0 / (found.relative_mse.estimate * 1e6);
    assert!((found.ray_efficiency.unwrap().estimate / by_rays - 1.0).abs() < 1e-12);
    // An unbiased estimator's MSE is its variance.
    let variance = found.variance.unwrap();
    assert!((variance.all.estimate / BETTER.mse() - 1.0).abs() < 0.2);
    assert!(variance.all.holds(BETTER.mse()));
    let parts = variance.lit.estimate / 16.0 + variance.reflected.estimate * 15.0 / 16.0;
    assert!((parts / variance.all.estimate - 1.0).abs() < 1e-12);
    assert!(variance.lit.bounds.is_some() && variance.lit != variance.reflected);
    assert!(found.bias.holds(0.0) && found.flip.unwrap().estimate > 0.01);
    assert_eq!(variance_between(&images[..1], &lit()), None);
    // The picture of errors has the relative MSE as its mean, and the reference's variance besides.
    let map = relative_error_map(&images[0], &reference);
    let mean = map.iter().map(|v| f64::from(*v)).sum::<f64>() / map.len() as f64;
    let want = errors[0].relative_mse + reference.relative_variance().unwrap();
    assert!((mean / want - 1.0).abs() < 1e-5, "{mean}, {want}");
}
