use super::*;
use crate::scene::{LoadOptions, Scene};
use crate::spectrum::{Rgb, Spectral, Wavelengths};

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
pub(super) fn bitmap(name: &str, folder: &std::path::Path) -> String {
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
