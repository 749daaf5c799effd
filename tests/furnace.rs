//! A closed sphere whose wall emits Le and reflects rho: every ray sees the radiance Le / (1 - rho), by every strategy.
//!
//! A path cut off after n segments sees Le (1 - rho^n) / (1 - rho).

mod support;

use std::num::NonZeroU32;
use std::sync::Arc;

use cohort::render::{ColourMode, Settings, WavelengthCount};
use cohort::sampling::SamplerKind;
use cohort::scene::{LoadOptions, Scene};
use cohort::transport::DirectLight;
use cohort::walk::{Rounding, Scope, StrategyKind, StrategyOptions};

use support::estimate::Estimate;
use support::files;
use support::render::{replicates, replicates_in_growing_passes};

/// What the wall emits, the same at all wavelengths.
const EMITTED: f64 = 0.5;

/// The integral of the CIE's table of luminous efficiency over what Mitsuba, and so the film, divides it by.
const LUMINANCE_OF_EQUAL_ENERGY: f64 = 106.856_895 / 106.750_259;

/// The room, seen from beside its centre.
fn room(reflectance: f64) -> Arc<Scene> {
    let text = format!(
        r#"<scene version="3.0.0">
            <integrator type="path"/>
            <sensor type="perspective">
                <float name="fov" value="70"/>
                <transform name="to_world"><lookat origin="0.3, -0.5, 0.2" target="1, 0, 0" up="0, 1, 0"/></transform>
                <film type="hdrfilm">
                    <integer name="width" value="8"/><integer name="height" value="8"/>
                    <rfilter type="box"/>
                </film>
            </sensor>
            <shape type="sphere">
                <float name="radius" value="2"/>
                <boolean name="flip_normals" value="true"/>
                <bsdf type="diffuse"><spectrum name="reflectance" value="{reflectance}"/></bsdf>
                <emitter type="area"><spectrum name="radiance" value="{EMITTED}"/></emitter>
            </shape>
        </scene>"#
    );
    let path = files::kept_folder("furnace").join(format!("furnace-{reflectance}.xml"));
    files::put(&path, |draft| {
        std::fs::write(draft, text).expect("the scene can be written");
    });
    Arc::new(Scene::load(path, &LoadOptions::default()).expect("the scene can be loaded"))
}

/// A case: who walks, how, and for how long.
struct Case {
    kind: StrategyKind,
    options: StrategyOptions,
    direct_light: DirectLight,
    sampler: SamplerKind,
    guiding: bool,
    max_depth: Option<u32>,
    spp: u32,
}

impl Case {
    fn new(kind: StrategyKind, max_depth: Option<u32>, spp: u32) -> Self {
        Self {
            kind,
            options: StrategyOptions::default(),
            direct_light: DirectLight::NextEvent,
            sampler: SamplerKind::Independent,
            guiding: false,
            max_depth,
            spp,
        }
    }

    fn settings(&self, colour: ColourMode) -> Settings {
        Settings {
            strategy: self
                .kind
                .build(&self.options)
                .expect("the options are the strategy's"),
            colour,
            direct_light: self.direct_light,
            sampler: self.sampler,
            guiding: self.guiding,
            max_depth: self.max_depth.and_then(NonZeroU32::new),
            ..Settings::default()
        }
    }

    /// Renders the room, and compares the mean of the image with the closed form; the relative standard error must be
    /// at most `largest_error`.
    fn check(&self, reflectance: f64, colour: ColourMode, largest_error: f64) {
        let light = match self.max_depth {
            Some(depth) => (1.0 - reflectance.powf(f64::from(depth))) / (1.0 - reflectance),
            None => 1.0 / (1.0 - reflectance),
        };
        let room = room(reflectance);
        // Equal energy at all wavelengths has the luminance of its radiance, but it is not the white of sRGB.
        let render = if self.guiding {
            replicates_in_growing_passes
        } else {
            replicates
        };
        let images = render(&room, self.settings(colour), 0..16, self.spp);
        let [.., estimate] = images.means();
        let expected = match colour {
            ColourMode::Rgb => EMITTED * light,
            ColourMode::Spectral(_) => EMITTED * light * LUMINANCE_OF_EQUAL_ENERGY,
        };
        let error = estimate.standard_error() / expected;
        let deviation = estimate.mean / expected - 1.0;
        let what = format!(
            "{} {:?} {:?} {}, guiding {}, depth {:?}, {}, reflectance {reflectance}: {:+.4} % (+-{:.4} %)",
            self.kind,
            self.options,
            self.direct_light,
            self.sampler,
            self.guiding,
            self.max_depth,
            colour.name(),
            100.0 * deviation,
            100.0 * error
        );
        println!("{what}");
        assert!(error <= largest_error, "{what}: too noisy to say anything");
        let exact = Estimate {
            mean: expected,
            variance: 0.0,
            count: 2,
        };
        assert!(estimate.z_of_difference(&exact).abs() <= 4.0, "{what}");
    }
}

