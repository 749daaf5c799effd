//! Results of a study that never ran, with images.

use std::path::Path;

use cohort::study::results::*;
use cohort::study::statistics::Interval;

/// Side of the images.
pub const SIDE: u32 = 200;

/// An interval that reaches `share` of the estimate to either side.
fn about(estimate: f64, share: f64) -> Interval {
    Interval {
        estimate,
        bounds: Some((estimate * (1.0 - share), estimate * (1.0 + share))),
    }
}

fn errors(relative_mse: f64) -> Errors {
    let region = |factor: f64| RegionErrors {
        mse: relative_mse * factor,
        relative_mse: relative_mse * factor,
    };
    Errors {
        mse: relative_mse * 0.3,
        relative_mse,
        bias: 1e-3,
        lit: region(0.01),
        reflected: region(1.01),
        flip: Some(0.1),
    }
}

fn intervals(relative_mse: f64, seconds: f64, rays: f64) -> ErrorIntervals {
    let around = |value: f64| about(value, 0.12);
    ErrorIntervals {
        mse: around(relative_mse * 0.3),
        rmse: around((relative_mse * 0.3).sqrt()),
        relative_mse: around(relative_mse),
        bias: Interval {
            estimate: 0.0004,
            bounds: Some((-0.0011, 0.0019)),
        },
        lit_mse: around(relative_mse * 40.0),
        reflected_mse: around(relative_mse * 0.05),
        lit_relative_mse: around(relative_mse * 0.01),
        reflected_relative_mse: around(relative_mse * 1.01),
        variance: Some(VarianceIntervals {
            all: around(relative_mse * 0.3),
            lit: around(relative_mse * 40.0),
            reflected: around(relative_mse * 0.05),
        }),
        efficiency: around(1.0 / (relative_mse * 0.3 * seconds)),
        relative_efficiency: around(1.0 / (relative_mse * seconds)),
        ray_efficiency: Some(around(1.0 / (relative_mse * rays))),
        flip: Some(around(0.1)),
    }
}

/// A competitor whose relative MSE is `noise` after a second and falls as 1 / t.
pub fn competitor(name: &str, noise: f64) -> Competitor {
    let snapshot = |index: i32| {
        let seconds = 1800.0 / 2_f64.powi(7 - index);
        // A little off the straight line, as measurements are.
        let relative_mse = noise / seconds * (1.0 + 0.06 * f64::from(index * 5 % 7 - 3) / 3.0);
        let rays = 1.4e6 * seconds;
        Snapshot {
            at: seconds,
            seconds: seconds * 1.0004,
            camera_paths: 2.0e5 * seconds,
            rays: Some(rays),
            errors: intervals(relative_mse, seconds, rays),
            repetitions: (0..4)
                .map(|repetition| errors(relative_mse * (1.0 + 0.05 * f64::from(repetition))))
                .collect(),
        }
    };
    let file = |kind: &str| format!("images/{name}{kind}");
    Competitor {
        name: name.to_owned(),
        settings: vec![
            ("strategy".to_owned(), name.to_owned()),
            ("population".to_owned(), "pixel".to_owned()),
        ],
        images: Images {
            exr: file(".exr"),
            png: file(".png"),
            one_png: file("-one.png"),
            error_png: file("-error.png"),
            error_scale: 0.25,
        },
        snapshots: (0..=7).map(snapshot).collect(),
        slope: Some(about(-0.99, -0.03)),
        time_to_error: TimeToError {
            relative_mse: 0.02,
            seconds: Some(about(noise / 0.02, 0.1)),
            extrapolated: noise > 36.0,
        },
        dropped_samples: vec![0; 4],
        verdict: None,
    }
}

/// A pair whose second is `ratio` times as efficient, give or take a tenth.
pub fn pair(first: &str, second: &str, ratio: f64) -> Pair {
    let interval = about(ratio, 0.1);
    let (low, high) = interval.bounds.expect("it has bounds");
    Pair {
        first: first.to_owned(),
        second: second.to_owned(),
        relative_efficiency: interval,
        efficiency: about(ratio, 0.8),
        reflected_efficiency: about(ratio * 1.02, 0.1),
        finding: if low > 1.0 {
            Finding::SecondBetter
        } else if high < 1.0 {
            Finding::FirstBetter
        } else {
            Finding::NoDifferenceShown
        },
    }
}

