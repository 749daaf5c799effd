use super::*;
use crate::scene::{LoadOptions, Scene};
use crate::spectrum::{Rgb, Spectral, SpectralCurve, Wavelengths};

/// The emitters of a scene with this inside.
pub(super) fn load_all(text: &str) -> Result<Scene, String> {
    let text = format!(r#"<scene version="3.0.0"><sensor type="perspective"/>{text}</scene>"#);
    Scene::from_xml(&text, &LoadOptions::default()).map_err(|error| error.to_string())
}

/// The emitter of this plugin with these parameters.
pub(super) fn emitter(plugin: &str, parameters: &str) -> Emitter {
    let text = format!(r#"<emitter type="{plugin}">{parameters}</emitter>"#);
    load_all(&text).unwrap().emitters.remove(0)
}

/// Why an emitter of this plugin cannot have these parameters.
fn refusal(plugin: &str, parameters: &str) -> String {
    let text = format!(r#"<emitter type="{plugin}">{parameters}</emitter>"#);
    load_all(&text).unwrap_err()
}

#[track_caller]
pub(super) fn assert_close(values: &[f32], expected: &[f32], relative: f32) {
    assert_eq!(values.len(), expected.len());
    for (value, expected) in values.iter().zip(expected) {
        let allowed = relative * expected.abs().max(1e-3);
        assert!(
            (value - expected).abs() <= allowed,
            "{values:?} instead of {expected:?}"
        );
    }
}

/// Where Mitsuba was asked for spectral values.
pub(super) const NM: [f32; 4] = [410.0, 480.0, 550.0, 650.0];

/// Compares what arrives at `reference` with Mitsuba's direction, distance and weights: `sample_direction` of
/// `scalar_rgb` and, at [`NM`], of `scalar_spectral`.
#[track_caller]
fn check_delta(
    light: &Emitter,
    reference: [f32; 3],
    direction: [f32; 3],
    distance: f32,
    rgb: [f32; 3],
    spectral: [f32; 4],
) {
    assert!(light.is_delta());
    let sample = light
        .sample::<Rgb>(&[], reference.into(), &(), [0.3, 0.6])
        .unwrap();
    assert_close(&sample.direction.to_array(), &direction, 1e-4);
    assert!(sample.distance == distance || (sample.distance - distance).abs() < 1e-4);
    assert_close(&sample.weight.0, &rgb, 1e-4);
    assert!(sample.pdf.is_none());
    let sample = light
        .sample::<Spectral<4>>(&[], reference.into(), &Wavelengths::at(NM), [0.3, 0.6])
        .unwrap();
    // Spectra of colours differ by as much from those of Mitsuba's table.
    assert_close(&sample.weight.0, &spectral, 3e-3);
}

/// `mi.load_dict({'type': 'spot', …}).sample_direction(it, [.5, .5])` at points `it.p` in the beam, in its transition and
/// outside.
#[test]
fn spots_are_mitsubas() {
    let light = emitter(
        "spot",
        r#"<rgb name="intensity" value="2 3 4"/><float name="cutoff_angle" value="40"/><float name="beam_width" value="10"/>
           <transform name="to_world"><lookat origin="1 2 3" target="0 0 1" up="0 0 1"/></transform>"#,
    );
    let third = 1.0 / 3.0;
    check_delta(
        &light,
        [0.0, 0.0, 1.0],
        [third, 2.0 * third, 2.0 * third],
        3.0,
        [0.222222, 0.333333, 0.444444],
        [0.436857, 0.472365, 0.341567, 0.175162],
    );
    check_delta(
        &light,
        [0.0, 1.0, 0.0],
        [0.301511, 0.301511, 0.904534],
        3.316625,
        [0.0894582, 0.134187, 0.178916],
        [0.175862, 0.190156, 0.137502, 0.0705134],
    );
    let outside = Vec3::new(3.0, 3.0, 3.0);
    assert!(light.sample::<Rgb>(&[], outside, &(), [0.5; 2]).is_none());
    // An elliptical cone, twice as wide along y; intensity and beam are the defaults.
    let light = emitter(
        "spot",
        r#"<float name="cutoff_angle" value="40"/><transform name="to_world"><scale x="1" y="2" z="1"/></transform>"#,
    );
    check_delta(
        &light,
        [1.0, 0.0, 1.4],
        [-0.581238, 0.0, -0.813733],
        1.720465,
        [0.150754; 3],
        [0.139316, 0.176529, 0.158442, 0.121866],
    );
    check_delta(
        &light,
        [0.0, 0.9, 0.8],
        [0.0, -0.747409, -0.664364],
        1.204159,
        [0.689655; 3],
        [0.637328, 0.807565, 0.724826, 0.557498],
    );
}

#[test]
fn spots_that_cannot_be_are_refused() {
    let degrees = |name: &str, value: f64| format!(r#"<float name="{name}" value="{value}"/>"#);
    for angle in [0.0, -5.0, 181.0] {
        assert!(refusal("spot", &degrees("cutoff_angle", angle)).contains("cutoff_angle"));
    }
    for angle in [-1.0, 20.5] {
        assert!(refusal("spot", &degrees("beam_width", angle)).contains("beam_width"));
    }
    let flat = r#"<transform name="to_world"><matrix value="1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1"/></transform>"#;
    assert!(refusal("spot", flat).contains("inverse"));
    let texture = r#"<texture type="checkerboard" name="texture"/>"#;
    let wide = format!("{texture}{}", degrees("cutoff_angle", 90.0));
    assert!(refusal("spot", &wide).contains("below 90"));
    let volume = r#"<texture type="volume" name="texture"/>"#;
    assert!(refusal("spot", volume).contains("not supported"));
}

/// A beam as wide as the cutoff has no transition.
#[test]
fn spots_may_end_sharply() {
    let light = emitter(
        "spot",
        r#"<float name="cutoff_angle" value="45"/><float name="beam_width" value="45"/>"#,
    );
    let arrives = |x: f32| {
        let sample = light.sample::<Rgb>(&[], Vec3::new(x, 0.0, 1.0), &(), [0.5; 2]);
        sample.map_or(0.0, |sample| sample.weight.0[0] * (1.0 + x * x))
    };
    assert_close(&[arrives(0.0), arrives(0.99)], &[1.0, 1.0], 1e-6);
    assert_eq!(arrives(1.01), 0.0);
}

#[test]
fn directional_lights_are_mitsubas() {
    let spectral = [3.93171, 4.25129, 3.0741, 1.57645];
    let light = emitter(
        "directional",
        r#"<rgb name="irradiance" value="2 3 4"/><vector name="direction" x="1" y="-2" z=".5"/>"#,
    );
    check_delta(
        &light,
        [5.0, 6.0, 7.0],
        [-0.436436, 0.872872, -0.218218],
        f32::INFINITY,
        [2.0, 3.0, 4.0],
        spectral,
    );
    let light = emitter(
        "directional",
        r#"<rgb name="irradiance" value="2 3 4"/><transform name="to_world"><rotate x="1" angle="90"/></transform>"#,
    );
    check_delta(
        &light,
        [0.0; 3],
        [0.0, 1.0, 0.0],
        f32::INFINITY,
        [2.0, 3.0, 4.0],
        spectral,
    );
    let zero = r#"<vector name="direction" x="0" y="0" z="0"/>"#;
    assert!(refusal("directional", zero).contains("no direction"));
    let both = r#"<vector name="direction" value="1 0 0"/><transform name="to_world"/>"#;
    assert!(refusal("directional", both).contains("cannot both"));
}

const LOOK: &str =
    r#"<transform name="to_world"><lookat origin="1 2 3" target="0 0 1" up="0 0 1"/></transform>"#;

/// A bitmap of 3 x 2 pixels, called `name`, whose file lies in `folder`.
fn bitmap(name: &str, folder: &std::path::Path) -> String {
    const ROWS: [[[f32; 3]; 3]; 2] = [
        [[0.9, 0.1, 0.2], [0.2, 0.6, 0.3], [0.1, 0.3, 0.8]],
        [[0.5, 0.5, 0.5], [0.0, 0.0, 0.0], [1.0, 1.0, 0.2]],
    ];
    let path = folder.join("picture.pfm");
    let mut bytes = b"PF\n3 2\n-1\n".to_vec();
    for row in ROWS.iter().rev() {
        bytes.extend(row.iter().flatten().flat_map(|value| value.to_le_bytes()));
    }
    std::fs::write(&path, bytes).unwrap();
    format!(
        r#"<texture type="bitmap" name="{name}"><string name="filename" value="{}"/></texture>"#,
        path.display()
    )
}

/// What arrives from a light with an image.
struct Cast {
    at: [f32; 3],
    rgb: [f32; 3],
    spectral: [f32; 4],
}

#[track_caller]
fn check_cast(light: &Emitter, casts: &[Cast]) {
    for cast in casts {
        let at = cast.at.into();
        let sample = light.sample::<Rgb>(&[], at, &(), [0.5; 2]).unwrap();
        assert_close(&sample.weight.0, &cast.rgb, 1e-3);
        let wavelengths = Wavelengths::at(NM);
        let sample = light.sample::<Spectral<4>>(&[], at, &wavelengths, [0.5; 2]);
        assert_close(&sample.unwrap().weight.0, &cast.spectral, 0.02);
        let to_light = Vec3::new(1.0, 2.0, 3.0) - at;
        let direction = light
            .sample::<Rgb>(&[], at, &(), [0.5; 2])
            .unwrap()
            .direction;
        assert!((direction - to_light.normalize()).length() < 1e-5);
    }
}

/// `mi.load_dict({'type': 'projector', 'irradiance': {'type': 'bitmap', …}, 'scale': 2, 'fov': 50, …})`.
#[test]
fn projectors_are_mitsubas() {
    let folder = tempfile::tempdir().unwrap();
    let image = bitmap("irradiance", folder.path());
    let text =
        format!(r#"{image}<float name="scale" value="2"/><float name="fov" value="50"/>{LOOK}"#);
    let light = emitter("projector", &text);
    assert!(light.is_delta());
    check_cast(
        &light,
        &[
            Cast {
                at: [0.0, 0.0, 1.0],
                rgb: [0.0698132, 0.20944, 0.10472],
                spectral: [0.0393163, 0.165396, 0.202431, 0.0407014],
            },
            Cast {
                at: [0.5, 0.2, 0.3],
                rgb: [0.171654, 0.164554, 0.134159],
                spectral: [0.143809, 0.148613, 0.16391, 0.165881],
            },
            Cast {
                at: [-0.5, 0.5, 1.5],
                rgb: [0.284991, 0.472109, 0.640346],
                spectral: [0.666407, 0.596193, 0.448569, 0.307927],
            },
        ],
    );
    // Beside the image, and behind the projector.
    for nothing in [Vec3::new(0.0, 1.0, 0.0), Vec3::splat(3.0)] {
        assert!(light.sample::<Rgb>(&[], nothing, &(), [0.5; 2]).is_none());
    }
}

#[test]
fn projectors_light_planes_evenly() {
    let light = emitter(
        "projector",
        r#"<rgb name="irradiance" value="1 2 4"/><float name="fov" value="90"/>"#,
    );
    for (x, y) in [(0.0, 0.0), (0.9, 0.0), (0.6, -0.99), (-0.99, 0.99)] {
        let at = Vec3::new(x, y, 1.0) * 2.0;
        let sample = light.sample::<Rgb>(&[], at, &(), [0.5; 2]).unwrap();
        let irradiance = sample.weight * sample.direction.dot(-Vec3::Z);
        let expected = [1.0, 2.0, 4.0].map(|value| value * std::f32::consts::PI / 4.0);
        assert_close(&irradiance.0, &expected, 1e-4);
    }
    for (parameters, message) in [
        (r#"<float name="scale" value="-1"/>"#, "`scale`"),
        (r#"<float name="fov" value="180"/>"#, "field of view"),
        (
            r#"<transform name="to_world"><scale value="2"/></transform>"#,
            "scale",
        ),
        (
            r#"<texture name="irradiance" type="checkerboard"/>"#,
            "not supported",
        ),
    ] {
        let error = refusal("projector", parameters);
        assert!(error.contains(message), "{error}");
    }
}

/// `mi.load_dict({'type': 'spot', 'texture': {'type': 'bitmap', …}, 'intensity': …, 'cutoff_angle': 40, 'beam_width': 30, …})`.
#[test]
fn spots_with_textures_are_mitsubas() {
    let folder = tempfile::tempdir().unwrap();
    let image = bitmap("texture", folder.path());
    let light = emitter(
        "spot",
        &format!(
            r#"{image}<rgb name="intensity" value="2 3 4"/><float name="cutoff_angle" value="40"/>
               <float name="beam_width" value="30"/>{LOOK}"#
        ),
    );
    check_cast(
        &light,
        &[
            Cast {
                at: [0.0, 0.0, 1.0],
                rgb: [0.0222222, 0.1, 0.0666667],
                spectral: [0.0246022, 0.111909, 0.0990408, 0.010212],
            },
            Cast {
                at: [0.5, 0.2, 0.3],
                rgb: [0.034192, 0.131083, 0.121672],
                spectral: [0.0801093, 0.166892, 0.129315, 0.0202631],
            },
            Cast {
                at: [0.0, 1.0, 0.0],
                rgb: [0.0687615, 0.124299, 0.0977209],
                spectral: [0.0912183, 0.141339, 0.125272, 0.048132],
            },
            Cast {
                at: [-0.5, 0.5, 1.5],
                rgb: [0.105558, 0.127633, 0.144968],
                spectral: [0.171073, 0.164345, 0.131161, 0.082093],
            },
        ],
    );
}

/// The area light of a scene, and its shape.
fn area_light(scene: &Scene) -> (&AreaLight, &Shape) {
    let Emitter::Area(light) = &scene.emitters[0] else {
        panic!("{:?}", scene.emitters)
    };
    (light, &scene.shapes[light.shape.index()])
}

/// What the light of a rectangle sends to a point before it from its texture coordinates `uv`.
fn glow<C: Colour>(scene: &Scene, uv: [f32; 2], wavelengths: &C::Wavelengths) -> C::Spectrum {
    let reference = Vec3::new(0.3, 0.2, 1.5);
    let light = scene.emitters[0].sample::<C>(&scene.shapes, reference, wavelengths, uv);
    light.map_or(C::Spectrum::ZERO, |light| {
        light.weight * light.pdf.unwrap().0
    })
}

/// A scene with a rectangle of radiance `radiance`.
fn glowing(radiance: &str) -> Scene {
    let text =
        format!(r#"<shape type="rectangle"><emitter type="area">{radiance}</emitter></shape>"#);
    load_all(&text).unwrap()
}

/// `emitter.eval(si)` of Mitsuba 3.9.1 at the points `uv` of a rectangle with this image.
#[test]
fn images_of_lamps_are_mitsubas() {
    let folder = tempfile::tempdir().unwrap();
    let scene = glowing(&bitmap("radiance", folder.path()));
    for (uv, rgb, spectral) in [
        (
            [0.2, 0.3],
            [0.792, 0.18, 0.234],
            [0.592375, 0.166904, 0.199377, 0.83736],
        ),
        (
            [0.7, 0.2],
            [0.186, 0.438, 0.552],
            [0.529701, 0.535778, 0.416265, 0.180714],
        ),
        (
            [0.5, 0.5],
            [0.1, 0.3, 0.15],
            [0.0563165, 0.236912, 0.289961, 0.0583005],
        ),
        (
            [0.9, 0.8],
            [0.836, 0.836, 0.302],
            [0.240635, 0.540643, 0.8205, 0.839624],
        ),
    ] {
        assert_close(&glow::<Rgb>(&scene, uv, &()).0, &rgb, 1e-4);
        let values = glow::<Spectral<4>>(&scene, uv, &Wavelengths::at(NM));
        assert_close(&values.0, &spectral, 0.02);
    }
}

/// As above. Mitsuba has no `<rgb>` greater than 1 there, and cuts off texels by wavelength.
#[test]
fn squares_of_lamps_are_mitsubas() {
    let board = |first: &str, second: &str| {
        glowing(&format!(
            r#"<texture type="checkerboard" name="radiance">{first}{second}</texture>"#
        ))
    };
    let all = |scene: &Scene, uv: [f32; 2]| {
        let rgb = glow::<Rgb>(scene, uv, &()).0;
        let spectral = glow::<Spectral<4>>(scene, uv, &Wavelengths::at(NM)).0;
        [rgb.to_vec(), spectral.to_vec()].concat()
    };
    let (odd, even) = ([0.7, 0.2], [0.2, 0.3]);
    let scene = board(
        r#"<rgb name="color0" value=".2 .3 .4"/>"#,
        r#"<float name="color1" value="5"/>"#,
    );
    let blue = [0.2, 0.3, 0.4, 0.424751, 0.36302, 0.292355, 0.195088];
    assert_close(&all(&scene, even), &blue, 3e-3);
    assert_close(&all(&scene, odd), &[5.0; 7], 1e-6);
    let scene = board(
        r#"<rgb name="color0" value="2 3 4"/>"#,
        r#"<spectrum name="color1" value="400:1 700:20"/>"#,
    );
    let filter = SpectralCurve::rgb_reflectance([0.5, 0.75, 1.0]).unwrap();
    let expected = filter.evaluate(&Wavelengths::at(NM)).0.map(|v| 4.0 * v);
    assert_close(
        &all(&scene, even),
        &[&[2.0, 3.0, 4.0], &expected[..]].concat(),
        1e-3,
    );
    let expected = [1.63333, 6.06667, 10.5, 16.8333];
    assert_close(&all(&scene, odd)[3..], &expected, 1e-4);
    let scene = board("", "");
    assert_close(&all(&scene, even), &[0.4; 7], 1e-6);
    assert_close(&all(&scene, odd), &[0.2; 7], 1e-6);
}

/// Texels may be greater than 1: they are the colours of texels in [0, 1], only brighter.
#[test]
fn images_of_lamps_may_be_bright() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bright.pfm");
    let mut bytes = b"PF\n2 1\n-1\n".to_vec();
    for value in [6.0_f32, 3.0, 0.6, 1.0, 0.5, 0.1] {
        bytes.extend(value.to_le_bytes());
    }
    std::fs::write(&path, &bytes).unwrap();
    let image = |name: &str| {
        format!(
            r#"<texture type="bitmap" name="{name}"><string name="filename" value="{}"/><string name="filter_type" value="nearest"/></texture>"#,
            path.display()
        )
    };
    let scene = glowing(&image("radiance"));
    assert_close(
        &glow::<Rgb>(&scene, [0.2, 0.5], &()).0,
        &[6.0, 3.0, 0.6],
        1e-5,
    );
    let wavelengths = Wavelengths::at(NM);
    let bright = glow::<Spectral<4>>(&scene, [0.2, 0.5], &wavelengths);
    let dim = glow::<Spectral<4>>(&scene, [0.8, 0.5], &wavelengths);
    assert_close(&bright.0, &dim.0.map(|value| 6.0 * value), 1e-3);
    assert!(bright.0[3] > 3.0, "{bright:?}");
    let surface = format!(r#"<bsdf type="diffuse">{}</bsdf>"#, image("reflectance"));
    let refused = load_all(&format!(r#"<shape type="sphere">{surface}</shape>"#)).unwrap_err();
    assert!(refused.contains("from 0 to 1"), "{refused}");
    bytes[10..14].fill(0xff);
    std::fs::write(&path, &bytes).unwrap();
    let lamp = format!(
        r#"<shape type="sphere"><emitter type="area">{}</emitter></shape>"#,
        image("radiance")
    );
    let refused = load_all(&lamp).unwrap_err();
    assert!(refused.contains("0 to 1e30"), "{refused}");
}

/// A PLY file of one triangle with a colour at each vertex, in `folder`.
fn coloured_triangle(folder: &std::path::Path) -> String {
    let path = folder.join("triangle.ply");
    let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
        property float r\nproperty float g\nproperty float b\nelement face 1\nproperty list uchar int vertex_indices\n\
        end_header\n0 0 0 0.9 0.1 0.2\n1 0 0 0.2 0.6 0.3\n0 1 0 0.1 0.3 0.8\n3 0 1 2\n";
    std::fs::write(&path, text).unwrap();
    path.display().to_string()
}

/// `emitter.eval(si)` of Mitsuba 3.9.1 at (0.2, 0.3, 0), for `scale` 2.5.
#[test]
fn colours_of_meshes_that_glow_are_mitsubas() {
    let folder = tempfile::tempdir().unwrap();
    let file = coloured_triangle(folder.path());
    let lamp = |name: &str| {
        load_all(&format!(
            r#"<shape type="ply"><string name="filename" value="{file}"/><emitter type="area"><texture type="mesh_attribute" name="radiance">
            <string name="name" value="{name}"/><float name="scale" value="2.5"/></texture></emitter></shape>"#
        ))
    };
    let scene = lamp("vertex_color").unwrap();
    let (light, shape) = area_light(&scene);
    let hit = crate::scene::HitCoordinates {
        primitive: 0,
        u: 0.2,
        v: 0.3,
        normal: Vec3::Z,
    };
    let point = shape.geometry.surface(&hit);
    let parameters = || shape.geometry.parameters(&hit, &point);
    let rgb = light.radiance::<Rgb>(&point, parameters, Vec3::Z, &());
    assert_close(&rgb.0, &[1.3, 0.65, 1.0], 1e-5);
    let at = Wavelengths::at(NM);
    let spectral = light.radiance::<Spectral<4>>(&point, parameters, Vec3::Z, &at);
    assert_close(&spectral.0, &[1.55716, 0.820211, 0.65413, 1.3744], 0.02);
    let behind = light.radiance::<Rgb>(&point, parameters, -Vec3::Z, &());
    assert!(behind.is_black());
    let missing = lamp("vertex_heat").unwrap_err();
    assert!(
        missing.contains("the light asks for the mesh attribute `vertex_heat`"),
        "{missing}"
    );
}

/// The power of a light with a texture is known from the mean over its surface, not over its image.
#[test]
fn the_mean_of_a_texture_is_that_over_the_shape() {
    let mean = |scene: &Scene| {
        let (light, shape) = area_light(scene);
        light.mean_luminance(&shape.geometry)
    };
    let board = |shape: &str, to_uv: &str| {
        let text = format!(
            r#"<shape type="{shape}"><emitter type="area"><texture type="checkerboard" name="radiance"><float name="color0" value="1"/>
            <float name="color1" value="5"/><transform name="to_uv">{to_uv}</transform></texture></emitter></shape>"#
        );
        mean(&load_all(&text).unwrap())
    };
    assert_close(&[board("rectangle", "")], &[3.0], 1e-5);
    assert_close(&[board("cube", "")], &[3.0], 0.02);
    // On a disk the inner half of the radius is a quarter of the area; around it, one angle in two counts.
    assert_close(
        &[board("disk", r#"<scale y="0.1"/>"#)],
        &[0.25 + 0.75 * 5.0],
        0.02,
    );
    // The northern half of the sphere.
    assert_close(&[board("sphere", r#"<scale x="0.1"/>"#)], &[3.0], 0.02);
    // The image lies on a corner of the rectangle.
    assert_close(
        &[board("rectangle", r#"<scale x="0.5" y="0.5"/>"#)],
        &[1.0],
        1e-5,
    );
    let folder = tempfile::tempdir().unwrap();
    let file = coloured_triangle(folder.path());
    let triangle = load_all(&format!(
        r#"<shape type="ply"><string name="filename" value="{file}"/><emitter type="area"><texture type="mesh_attribute" name="radiance">
        <string name="name" value="vertex_color"/></texture></emitter></shape>"#
    ));
    let expected = crate::scene::textures::luminance([0.4, 1.0 / 3.0, 1.3 / 3.0]);
    assert_close(&[mean(&triangle.unwrap())], &[expected], 0.02);
}
