use std::f32::consts::PI;
use std::fmt::Write;

use glam::Vec3;
use proptest::prelude::*;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use statrs::statistics::{Data, OrderStatistics, Statistics};

use super::*;
use crate::sampling::{RandomStream, StreamKey};
use crate::scene::{LoadOptions, Scene};
use crate::spectrum::Rgb;

fn random(tile: u32) -> RandomStream {
    RandomStream::new(StreamKey {
        seed: 11,
        tile,
        pass: 0,
    })
}

fn scene(objects: &str) -> Scene {
    let text = format!(r#"<scene version="3.0.0"><sensor type="perspective"/>{objects}</scene>"#);
    Scene::from_xml(&text, &LoadOptions::default()).unwrap()
}

fn choice(scene: &Scene) -> LightChoice {
    LightChoice::new(&scene.emitters, &scene.shapes)
}

/// Chooses for one surface.
fn choose(
    choice: &LightChoice,
    receiver: &Receiver,
    weights: Option<&GroupWeights>,
    u: f32,
) -> Option<ChosenLight> {
    let mut chosen = [None];
    let receiver = *receiver;
    choice.choose(
        &[LightQuestion {
            receiver,
            weights,
            u,
        }],
        &mut chosen,
    );
    chosen[0]
}

const POINT: &str = r#"<emitter type="point"/>"#;
const DIRECTIONAL: &str = r#"<emitter type="directional"/>"#;

/// `count` lamps of every kind and of very different brightness, in a cube of side 20 about the origin.
fn lamps(count: usize, seed: u32) -> Scene {
    lamps_and_distant(count, 0, seed)
}

/// The same, and `distant` ones that are infinitely far away.
fn lamps_and_distant(count: usize, distant: usize, seed: u32) -> Scene {
    let mut random = random(seed);
    let mut text = String::new();
    for lamp in 0..count {
        let [x, y, z] = [(); 3].map(|()| 20.0 * random.uniform() - 10.0);
        let [a, b, c] = [(); 3].map(|()| random.uniform() - 0.5);
        let power = 10.0_f32.powf(4.0 * random.uniform() - 2.0);
        let turned = format!(
            r#"<transform name="to_world"><scale value="{}"/><lookat origin="{x} {y} {z}" target="{} {} {}" up="{b} {c} {a}"/></transform>"#,
            0.1 + random.uniform(),
            x + a,
            y + b,
            z + c,
        );
        let shape = |plugin: &str| {
            format!(
                r#"<shape type="{plugin}">{turned}<emitter type="area"><rgb name="radiance" value="{power}"/></emitter></shape>"#
            )
        };
        let text = &mut text;
        match lamp % 7 {
            0 => write!(text, r#"<emitter type="point"><point name="position" value="{x} {y} {z}"/><rgb name="intensity" value="{power}"/></emitter>"#),
            1 => write!(text, r#"<emitter type="spot">{turned}<rgb name="intensity" value="{power}"/></emitter>"#),
            2 => write!(text, "{}", shape("rectangle")),
            3 => write!(text, "{}", shape("disk")),
            4 => write!(text, "{}", shape("sphere")),
            5 => write!(text, "{}", shape("cylinder")),
            _ => write!(text, "{}", shape("cube")),
        }
        .unwrap();
    }
    text += &DIRECTIONAL.repeat(distant);
    scene(&text)
}

/// A surface among the lamps, which is looked at from one side or lets light through.
fn surface(random: &mut RandomStream) -> Receiver {
    Receiver {
        position: Vec3::from([(); 3].map(|()| 24.0 * random.uniform() - 12.0)),
        normal: crate::sampling::warp::sphere(random.uniform_2d()),
        scatters_below: random.uniform() < 0.5,
    }
}

/// Whether light from this direction counts at a surface.
fn counts(receiver: &Receiver, direction: Vec3) -> bool {
    receiver.scatters_below || receiver.normal.dot(direction) > 0.0
}

/// A surface at the origin, looked at from above (z).
const UPWARDS: Receiver = Receiver {
    position: Vec3::ZERO,
    normal: Vec3::Z,
    scatters_below: false,
};

#[test]
fn without_a_choice_there_is_nothing_to_choose() {
    let none = choice(&scene(""));
    assert!(!none.depends_on_surface());
    assert_eq!(choose(&none, &UPWARDS, None, 0.25), None);
    assert_eq!(none.probability(&UPWARDS, None, 0), 0.0);
    let black = r#"<emitter type="point"><rgb name="intensity" value="0"/></emitter>"#;
    for only in [r#"<emitter type="constant"/>"#, r#"<emitter type="spot"/>"#] {
        let only = choice(&scene(&format!("{black}{only}")));
        assert!(!only.depends_on_surface());
        let chosen = ChosenLight {
            emitter: 1,
            probability: 1.0,
            remainder: 0.25,
            group: None,
        };
        assert_eq!(choose(&only, &UPWARDS, None, 0.25), Some(chosen));
        assert_eq!(only.probability(&UPWARDS, None, 0), 0.0);
        assert_eq!(only.probability(&UPWARDS, None, 1), 1.0);
    }
}

#[test]
fn lights_from_afar_stand_beside_the_tree() {
    let constant = r#"<emitter type="constant"/>"#;
    let scene = scene(&[POINT, constant, POINT, DIRECTIONAL, POINT].concat());
    let choice = choice(&scene);
    let receiver = Receiver {
        position: Vec3::X,
        ..UPWARDS
    };
    let probabilities = [0, 1, 2, 3, 4].map(|i| choice.probability(&receiver, None, i));
    assert_eq!((probabilities[1], probabilities[3]), (1.0 / 3.0, 1.0 / 3.0));
    for near in [0, 2, 4] {
        assert!(
            (1.0 / 15.0..1.0 / 5.0).contains(&probabilities[near]),
            "{probabilities:?}"
        );
    }
}

/// Lights are drawn with the probabilities that are told, which are a distribution but for places where a group promises
/// light and none of its parts does.
#[test]
fn choices_follow_their_probabilities() {
    const DRAWS: u32 = 20_000;
    for (near, distant) in [(2, 0), (3, 1), (0, 6), (10, 6), (100, 2), (100, 0)] {
        let count = near + distant;
        let scene = lamps_and_distant(near, distant, count as u32);
        let choice = choice(&scene);
        let mut random = random(99);
        for case in 0..20 {
            let receiver = surface(&mut random);
            let weights = GroupWeights([(); GROUPS].map(|()| 0.125 + 8.0 * random.uniform()));
            let weights = (case % 2 == 0).then_some(&weights);
            let mut counts = vec![0.0; count];
            let mut nothing = 0.0;
            for _ in 0..DRAWS {
                let u = random.uniform();
                let Some(chosen) = choose(&choice, &receiver, weights, u) else {
                    nothing += 1.0;
                    continue;
                };
                counts[chosen.emitter] += 1.0;
                let probability = choice.probability(&receiver, weights, chosen.emitter);
                assert_eq!(chosen.probability, probability);
                assert!((0.0..1.0).contains(&chosen.remainder));
            }
            let probabilities: Vec<f64> = (0..count)
                .map(|emitter| f64::from(choice.probability(&receiver, weights, emitter)))
                .collect();
            let total: f64 = probabilities.iter().sum();
            assert!(total < 1.0 + 1e-5, "{total}");
            let (mut statistic, mut freedom, mut rest) = (0.0, 0.0, [nothing, 1.0 - total]);
            for (count, probability) in counts.into_iter().zip(probabilities) {
                let expected = probability * f64::from(DRAWS);
                if expected < 8.0 {
                    rest = [rest[0] + count, rest[1] + probability];
                } else {
                    statistic += (count - expected) * (count - expected) / expected;
                    freedom += 1.0;
                }
            }
            let expected = rest[1].max(0.0) * f64::from(DRAWS);
            if expected >= 8.0 {
                statistic += (rest[0] - expected) * (rest[0] - expected) / expected;
                freedom += 1.0;
            } else {
                assert!(rest[0] < 30.0, "{rest:?}");
            }
            if freedom > 1.5 {
                let p = ChiSquared::new(freedom - 1.0).unwrap().sf(statistic);
                assert!(p > 1e-5, "{count} lamps: {statistic} of {freedom}, p = {p}");
            }
        }
    }
}

/// Of points above and below a surface, those below are chosen only where light goes through it.
#[test]
fn lights_below_the_surface_are_left_out() {
    let point = |z: f32| {
        format!(r#"<emitter type="point"><point name="position" x="1" y="2" z="{z}"/></emitter>"#)
    };
    let scene = scene(&[3.0, -3.0, 5.0, -4.0].map(point).concat());
    let choice = choice(&scene);
    let probabilities = |receiver| [0, 1, 2, 3].map(|i| choice.probability(&receiver, None, i));
    let [first, below, second, further_below] = probabilities(UPWARDS);
    assert_eq!((below, further_below), (0.0, 0.0));
    assert!(first > second && (first + second - 1.0).abs() < 1e-6);
    let through = probabilities(Receiver {
        scatters_below: true,
        ..UPWARDS
    });
    assert!(through.iter().all(|&p| p > 0.1), "{through:?}");
}

/// Every light is chosen in proportion to what is guessed of it times the weight of its group.
#[test]
fn groups_are_weighed() {
    // Two groups of points, and four of the lights from afar, of which the last has three.
    let scene = scene(&[POINT.repeat(2), DIRECTIONAL.repeat(6)].concat());
    let choice = choice(&scene);
    let receiver = Receiver {
        position: Vec3::X,
        scatters_below: true,
        ..UPWARDS
    };
    let weights = GroupWeights([0.5, 8.0, 1.0, 1.0, 2.0, 0.25, 1.0, 4.0]);
    let weigh = |group: ChosenGroup| weights.0[usize::from(group.number)];
    let weights = Some(&weights);
    let mut chosen_of = [None; 8];
    for i in 0..1000 {
        let chosen = choose(&choice, &receiver, weights, i as f32 / 1000.0);
        let chosen = chosen.expect("light arrives from everywhere");
        chosen_of[chosen.emitter] = chosen.group;
    }
    let groups = chosen_of.map(|group| group.expect("all are chosen at times"));
    assert_eq!(groups.map(|group| group.number), [0, 1, 4, 5, 6, 7, 7, 7]);
    // Each light from afar as much as both points together.
    let guessed = [0.5, 0.5, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0].map(|share| share / 7.0);
    let weighed = groups.map(weigh);
    let total: f32 = guessed
        .iter()
        .zip(weighed)
        .map(|(p, weight)| p * weight)
        .sum();
    for (emitter, group) in groups.into_iter().enumerate() {
        let expected = guessed[emitter] * weighed[emitter] / total;
        let probability = choice.probability(&receiver, weights, emitter);
        assert!(
            (probability - expected).abs() < 1e-6,
            "{emitter}: {probability}, {expected}"
        );
        let in_group = if emitter < 5 { 1.0 } else { 3.0 };
        assert!((group.guessed - in_group * guessed[emitter]).abs() < 1e-6);
        assert!((group.chosen - in_group * expected).abs() < 1e-6);
    }
}

/// Points that shine everywhere leave no place without light: the probabilities add up to 1.
#[test]
fn probabilities_add_up() {
    let mut text = String::new();
    let mut random = random(7);
    for _ in 0..50 {
        let [x, y, z] = [(); 3].map(|()| random.uniform());
        write!(
            text,
            r#"<emitter type="point"><point name="position" value="{x} {y} {z}"/></emitter>"#
        )
        .unwrap();
    }
    let choice = choice(&scene(&text));
    for _ in 0..100 {
        let receiver = Receiver {
            scatters_below: true,
            ..surface(&mut random)
        };
        let total: f32 = (0..50)
            .map(|i| choice.probability(&receiver, None, i))
            .sum();
        assert!((total - 1.0).abs() < 1e-4, "{total}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    /// Where a light does arrive, it can be chosen.
    #[test]
    fn light_that_arrives_can_be_chosen(count in 2_usize..40, seed in 0_u32..1 << 20) {
        let scene = lamps(count, seed);
        let choice = choice(&scene);
        let mut random = random(seed ^ 1);
        for _ in 0..50 {
            let receiver = surface(&mut random);
            for (index, emitter) in scene.emitters.iter().enumerate() {
                let u = random.uniform_2d();
                let sample = emitter.sample::<Rgb>(&scene.shapes, receiver.position, &(), u);
                if sample.is_some_and(|sample| sample.weight.0[0] > 0.0 && counts(&receiver, sample.direction)) {
                    let probability = choice.probability(&receiver, None, index);
                    prop_assert!(probability > 0.0, "{:?}", scene.emitters[index]);
                }
            }
        }
    }
}

/// The variance of direct light on a floor below 100 lamps, against that of choosing each alike.
#[test]
fn the_right_lamps_are_chosen() {
    let scene = lamps(100, 3);
    let choice = choice(&scene);
    let mut random = random(5);
    const DRAWS: usize = 10_000;
    const ROUNDS: usize = 41;
    let (mut chosen_means, mut uniform_means) = (vec![], vec![]);
    let (mut chosen_variances, mut uniform_variances) = (vec![], vec![]);
    for _ in 0..ROUNDS {
        let (mut of_chosen, mut of_any) = (Vec::new(), Vec::new());
        for _ in 0..DRAWS {
            let [x, z] = random.uniform_2d().map(|u| 20.0 * u - 10.0);
            let (position, normal) = (Vec3::new(x, -10.5, z), Vec3::Y);
            let receiver = Receiver {
                position,
                normal,
                scatters_below: false,
            };
            let u = random.uniform_2d();
            let arrives = |emitter: usize| {
                let sample = scene.emitters[emitter].sample::<Rgb>(&scene.shapes, position, &(), u);
                sample.map_or(0.0, |sample| {
                    f64::from(sample.weight.0[0] * sample.direction.dot(normal).max(0.0) / PI)
                })
            };
            let v = random.uniform();
            let chosen = choose(&choice, &receiver, None, v);
            of_chosen.push(chosen.map_or(0.0, |chosen| {
                arrives(chosen.emitter) / f64::from(chosen.probability)
            }));
            of_any.push(100.0 * arrives((v * 100.0) as usize));
        }
        chosen_means.push(of_chosen.iter().mean());
        uniform_means.push(of_any.iter().mean());
        chosen_variances.push(of_chosen.iter().variance());
        uniform_variances.push(of_any.iter().variance());
    }
    let means = [chosen_means.iter().mean(), uniform_means.iter().mean()];
    let variances = chosen_means.iter().variance() + uniform_means.iter().variance();
    let error = (variances / ROUNDS as f64).sqrt();
    assert!(
        (means[0] - means[1]).abs() < 4.0 * error,
        "{means:?} +- {error}"
    );
    // Close to a lamp there is no bound to what arrives, and now and then one draw is most of a variance: the median round tells.
    let [chosen, uniform] =
        [chosen_variances, uniform_variances].map(|all| Data::new(all).median());
    assert!(4.0 * chosen < uniform, "{chosen}, {uniform}");
}
