use glam::{Vec2, Vec3};

use super::*;
use crate::sampling::{RandomStream, StreamKey};
use crate::scene::{LoadOptions, Scene};

const LOOK: &str = r#"<lookat origin="1 2 3" target="0 0 1" up="0 0 1"/>"#;

fn load(plugin: &str, parameters: &str, transform: &str) -> Result<Camera, String> {
    let text = format!(
        r#"<scene version="3.0.0"><sensor type="{plugin}">{parameters}
           <transform name="to_world">{transform}</transform></sensor></scene>"#
    );
    let scene = Scene::from_xml(&text, &LoadOptions::default());
    scene
        .map(|scene| scene.camera)
        .map_err(|error| error.to_string())
}

/// What `mi.load_dict({…, 'film': …}).sample_ray(0, .5, sample, lens)` answers: `o`, `d` and `maxt`.
struct Expected {
    sample: [f32; 2],
    lens: [f32; 2],
    origin: [f32; 3],
    direction: [f32; 3],
    length: f32,
}

#[track_caller]
fn check(camera: &Camera, [width, height]: [u32; 2], expected: &[Expected]) {
    let view = camera.view(ImageSize { width, height });
    for expected in expected {
        let raster = Vec2::from(expected.sample) * Vec2::new(width as f32, height as f32);
        let ray = view.ray(raster, expected.lens);
        let origin = ray.origin + ray.near * ray.direction;
        let (o, d) = (Vec3::from(expected.origin), Vec3::from(expected.direction));
        assert!((origin - o).length() < 2e-5, "{origin} instead of {o}");
        assert!(
            (ray.direction - d).length() < 2e-5,
            "{} instead of {d}",
            ray.direction
        );
        let length = ray.far - ray.near;
        assert!((length / expected.length - 1.0).abs() < 1e-5, "{length}");
        assert!((view.far_along(ray.direction) / ray.far - 1.0).abs() < 1e-5);
    }
}

const THIN_LENS: &str =
    r#"<float name="fov" value="40"/><float name="aperture_radius" value=".25"/>"#;

#[test]
fn rays_through_a_lens_are_mitsubas() {
    let parameters = format!(
        r#"{THIN_LENS}<float name="focus_distance" value="3"/>
           <float name="near_clip" value=".5"/><float name="far_clip" value="20"/>"#
    );
    let camera = load("thinlens", &parameters, LOOK).unwrap();
    check(
        &camera,
        [200, 120],
        &[
            Expected {
                sample: [0.1, 0.2],
                lens: [0.3, 0.8],
                origin: [0.855842, 1.52589, 2.79619],
                direction: [-0.0728698, -0.817493, -0.571309],
                length: 20.522_89,
            },
            Expected {
                sample: [0.9, 0.5],
                lens: [0.5, 0.5],
                origin: [0.703115, 1.73178, 2.66667],
                direction: [-0.570094, -0.515059, -0.640084],
                length: 20.309824,
            },
            Expected {
                sample: [0.5, 0.5],
                lens: [0.9, 0.1],
                origin: [0.973879, 1.68423, 2.57883],
                direction: [-0.388689, -0.672202, -0.630131],
                length: 19.543285,
            },
        ],
    );
}

#[test]
fn a_lens_is_in_focus_far_away_by_default() {
    let camera = load("thinlens", THIN_LENS, LOOK).unwrap();
    check(
        &camera,
        [200, 120],
        &[Expected {
            sample: [0.5, 0.5],
            lens: [0.9, 0.1],
            origin: [1.16532, 2.01442, 2.88792],
            direction: [-0.33335, -0.666669, -0.666656],
            length: 9999.99,
        }],
    );
}

