//! Lights and cameras against closed forms.

mod support;

use std::f64::consts::PI;
use std::path::Path;
use std::sync::Arc;

use cohort::render::{ColourMode, Settings};
use cohort::sampling::SamplerKind;
use cohort::scene::{LoadOptions, Scene};
use cohort::transport::DirectLight;
use glam::DVec3;

use support::render::replicates;

const BOX_FILM: &str = r#"<film type="hdrfilm">
    <integer name="width" value="8"/><integer name="height" value="8"/><rfilter type="box"/></film>"#;

fn scene(text: &str) -> Arc<Scene> {
    let text = format!(r#"<scene version="3.0.0">{text}</scene>"#);
    let scene = Scene::from_xml(&text, &LoadOptions::default());
    Arc::new(scene.unwrap_or_else(|error| panic!("{error}")))
}

fn settings(sampler: SamplerKind) -> Settings {
    Settings {
        colour: ColourMode::Rgb,
        sampler,
        ..Settings::default()
    }
}

/// Writes an image of one colour and returns the name of the file.
fn plain_sky(folder: &Path, rgb: [f32; 3]) -> String {
    let path = folder.join("plain.pfm");
    let mut bytes = b"PF\n5 4\n-1\n".to_vec();
    for _ in 0..20 {
        bytes.extend(rgb.iter().flat_map(|value| value.to_le_bytes()));
    }
    std::fs::write(&path, bytes).expect("the image can be written");
    path.display().to_string()
}

/// A convex body of reflectance rho below a sky of radiance L has the radiance rho L everywhere, and the sky itself has L:
/// for an image of one colour as for `constant`.
#[test]
fn a_sky_of_one_colour_is_a_furnace() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let file = plain_sky(folder.path(), [0.5, 1.0, 2.0]);
    let image = format!(
        r#"<emitter type="envmap"><string name="filename" value="{file}"/>
           <transform name="to_world"><rotate x="1" angle="35"/></transform></emitter>"#
    );
    let constant = r#"<emitter type="constant"><rgb name="radiance" value="0.5 1 2"/></emitter>"#;
    for (sky, largest_error) in [(image.as_str(), 2e-3), (constant, 2e-3)] {
        for (fov, reflectance) in [(10.0, 0.6), (10.0, 0.0)] {
            let scene = scene(&format!(
                r#"<integrator type="path"/>
                <sensor type="perspective"><float name="fov" value="{fov}"/>
                    <transform name="to_world"><lookat origin="4 1 2" target="0 0 0" up="0 0 1"/></transform>{BOX_FILM}</sensor>
                <shape type="sphere"><bsdf type="diffuse"><rgb name="reflectance" value="{reflectance}"/></bsdf></shape>{sky}"#
            ));
            let ours = replicates(&scene, settings(SamplerKind::Independent), 0..16, 256);
            for (channel, radiance) in [0.5, 1.0, 2.0].into_iter().enumerate() {
                let mean = ours.means()[channel];
                let expected = reflectance * radiance;
                let error = mean.standard_error();
                assert!(error <= largest_error * radiance, "{error}");
                let deviation = (mean.mean - expected).abs();
                assert!(
                    deviation <= 4.0 * error + 1e-5,
                    "{} instead of {expected}",
                    mean.mean
                );
            }
        }
    }
}

/// The same for a convex body in an instance, wherever that stands: far away; large; stretched; and where the group's own coordinates
/// are as large as those of the translation that takes them back, so that rays lose digits on the way to the group's space.
#[test]
fn an_instance_is_a_furnace_wherever_it_stands() {
    let turned = r#"<rotate x="0.6" y="0.48" z="0.64" angle="40"/>"#;
    // R (300, -200, 100) with that rotation R.
    let back = r#"<translate x="-363.719206" y="51.740721" z="70.931214"/>"#;
    for (plugin, own, to_world, [x, y, z], size) in [
        ("sphere", "", "", [0.0, 0.0, 0.0], 1.0),
        ("cube", "", turned, [0.0, 0.0, 0.0], 1.0),
        (
            "sphere",
            "",
            r#"<scale value="1e4"/>"#,
            [0.0, 0.0, 0.0],
            1e4,
        ),
        (
            "sphere",
            "",
            r#"<rotate y="1" angle="30"/><scale x="-1" y="0.5" z="0.8"/>"#,
            [0.0, 0.0, 0.0],
            0.7,
        ),
        (
            "cube",
            "",
            r#"<rotate x="0.6" y="0.48" z="0.64" angle="40"/><translate x="500" y="-300" z="400"/>"#,
            [500.0, -300.0, 400.0],
            1.0,
        ),
        (
            "cube",
            r#"<translate x="300" y="-200" z="100"/>"#,
            &format!("{turned}{back}"),
            [0.0, 0.0, 0.0],
            1.0,
        ),
    ] {
        // A camera that sees nothing but the body.
        let eye = [x + 4.0 * size, y + size, z + 2.0 * size];
        let scene = scene(&format!(
            r#"<integrator type="path"/>
            <sensor type="perspective"><float name="fov" value="5"/><float name="near_clip" value="1e-3"/><float name="far_clip" value="1e6"/>
                <transform name="to_world"><lookat origin="{} {} {}" target="{x} {y} {z}" up="0 0 1"/></transform>{BOX_FILM}</sensor>
            <shape type="shapegroup" id="group">
                <shape type="{plugin}"><transform name="to_world">{own}</transform>
                    <bsdf type="diffuse"><rgb name="reflectance" value="0.6"/></bsdf></shape></shape>
            <shape type="instance"><ref id="group"/><transform name="to_world">{to_world}</transform></shape>
            <emitter type="constant"><rgb name="radiance" value="1"/></emitter>"#,
            eye[0], eye[1], eye[2],
        ));
        let ours = replicates(&scene, settings(SamplerKind::Independent), 0..16, 256);
        let [mean, ..] = ours.means();
        let deviation = (mean.mean - 0.6).abs();
        let allowed = 4.0 * mean.standard_error() + 1e-5;
        assert!(deviation <= allowed, "{plugin} {to_world}: {}", mean.mean);
    }
}

