//! What absorbs nothing cannot be seen where the same light comes from everywhere, by every strategy.

mod support;

use std::num::NonZeroU32;
use std::sync::Arc;

use cohort::render::{ColourMode, Settings, WavelengthCount};
use cohort::sampling::SamplerKind;
use cohort::scene::{LoadOptions, Scene};
use cohort::walk::{StrategyKind, StrategyOptions};

use support::render::{replicates_in_growing_passes, replicates_with_rare_highlights};

/// The integral of the CIE's table of luminous efficiency over what Mitsuba, and so the film, divides it by.
const LUMINANCE_OF_EQUAL_ENERGY: f64 = 106.856_895 / 106.750_259;

/// What of the view a ball of `plastic` that absorbs nothing reflects. The Fresnel equations let it reflect all; but as in Mitsuba its inner reflectance is
/// that of a fit, 0.590479 where the integral over a hemisphere is 0.589992, so that its base returns 1.00119 times what enters it.
const PLASTIC: f64 = 1.00102;

/// A surface that absorbs nothing.
struct Surface {
    name: &'static str,
    bsdf: &'static str,
    /// How many samples a pixel needs to see nothing of it.
    samples: u32,
    /// What it makes of light of radiance 1 from everywhere, in the mean over the image.
    seen: f64,
}

const fn surface(name: &'static str, bsdf: &'static str, samples: u32) -> Surface {
    Surface {
        name,
        bsdf,
        samples,
        seen: 1.0,
    }
}

const SURFACES: [Surface; 10] = [
    surface(
        "diffuse",
        r#"<bsdf type="diffuse"><float name="reflectance" value="1"/></bsdf>"#,
        16,
    ),
    Surface {
        seen: PLASTIC,
        ..surface(
            "plastic",
            r#"<bsdf type="plastic"><float name="diffuse_reflectance" value="1"/></bsdf>"#,
            16,
        )
    },
    surface("dielectric", r#"<bsdf type="dielectric"/>"#, 32),
    surface(
        "dispersive dielectric",
        r#"<bsdf type="dielectric"><spectrum name="int_ior" type="sellmeier"><string name="glass" value="sf11"/></spectrum></bsdf>"#,
        96,
    ),
    surface(
        "dispersive dielectric by a table",
        r#"<bsdf type="dielectric"><spectrum name="int_ior" value="360:1.9, 500:1.6, 830:1.4"/></bsdf>"#,
        96,
    ),
    surface("thindielectric", r#"<bsdf type="thindielectric"/>"#, 16),
    surface("conductor", r#"<bsdf type="conductor"/>"#, 8),
    surface("null", r#"<bsdf type="null"/>"#, 8),
    surface(
        "mask",
        r#"<bsdf type="mask"><float name="opacity" value="0.3"/><bsdf type="twosided"><bsdf type="conductor"/></bsdf></bsdf>"#,
        64,
    ),
    surface(
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

const SPECTRAL: ColourMode = ColourMode::Spectral(WavelengthCount::Four);

const MORE_WAVELENGTHS: ColourMode = ColourMode::Spectral(WavelengthCount::Eight);

/// Renders every surface, whose image must be that of the light around it.
fn look(kind: StrategyKind, colour: ColourMode, sampler: SamplerKind, guiding: bool) {
    for Surface {
        name,
        bsdf,
        samples,
        seen,
    } in SURFACES
    {
        let strategy = kind.build(&StrategyOptions::default());
        let settings = Settings {
            strategy: strategy.expect("the defaults are good"),
            colour,
            sampler,
            guiding,
            // Hardly anything is left after so many reflections inside of the ball.
            max_depth: NonZeroU32::new(64),
            ..Settings::default()
        };
        let render = if guiding {
            replicates_in_growing_passes
        } else {
            replicates_with_rare_highlights
        };
        let images = render(&scene(bsdf), settings, 0..16, samples);
        let [.., estimate] = images.means();
        let expected = match colour {
            ColourMode::Rgb => seen,
            ColourMode::Spectral(_) => seen * LUMINANCE_OF_EQUAL_ENERGY,
        };
        let error = estimate.standard_error() / expected;
        let deviation = estimate.mean / expected - 1.0;
        let what = format!(
            "{name}, {kind}, {}, {sampler}, guiding {guiding}: {:+.4} % (+-{:.4} %)",
            colour.name(),
            100.0 * deviation,
            100.0 * error
        );
        println!("{what}");
        assert!(error <= 0.02, "{what}: too noisy to say anything");
        assert!(deviation.abs() <= 4.5 * error + 2e-4, "{what}");
    }
}

#[test]
fn what_absorbs_nothing_is_not_seen() {
    for kind in StrategyKind::ALL {
        look(kind, ColourMode::Rgb, SamplerKind::Independent, false);
        look(kind, SPECTRAL, SamplerKind::Independent, false);
        look(kind, MORE_WAVELENGTHS, SamplerKind::Sobol, false);
    }
}

/// Directions of smooth lobes are guided, those of discrete ones are left alone, also where a surface has both.
#[test]
fn nor_is_it_where_directions_are_guided() {
    let (roulette, filter) = (StrategyKind::Roulette, StrategyKind::ParticleFilter);
    look(roulette, ColourMode::Rgb, SamplerKind::Independent, true);
    look(roulette, SPECTRAL, SamplerKind::ArrayQmc, true);
    look(filter, MORE_WAVELENGTHS, SamplerKind::Sobol, true);
    look(filter, ColourMode::Rgb, SamplerKind::ArrayQmc, true);
}
