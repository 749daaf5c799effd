//! Guided directions: the same image as without, whatever was learned, with less noise where light comes from few directions.

mod support;

use std::num::NonZeroU32;
use std::path::PathBuf;
use std::sync::Arc;

use cohort::render::{ColourMode, Settings, WavelengthCount};
use cohort::sampling::SamplerKind;
use cohort::scene::{LoadOptions, Scene};
use cohort::walk::{StrategyKind, StrategyOptions};

use support::estimate::{Estimate, sidak_threshold};
use support::files;
use support::render::{many_emitters, replicates_in_growing_passes};
use support::room::{View, room};

const SPECTRAL: ColourMode = ColourMode::Spectral(WavelengthCount::Four);

fn settings(strategy: StrategyKind, sampler: SamplerKind, colour: ColourMode) -> Settings {
    let strategy = strategy.build(&StrategyOptions::default());
    Settings {
        strategy: strategy.expect("defaults are valid"),
        sampler,
        colour,
        guiding: true,
        // For the strategy that never ends a path.
        max_depth: NonZeroU32::new(12),
        ..Settings::default()
    }
}

/// A scene of 24 x 24 pixels.
fn small(path: &str) -> Arc<Scene> {
    let options = LoadOptions {
        definitions: vec![("size".into(), "24".into())],
        models: None,
    };
    let path: PathBuf = files::of_project(path);
    Arc::new(Scene::load(path, &options).expect("the scene can be loaded"))
}

/// The blocks of 8 x 8 pixels, in all channels, of images without and with guiding.
struct Blocks {
    plain: [Vec<Estimate>; 3],
    scene: Arc<Scene>,
    colour: ColourMode,
}

impl Blocks {
    /// Those of plain roulette.
    fn of(scene: Arc<Scene>, colour: ColourMode) -> Self {
        let plain = Settings {
            guiding: false,
            ..settings(StrategyKind::Roulette, SamplerKind::Independent, colour)
        };
        Self {
            plain: replicates_in_growing_passes(&scene, plain, 0..64, 32).blocks(8),
            scene,
            colour,
        }
    }

    /// Checks that guided images of a `strategy` and a `sampler` are the same, of which there are `cases`.
    fn check(&self, what: &str, strategy: StrategyKind, sampler: SamplerKind, cases: usize) {
        let settings = settings(strategy, sampler, self.colour);
        let guided = replicates_in_growing_passes(&self.scene, settings, 1000..1032, 32);
        let guided = guided.blocks(8);
        let pairs = guided.iter().flatten().zip(self.plain.iter().flatten());
        let limit = sidak_threshold(1e-3, cases * pairs.clone().count());
        let mut largest = 0.0_f64;
        for (block, (a, b)) in pairs.enumerate() {
            let z = a.z_of_difference(b);
            largest = largest.max(z.abs());
            assert!(
                z.abs() < limit,
                "{what}, {strategy}, {sampler}, block {block}: {a:?} {b:?}, z = {z}"
            );
        }
        println!("{what}, {strategy}, {sampler}: |z| up to {largest:.2} of {limit:.2}");
    }
}

#[test]
fn every_strategy_renders_the_same_image_guided_as_not() {
    let blocks = Blocks::of(many_emitters(24), ColourMode::Rgb);
    let cases = SamplerKind::ALL.len() * StrategyKind::ALL.len();
    for sampler in SamplerKind::ALL {
        for strategy in StrategyKind::ALL {
            blocks.check("many emitters", strategy, sampler, cases);
        }
    }
}

/// Rough metal and glass, mirrors, plastics, mixtures, masks, textures, instances, dispersion.
#[test]
fn every_surface_looks_the_same_guided_as_not() {
    let scenes = [
        ("tests/scenes/metals-and-glass.xml", ColourMode::Rgb),
        ("tests/scenes/plastics.xml", ColourMode::Rgb),
        ("tests/scenes/textures.xml", SPECTRAL),
        ("tests/scenes/instances.xml", SPECTRAL),
        ("scenes/gallery/dispersion.xml", SPECTRAL),
    ];
    let cases = [
        (StrategyKind::Roulette, SamplerKind::Independent),
        (StrategyKind::Roulette, SamplerKind::ArrayQmc),
        (StrategyKind::ParticleFilter, SamplerKind::ArrayQmc),
    ];
    for (path, colour) in scenes {
        let blocks = Blocks::of(small(path), colour);
        for (strategy, sampler) in cases {
            blocks.check(path, strategy, sampler, scenes.len() * cases.len());
        }
    }
}

/// A floor between two lamps of the same brightness, of which a wall hides one.
const HIDDEN: &str = r#"<scene version="3.0.0">
    <integrator type="path"><integer name="max_depth" value="2"/></integrator>
    <sensor type="perspective">
        <float name="fov" value="40"/>
        <transform name="to_world"><lookat origin="0 0 5" target="0 0 0" up="0 1 0"/></transform>
        <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="16"/><rfilter type="box"/></film>
    </sensor>
    <shape type="rectangle"><transform name="to_world"><scale value="2"/></transform></shape>
    <shape type="rectangle">
        <transform name="to_world"><scale value="3"/><rotate y="1" angle="90"/><translate x="2.1"/></transform>
    </shape>
    <emitter type="point"><point name="position" x="-3" y="0" z="3"/></emitter>
    <emitter type="point"><point name="position" x="3" y="0" z="2.5"/></emitter>
</scene>"#;