const COLOURS: [ColourMode; 2] = [ColourMode::Rgb, ColourMode::Spectral(WavelengthCount::Four)];

/// Every strategy in a room of this reflectance. The relative standard errors must be at most `largest_error`.
fn every_strategy(reflectance: f64, spp: u32, largest_error: f64) {
    for kind in StrategyKind::ALL {
        // Fixed depth never ends by itself. Throughput roulette has an infinite variance in closed rooms whose
        // reflectance is above sqrt(0.95), so there only paths of limited length can be compared.
        let max_depth = match kind {
            StrategyKind::FixedDepth => Some(60),
            StrategyKind::ThroughputRoulette if reflectance > 0.95 => Some(30),
            _ => None,
        };
        for colour in COLOURS {
            Case::new(kind, max_depth, spp).check(reflectance, colour, largest_error);
        }
    }
}

#[test]
fn half_of_the_light_is_reflected() {
    every_strategy(0.5, 64, 0.005);
}

#[test]
fn nine_tenths_are_reflected() {
    every_strategy(0.9, 64, 0.01);
}

#[test]
fn ninety_nine_in_a_hundred_are_reflected() {
    every_strategy(0.99, 16, 0.02);
}

#[test]
fn nine_hundred_and_ninety_nine_in_a_thousand_are_reflected() {
    every_strategy(0.999, 2, 0.04);
}

/// With paths of two segments nothing is random but the light that the wall sends itself, which is known within
/// millionths: shadow rays that the curved wall itself stops, where they graze it, would show.
#[test]
fn the_wall_does_not_shade_itself() {
    for reflectance in [0.5, 0.9] {
        let case = Case::new(StrategyKind::FixedDepth, Some(2), 256);
        case.check(reflectance, ColourMode::Rgb, 3e-6);
    }
}

#[test]
fn without_next_event_estimation() {
    for reflectance in [0.5, 0.9, 0.99] {
        for kind in [
            StrategyKind::Roulette,
            StrategyKind::GoWithTheWinners,
            StrategyKind::ParticleFilter,
        ] {
            let case = Case {
                direct_light: DirectLight::Off,
                ..Case::new(kind, None, 32)
            };
            case.check(reflectance, ColourMode::Rgb, 0.02);
        }
    }
}

/// Strategies whose particles decide alone, and together.
const KINDS: [StrategyKind; 3] = [
    StrategyKind::Roulette,
    StrategyKind::GoWithTheWinners,
    StrategyKind::ParticleFilter,
];

/// Paths here are far longer than a Sobol sequence has dimensions.
#[test]
fn by_points_of_sequences() {
    for sampler in [SamplerKind::Sobol, SamplerKind::ArrayQmc] {
        for (reflectance, spp, largest_error) in [(0.9, 16, 0.01), (0.99, 4, 0.04)] {
            for kind in KINDS {
                let case = Case {
                    sampler,
                    ..Case::new(kind, None, spp)
                };
                case.check(reflectance, ColourMode::Rgb, largest_error);
            }
        }
    }
}

/// With every sampler, directions guided by what the passes before have learned; the more the wall reflects, the fewer
/// samples are paid for.
#[test]
fn with_guided_directions() {
    for (reflectance, spp, largest_error) in [
        (0.5, 32, 0.01),
        (0.9, 16, 0.02),
        (0.99, 4, 0.04),
        (0.999, 2, 0.1),
    ] {
        let all = KINDS.map(|kind| SamplerKind::ALL.map(|sampler| (kind, sampler)));
        for (index, (kind, sampler)) in all.into_iter().flatten().enumerate() {
            let case = Case {
                sampler,
                guiding: true,
                ..Case::new(kind, None, spp)
            };
            case.check(reflectance, COLOURS[index % 2], largest_error);
        }
    }
}

#[test]
fn every_population_and_every_way_to_draw() {
    for population in Scope::JOINT {
        for counts in Rounding::ALL {
            let case = Case {
                options: StrategyOptions {
                    population: Some(population),
                    counts: Some(counts),
                    ..StrategyOptions::default()
                },
                ..Case::new(StrategyKind::ParticleFilter, None, 32)
            };
            case.check(0.9, ColourMode::Rgb, 0.01);
        }
    }
}