/// All rays of a raster position meet in the plane in focus, where the pinhole camera's ray passes.
#[test]
fn rays_meet_in_the_plane_in_focus() {
    let focus = r#"<float name="focus_distance" value="3"/>"#;
    let camera = load("thinlens", &format!("{THIN_LENS}{focus}"), LOOK).unwrap();
    let pinhole = load("perspective", r#"<float name="fov" value="40"/>"#, LOOK).unwrap();
    let size = ImageSize {
        width: 20,
        height: 10,
    };
    let forward = Vec3::new(-1.0, -2.0, -2.0) / 3.0;
    let mut random = RandomStream::new(StreamKey {
        seed: 1,
        tile: 0,
        pass: 0,
    });
    for _ in 0..100 {
        let raster = Vec2::from(random.uniform_2d()) * Vec2::new(20.0, 10.0);
        let sharp = pinhole.view(size).ray(raster, [0.5; 2]);
        let ray = camera.view(size).ray(raster, random.uniform_2d());
        let offset = ray.origin - sharp.origin;
        assert!(offset.length() <= 0.25 + 1e-6 && offset.dot(forward).abs() < 1e-6);
        let in_focus =
            |ray: CameraRay| ray.origin + ray.direction * (3.0 / ray.direction.dot(forward));
        assert!((in_focus(ray) - in_focus(sharp)).length() < 1e-5);
    }
}

#[test]
fn a_lens_without_extent_is_a_pinhole() {
    let parameters = r#"<float name="fov" value="40"/><float name="aperture_radius" value="0"/>"#;
    let camera = load("thinlens", parameters, LOOK).unwrap();
    let pinhole = load("perspective", r#"<float name="fov" value="40"/>"#, LOOK).unwrap();
    assert_eq!(camera, pinhole);
    let size = ImageSize {
        width: 4,
        height: 3,
    };
    assert!(!camera.view(size).has_lens());
}

#[test]
fn lenses_that_cannot_be_are_refused() {
    let with = |name: &str, value: f64| format!(r#"<float name="{name}" value="{value}"/>"#);
    for (parameters, transform, message) in [
        (String::new(), LOOK, "aperture_radius"),
        (with("aperture_radius", -0.1), LOOK, "at least 0"),
        (
            format!("{THIN_LENS}{}", with("focus_distance", 0.0)),
            LOOK,
            "focus distance",
        ),
        (
            format!("{THIN_LENS}{}", with("principal_point_offset_x", 0.1)),
            LOOK,
            "principal_point",
        ),
        (
            THIN_LENS.to_owned(),
            r#"<scale value="2"/>"#,
            "must not scale",
        ),
        (
            format!("{THIN_LENS}{}", with("focus_distance", 1e300)),
            LOOK,
            "32-bit",
        ),
    ] {
        let error = load("thinlens", &parameters, transform).unwrap_err();
        assert!(error.contains(message), "{error}");
    }
}

#[test]
fn parallel_rays_are_mitsubas() {
    let clip = r#"<float name="near_clip" value="1"/><float name="far_clip" value="20"/>"#;
    let direction = [-0.333333, -0.666667, -0.666667];
    let scaled = |scale: &str| load("orthographic", clip, &format!("{scale}{LOOK}")).unwrap();
    let expected = |sample, origin, length| Expected {
        sample,
        lens: [0.3, 0.8],
        origin,
        direction,
        length,
    };
    check(
        &scaled(r#"<scale x="1.5" y="1.5"/>"#),
        [200, 120],
        &[
            expected([0.1, 0.2], [1.57898, 0.474683, 2.73583], 19.0),
            expected([0.9, 0.5], [-0.406646, 1.86999, 2.33333], 19.0),
        ],
    );
    check(
        &scaled(r#"<scale x="1.5" y="3" z="2"/>"#),
        [200, 120],
        &[
            expected([0.1, 0.2], [1.08465, -0.513977, 2.47165], 19.0),
            expected([0.5, 0.5], [0.333333, 0.666666, 1.66667], 19.0),
        ],
    );
    let tall = load("orthographic", "", LOOK).unwrap();
    check(
        &tall,
        [120, 200],
        &[
            expected([0.1, 0.2], [1.41407, 1.03928, 3.73869], 9999.99),
            expected([0.9, 0.5], [0.281125, 2.3511, 2.99333], 9999.99),
        ],
    );
}

#[test]
fn parallel_rays_that_cannot_be_are_refused() {
    for (parameters, transform, message) in [
        (r#"<float name="fov" value="40"/>"#, LOOK, "`fov`"),
        (r#"<float name="near_clip" value="0"/>"#, LOOK, "near"),
        ("", r#"<scale x="0" y="1" z="1"/>"#, "no inverse"),
        ("", r#"<scale x="1e-30"/>"#, "32-bit"),
    ] {
        let error = load("orthographic", parameters, transform).unwrap_err();
        assert!(error.contains(message), "{error}");
    }
    assert!(
        load("fisheye", "", LOOK)
            .unwrap_err()
            .contains("not supported")
    );
}