#[test]
fn lamps_that_are_hidden_are_hardly_looked_at() {
    let scene = Scene::from_xml(HIDDEN, &LoadOptions::default());
    let scene = Arc::new(scene.expect("the scene can be loaded"));
    let images = [true, false].map(|guiding| {
        let settings = Settings {
            guiding,
            ..settings(
                StrategyKind::Roulette,
                SamplerKind::Independent,
                ColourMode::Rgb,
            )
        };
        replicates_in_growing_passes(&scene, settings, 0..24, 64)
    });
    let noise = images.each_ref().map(|images| -> f64 {
        let blocks = images.blocks(1);
        blocks.iter().flatten().map(|pixel| pixel.variance).sum()
    });
    // Chosen with probability p, the other lamp leaves a variance of (1 - p) / p: about 1 by what is guessed, a tenth and less where it is known.
    let ratio = noise[0] / noise[1];
    println!("{ratio:.3} of the variance");
    assert!(ratio < 0.4, "{ratio:.3} of the variance");
    let [guided, plain] = images.each_ref().map(|images| images.means());
    for (guided, plain) in guided.iter().zip(&plain) {
        let z = guided.z_of_difference(plain);
        assert!(z.abs() < 4.0, "{guided:?} {plain:?}");
    }
}

/// The variance between renders of 64 samples a pixel, summed over all pixels.
fn noise(scene: &Arc<Scene>, settings: Settings) -> f64 {
    let images = replicates_in_growing_passes(scene, settings, 0..24, 64);
    let blocks = images.blocks(1);
    blocks.iter().flatten().map(|pixel| pixel.variance).sum()
}

/// How much of the variance guiding leaves where a wall is of plastic, and a lamp hangs in a room: `lamp` are its transforms, `plastic` are parameters.
fn left_by_guiding_of_plastic(lamp: &str, plastic: &str) -> f64 {
    let view = View {
        side: 16,
        field_of_view: 60,
        origin: "0, 0, -0.5",
        target: "0, 0, 1",
    };
    let wall = format!(
        r#"<shape type="rectangle">
            <transform name="to_world"><rotate y="1" angle="180"/><translate z="0.99"/></transform>
            <bsdf type="plastic">{plastic}</bsdf>
        </shape>"#
    );
    let scene = room(&view, lamp, &wall);
    let noise = |guiding| {
        let settings = Settings {
            guiding,
            ..settings(
                StrategyKind::Roulette,
                SamplerKind::ArrayQmc,
                ColourMode::Rgb,
            )
        };
        noise(&scene, settings)
    };
    let left = noise(true) / noise(false);
    println!("{left:.3} of the variance");
    left
}

/// All light comes from one spot on the ceiling, and most is reflected by the base.
#[test]
fn bases_of_plastics_are_guided() {
    let lamp = r#"<rotate x="1" angle="-90"/><translate x="0.6" y="0.9" z="0.6"/>"#;
    let plastic =
        r#"<float name="int_ior" value="1.5"/><rgb name="diffuse_reflectance" value="0.8"/>"#;
    assert!(left_by_guiding_of_plastic(lamp, plastic) < 0.9);
}

/// Most noise is in the mirror image of the lamp, which only the coat finds: with fewer directions for it there would be several times as much.
#[test]
fn coats_keep_their_directions_where_bases_are_guided() {
    let lamp = r#"<rotate x="1" angle="90"/><translate y="0.9"/>"#;
    let plastic =
        r#"<float name="int_ior" value="2.5"/><rgb name="diffuse_reflectance" value="0.1"/>"#;
    assert!(left_by_guiding_of_plastic(lamp, plastic) < 2.0);
}

#[test]
fn guided_directions_leave_less_noise() {
    // The lamp faces the ceiling, near which it hangs: all light comes from one spot.
    let view = View {
        side: 16,
        field_of_view: 60,
        origin: "0, -0.2, -0.95",
        target: "0, -0.3, 0",
    };
    let lamp = r#"<rotate x="1" angle="-90"/><translate x="0.6" y="0.9" z="0.6"/>"#;
    let scene = room(&view, lamp, "");
    for sampler in SamplerKind::ALL {
        let noise = |guiding| {
            let settings = Settings {
                guiding,
                ..settings(StrategyKind::Roulette, sampler, ColourMode::Rgb)
            };
            noise(&scene, settings)
        };
        let [plain, guided]: [f64; 2] = [noise(false), noise(true)];
        println!(
            "{sampler}: variance {plain:.3e}, guided {guided:.3e}: {:.2}",
            plain / guided
        );
        assert!(guided < 0.85 * plain, "{sampler}: {guided} against {plain}");
    }
}

/// Rough metal reflects the lamp or the dark, from the same place: learned counts tell that apart by where its lobes point.
#[test]
fn paths_are_followed_to_where_lobes_find_light() {
    let options = LoadOptions {
        definitions: vec![("size".into(), "48".into())],
        models: None,
    };
    let scene = Scene::load(
        files::of_project("scenes/gallery/rough-metal.xml"),
        &options,
    );
    let scene = Arc::new(scene.expect("the scene can be loaded"));
    let noise = |strategy| {
        let settings = settings(strategy, SamplerKind::ArrayQmc, ColourMode::Rgb);
        noise(&scene, settings)
    };
    // Counts by the place alone leave about 0.8 of roulette's variance with as many samples.
    let ratio = noise(StrategyKind::ParticleFilter) / noise(StrategyKind::Roulette);
    println!("{ratio:.3} of the variance");
    assert!(ratio < 0.7, "{ratio:.3} of the variance");
}
