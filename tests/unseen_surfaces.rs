//! What absorbs nothing cannot be seen where the same light comes from everywhere, by every strategy.

mod support;

use std::num::NonZeroU32;
use std::sync::Arc;

use cohort::render::{ColourMode, Settings, WavelengthCount};
use cohort::sampling::SamplerKind;
use cohort::scene::{LoadOptions, Scene};
use cohort::walk::{StrategyKind, StrategyOptions};

use support::render::replicates_with_rare_highlights;

/// The integral of the CIE's table of luminous efficiency over what Mitsuba, and so the film, divides it by.
const LUMINANCE_OF_EQUAL_ENERGY: f64 = 106.856_895 / 106.750_259;

/// Surfaces that absorb nothing, and how many samples a pixel needs to see nothing of them.
const SURFACES: [(&str, &str, u32); 8] = [
    ("dielectric", r#"<bsdf type="dielectric"/>"#, 32),
    (
        "dispersive dielectric",
        r#"<bsdf type="dielectric"><spectrum name="int_ior" type="sellmeier"><string name="glass" value="sf11"/></spectrum></bsdf>"#,
        96,
    ),
    (
        "dispersive dielectric by a table",
        r#"<bsdf type="dielectric"><spectrum name="int_ior" value="360:1.9, 500:1.6, 830:1.4"/></bsdf>"#,
        96,
    ),
    ("thindielectric", r#"<bsdf type="thindielectric"/>"#, 16),
    ("conductor", r#"<bsdf type="conductor"/>"#, 8),
    ("null", r#"<bsdf type="null"/>"#, 8),
    (
        "mask",
        r#"<bsdf type="mask"><float name="opacity" value="0.3"/><bsdf type="twosided"><bsdf type="conductor"/></bsdf></bsdf>"#,
        64,
    ),
    (
        "blendbsdf",
        r#"<bsdf type="blendbsdf"><float name="weight" value="0.3"/><bsdf type="thindielectric"/>
            <bsdf type="twosided"><bsdf type="diffuse"><float name="reflectance" value="1"/></bsdf></bsdf></bsdf>"#,
        64,
    ),
];

/// A ball that fills the view, in light of radiance 1 from everywhere.
fn scene(bsdf: &str) -> Arc<Scene> {
    let text = format!(
        r#"<scene version="3.0.0">
            <integrator type="path"/>
            <sensor type="perspective">
                <float name="fov" value="25"/>
                <transform name="to_world"><lookat origin="0.3, -0.5, 4" target="0, 0, 0" up="0, 1, 0"/></transform>
                <film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/><rfilter type="box"/></film>
            </sensor>
            <shape type="sphere">{bsdf}</shape>
            <emitter type="constant"><spectrum name="radiance" value="1"/></emitter>
        </scene>"#
    );
    Arc::new(Scene::from_xml(&text, &LoadOptions::default()).expect("the scene can be loaded"))
}

#[test]
fn what_absorbs_nothing_is_not_seen() {
    for (name, bsdf, spp) in SURFACES {
        let scene = scene(bsdf);
        for kind in StrategyKind::ALL {
            for (colour, sampler) in [
                (ColourMode::Rgb, SamplerKind::Independent),
                (
                    ColourMode::Spectral(WavelengthCount::Four),
                    SamplerKind::Independent,
                ),
                (
                    ColourMode::Spectral(WavelengthCount::Eight),
                    SamplerKind::Sobol,
                ),
            ] {
                let strategy = kind.build(&StrategyOptions::default());
                let settings = Settings {
                    strategy: strategy.expect("the defaults are good"),
                    colour,
                    sampler,
                    // Hardly anything is left after so many reflections inside of the ball.
                    max_depth: NonZeroU32::new(64),
                    ..Settings::default()
                };
                let images = replicates_with_rare_highlights(&scene, settings, 0..16, spp);
                let [.., estimate] = images.means();
                let expected = match colour {
                    ColourMode::Rgb => 1.0,
                    ColourMode::Spectral(_) => LUMINANCE_OF_EQUAL_ENERGY,
                };
                let error = estimate.standard_error() / expected;
                let deviation = estimate.mean / expected - 1.0;
                let what = format!(
                    "{name}, {kind}, {}, {sampler}: {:+.4} % (+-{:.4} %)",
                    colour.name(),
                    100.0 * deviation,
                    100.0 * error
                );
                println!("{what}");
                assert!(error <= 0.02, "{what}: too noisy to say anything");
                assert!(deviation.abs() <= 4.5 * error + 2e-4, "{what}");
            }
        }
    }
}
