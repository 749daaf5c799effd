use super::*;
use crate::scene::{LoadOptions, Scene};

fn load_integrator(text: &str) -> Result<PathIntegrator, String> {
    let text = format!(r#"<scene version="3.0.0"><sensor type="perspective"/>{text}</scene>"#);
    let scene = Scene::from_xml(&text, &LoadOptions::default());
    scene
        .map(|scene| scene.integrator)
        .map_err(|error| error.to_string())
}

fn direct(parameters: &[(&str, i64)]) -> Result<PathIntegrator, String> {
    let parameters: String = parameters
        .iter()
        .map(|(name, value)| format!(r#"<integer name="{name}" value="{value}"/>"#))
        .collect();
    load_integrator(&format!(
        r#"<integrator type="direct">{parameters}</integrator>"#
    ))
}

#[test]
fn direct_takes_as_many_samples_as_it_is_told() {
    for (parameters, emitters, directions) in [
        (&[][..], 1, 1),
        (&[("shading_samples", 4)], 4, 4),
        (&[("emitter_samples", 3)], 3, 1),
        (&[("bsdf_samples", 0)], 1, 0),
        (&[("emitter_samples", 0), ("bsdf_samples", 256)], 0, 256),
    ] {
        let integrator = direct(parameters).unwrap();
        assert_eq!(integrator.max_depth, Some(2));
        let expected = SurfaceSamples {
            emitters,
            directions,
        };
        assert_eq!(integrator.samples, expected);
    }
}

#[test]
fn direct_cannot_be_told_everything() {
    for (parameters, message) in [
        (&[("shading_samples", 0)][..], "at least one sample"),
        (
            &[("emitter_samples", 0), ("bsdf_samples", 0)],
            "at least one sample",
        ),
        (
            &[("shading_samples", 1), ("bsdf_samples", 1)],
            "cannot be given beside",
        ),
        (&[("emitter_samples", -2)], "from 0 to 256"),
        (&[("bsdf_samples", 257)], "from 0 to 256"),
        (&[("max_depth", 3)], "no parameter `max_depth`"),
    ] {
        let error = direct(parameters).unwrap_err();
        assert!(error.contains(message), "{error}");
    }
}

#[test]
fn moment_is_the_integrator_in_it() {
    let path = r#"<integrator type="path"><integer name="max_depth" value="7"/></integrator>"#;
    let moment = |inside: &str| {
        load_integrator(&format!(
            r#"<integrator type="moment">{inside}</integrator>"#
        ))
    };
    let called = |name: &str| PathIntegrator {
        moments: Some(name.to_owned()),
        ..load_integrator(path).unwrap()
    };
    assert_eq!(called("").max_depth, Some(7));
    // `scene.integrator().aov_names()` of Mitsuba 3.9.1
    assert_eq!(moment(path), Ok(called("_arg_0")));
    let named = path.replace("type=", r#"name="inner" type="#);
    assert_eq!(moment(&named), Ok(called("inner")));
    let twice = format!(r#"<integrator type="moment">{path}</integrator>"#);
    assert!(moment(&twice).unwrap_err().contains("`moment` in `moment`"));
    assert!(moment("").unwrap_err().contains("needs an integrator"));
    assert!(
        moment(&path.repeat(2))
            .unwrap_err()
            .contains("more than one")
    );
    assert!(
        moment(r#"<integrator type="bdpt"/>"#)
            .unwrap_err()
            .contains("not supported")
    );
}