/// A comparison of three strategies.
pub fn comparison() -> Results {
    let names = ["roulette", "go-with-the-winners", "particle-filter"];
    let crop = |x, y| Crop {
        x,
        y,
        width: 32,
        height: 32,
    };
    Results {
        schema: SCHEMA,
        kind: StudyKind::Compare,
        scene: SceneFacts {
            name: "scenes/cornell-armadillo.xml".to_owned(),
            width: SIDE,
            height: SIDE,
            lit_share: 0.006,
        },
        conditions: Conditions {
            budget: StudyBudget::Seconds(1800.0),
            threads: 1,
            repetitions: 4,
            seed: 1,
            colour: "spectral, 4 wavelengths".to_owned(),
            slice: Some(10.0),
            budget_deviation: Some(0.0007),
        },
        reference: ReferenceFacts {
            source: "rendered here by fixed-depth".to_owned(),
            strategy: Some("fixed-depth".to_owned()),
            seconds: Some(7200.0),
            samples_per_pixel: Some(16384.0),
            variance: Some(3.1e-6),
            relative_variance: Some(8.2e-5),
            mean_error: Some(2.2e-4),
        },
        machine: Machine {
            processor: "A Processor <of some kind> & more".to_owned(),
            processors: 2,
            system: "Debian GNU/Linux 13".to_owned(),
            date: "2026-03-01T12:00:00Z".to_owned(),
            versions: vec![
                ("Cohort".to_owned(), "0.1.0".to_owned()),
                ("Embree".to_owned(), "4.3.3".to_owned()),
            ],
        },
        commands: vec![
            "cohort compare scenes/cornell-armadillo.xml --strategies roulette,go-with-the-winners,particle-filter \
             --time 30m --repeat 4 -o comparison"
                .to_owned(),
        ],
        competitors: vec![
            competitor(names[0], 36.0),
            competitor(names[1], 58.0),
            competitor(names[2], 34.5),
        ],
        pairs: vec![
            pair(names[0], names[1], 0.62),
            pair(names[0], names[2], 1.04),
            pair(names[1], names[2], 1.68),
        ],
        crops: vec![crop(52, 70), crop(128, 150)],
    }
}

/// Writes the images that the results name.
pub fn write_images(results: &Results, folder: &Path) {
    std::fs::create_dir_all(folder.join("images")).unwrap();
    for (index, competitor) in results.competitors.iter().enumerate() {
        let noise = 20.0 + 25.0 * index as f64;
        let images = &competitor.images;
        write_png(&folder.join(&images.one_png), |x, y, random| {
            shaded(x, y, noise * random)
        });
        write_png(&folder.join(&images.png), |x, y, random| {
            shaded(x, y, 0.5 * noise * random)
        });
        write_png(&folder.join(&images.error_png), |_, _, random| {
            let value = (random.abs() * noise / 50.0).min(1.0);
            [
                (255.0 * value) as u8,
                (150.0 * value * value) as u8,
                (90.0 * value) as u8,
            ]
        });
    }
}

/// A ball before a wall, with something added.
fn shaded(x: f64, y: f64, noise: f64) -> [u8; 3] {
    let (dx, dy) = (x - 0.45, y - 0.6);
    let distance = (dx * dx + dy * dy).sqrt();
    let light = if distance < 0.25 {
        230.0 - 600.0 * distance.powi(2) - 200.0 * dx
    } else {
        120.0 - 60.0 * y
    };
    let tint = if x < 0.2 {
        [1.2, 0.4, 0.3]
    } else if x > 0.8 {
        [0.4, 1.0, 0.4]
    } else {
        [1.0, 0.95, 0.9]
    };
    tint.map(|channel: f64| (light * channel + noise).clamp(0.0, 255.0) as u8)
}

/// Writes a picture from the place in [0, 1]^2 and a random number in [-1, 1].
fn write_png(path: &Path, colour: impl Fn(f64, f64, f64) -> [u8; 3]) {
    let mut state = 1_u32;
    let mut random = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 23) - 1.0
    };
    let mut bytes = Vec::new();
    for y in 0..SIDE {
        for x in 0..SIDE {
            let place = |at: u32| (f64::from(at) + 0.5) / f64::from(SIDE);
            bytes.extend(colour(place(x), place(y), random()));
        }
    }
    let file = std::fs::File::create(path).unwrap();
    let mut encoder = png::Encoder::new(file, SIDE, SIDE);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder
        .write_header()
        .unwrap()
        .write_image_data(&bytes)
        .unwrap();
}