/// A plane, seen from above in a few points about its middle. `light` lights it.
fn plane(light: &str) -> Arc<Scene> {
    scene(&format!(
        r#"<integrator type="path"><integer name="max_depth" value="2"/></integrator>
        <sensor type="perspective"><float name="fov" value="0.05"/>
            <transform name="to_world"><lookat origin="0.5 0 8" target="0 0 0" up="0 1 0"/></transform>{BOX_FILM}</sensor>
        <shape type="rectangle"><transform name="to_world"><scale value="5"/></transform>
            <bsdf type="diffuse"><rgb name="reflectance" value="0.7"/></bsdf></shape>{light}"#
    ))
}

/// The mean radiance of that plane.
fn lit_plane(light: &str) -> f64 {
    let scene = plane(light);
    let ours = replicates(&scene, settings(SamplerKind::Independent), 0..64, 4);
    let [mean, ..] = ours.means();
    mean.mean
}

#[track_caller]
fn assert_near(value: f64, expected: f64) {
    assert!(
        (value / expected - 1.0).abs() < 1e-3,
        "{value} instead of {expected}"
    );
}

/// A convex body under a constant light sends back what its parts reflect, in their shares.
#[test]
fn a_blend_reflects_the_shares_of_its_parts() {
    let scene = scene(&format!(
        r#"<integrator type="path"/>
        <sensor type="perspective"><float name="fov" value="5"/>
            <transform name="to_world"><lookat origin="0 0 20" target="0 0 0" up="0 1 0"/></transform>{BOX_FILM}</sensor>
        <shape type="sphere"><float name="radius" value="2"/><bsdf type="blendbsdf"><float name="weight" value="0.25"/>
            <bsdf type="diffuse"><rgb name="reflectance" value="0.5"/></bsdf><bsdf type="conductor"/></bsdf></shape>
        <emitter type="constant"><rgb name="radiance" value="1"/></emitter>"#
    ));
    let ours = replicates(&scene, settings(SamplerKind::Independent), 0..64, 256);
    let [mean, ..] = ours.means();
    let expected = 0.75 * 0.5 + 0.25;
    assert!((mean.mean / expected - 1.0).abs() < 3e-3, "{}", mean.mean);
}

/// rho / pi E cos
#[test]
fn the_sun_lights_a_plane_by_the_cosine() {
    let light = r#"<emitter type="directional"><vector name="direction" x="3" y="0" z="-4"/>
        <rgb name="irradiance" value="2"/></emitter>"#;
    assert_near(lit_plane(light), 0.7 / PI * 2.0 * 0.8);
    let below = light.replace("-4", "4");
    assert_eq!(lit_plane(&below), 0.0);
}

/// rho / pi I cos / r^2, full within the beam, half in the middle of the transition.
#[test]
fn a_spot_lights_a_plane_by_its_intensity() {
    let light = |aim: f64| {
        format!(
            r#"<emitter type="spot"><rgb name="intensity" value="9"/><float name="cutoff_angle" value="20"/>
            <float name="beam_width" value="10"/>
            <transform name="to_world"><rotate y="1" angle="{}"/><translate x="-3" z="4"/></transform></emitter>"#,
            // From straight down towards the plane's middle, and `aim` degrees beside it.
            180.0 - (0.75_f64).atan().to_degrees() + aim,
        )
    };
    let full = 0.7 / PI * 9.0 * 0.8 / 25.0;
    assert_near(lit_plane(&light(0.0)), full);
    assert_near(lit_plane(&light(9.9)), full);
    assert_near(lit_plane(&light(15.0)), 0.5 * full);
    assert_eq!(lit_plane(&light(20.1)), 0.0);
}

