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
    let texture = r#"<texture type="bitmap" name="texture"/>"#;
    assert!(refusal("spot", texture).contains("not supported"));
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