/// The irradiance at the origin, of a surface that faces +z, by a polygon of radiance 1 above it: Lambert's formula.
fn irradiance_of_polygon(corners: &[DVec3]) -> f64 {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let parts = edges.map(|(a, b)| {
        let normal = a.cross(*b).normalize();
        a.angle_between(*b) * normal.z
    });
    0.5 * parts.sum::<f64>().abs()
}

/// Squares that glow light a plane as much as each of them does by its place, however they are found.
#[test]
fn a_glowing_checkerboard_lights_a_plane_by_its_squares() {
    let lamp = r#"<shape type="rectangle"><transform name="to_world"><rotate x="1" angle="180"/><translate x="2" y="0.5" z="1.5"/></transform>
        <emitter type="area"><texture type="checkerboard" name="radiance"><float name="color0" value="5"/><float name="color1" value="1"/>
            </texture></emitter></shape>"#;
    // u grows with x, and v with -y.
    let square = |u: f64, v: f64| {
        let corner = |u: f64, v: f64| DVec3::new(1.0 + 2.0 * u, 1.5 - 2.0 * v, 1.5);
        irradiance_of_polygon(&[
            corner(u, v),
            corner(u + 0.5, v),
            corner(u + 0.5, v + 0.5),
            corner(u, v + 0.5),
        ])
    };
    let expected = 0.7 / PI
        * (5.0 * (square(0.0, 0.0) + square(0.5, 0.5)) + square(0.5, 0.0) + square(0.0, 0.5));
    for (direct_light, spp) in [(DirectLight::NextEvent, 64), (DirectLight::Off, 512)] {
        let settings = Settings {
            direct_light,
            ..settings(SamplerKind::Independent)
        };
        let [mean, ..] = replicates(&plane(lamp), settings, 0..64, spp).means();
        let error = mean.standard_error();
        assert!(error < 4e-3 * expected, "{error}");
        let deviation = (mean.mean - expected).abs();
        assert!(
            deviation < 4.0 * error,
            "{} instead of {expected}",
            mean.mean
        );
    }
}

/// The edge of a glowing half plane at the depth z, by a lens of radius r that is in focus at f: at the distance d from the
/// edge, in the half plane's own plane, the lens sees the share of a disk of radius r |1 - z/f| that lies beyond the edge.
#[test]
fn an_edge_out_of_focus_is_a_segment_of_the_lens() {
    const WIDTH: usize = 32;
    let (radius, focus, depth) = (0.3_f64, 2.0_f64, 5.0_f64);
    // One pass of a Sobol sequence is one unit, of which the film does not know the noise.
    for (sampler, images, spp) in [
        (SamplerKind::Independent, 16, 256),
        (SamplerKind::Sobol, 128, 16),
    ] {
        let scene = scene(&format!(
            r#"<integrator type="path"><integer name="max_depth" value="1"/></integrator>
            <sensor type="thinlens"><float name="fov" value="30"/><float name="aperture_radius" value="{radius}"/>
                <float name="focus_distance" value="{focus}"/>
                <transform name="to_world"><lookat origin="0 0 0" target="0 0 -1" up="0 1 0"/></transform>
                <film type="hdrfilm"><integer name="width" value="{WIDTH}"/><integer name="height" value="4"/>
                    <rfilter type="box"/></film></sensor>
            <shape type="rectangle"><transform name="to_world"><scale value="50"/>
                <translate x="50" z="-{depth}"/></transform>
                <emitter type="area"><rgb name="radiance" value="1"/></emitter></shape>"#
        ));
        let ours = replicates(&scene, settings(sampler), 0..images, spp);
        let half_width = depth * (15.0_f64).to_radians().tan();
        let blur = radius * (1.0 - depth / focus).abs();
        // The share of a unit disk with x > -d.
        let share = |d: f64| {
            let d = d.clamp(-1.0, 1.0);
            1.0 - (d.acos() - d * (1.0 - d * d).sqrt()) / PI
        };
        let [red, ..] = ours.blocks(1);
        let mut worst: f64 = 0.0;
        for (pixel, estimate) in red.iter().enumerate() {
            let steps = 64;
            let expected: f64 = (0..steps)
                .map(|step| {
                    let column =
                        (pixel % WIDTH) as f64 + (f64::from(step) + 0.5) / f64::from(steps);
                    let x = half_width * (2.0 * column / WIDTH as f64 - 1.0);
                    share(x / blur) / f64::from(steps)
                })
                .sum();
            let allowed = 5.0 * estimate.standard_error() + 1e-3;
            worst = worst.max((estimate.mean - expected).abs() / allowed);
        }
        assert!(worst < 1.0, "{sampler}: {worst} times what is allowed");
    }
}
