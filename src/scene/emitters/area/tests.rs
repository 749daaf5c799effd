use super::*;
use crate::scene::emitters::Emitter;
use crate::scene::emitters::tests::{NM, assert_close, bitmap, load_all};
use crate::scene::{HitCoordinates, Scene};
use crate::spectrum::{Rgb, Spectral, Wavelengths};

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
    let hit = HitCoordinates {
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
    let expected = luminance([0.4, 1.0 / 3.0, 1.3 / 3.0]);
    assert_close(&[mean(&triangle.unwrap())], &[expected], 0.02);
}

/// `emitter.eval(si)` of Mitsuba 3.9.1 at the texture coordinates (0.3, 0.4) and (0.7, 0.4).
#[test]
fn daylight_is_mitsubas() {
    let lamp = |content: &str| {
        glowing(&format!(
            r#"<texture type="d65" name="radiance">{content}</texture>"#
        ))
    };
    let check = |scene: &Scene, u: f32, rgb: [f32; 3], spectral: [f32; 4]| {
        assert_close(&glow::<Rgb>(scene, [u, 0.4], &()).0, &rgb, 1e-4);
        let values = glow::<Spectral<4>>(scene, [u, 0.4], &Wavelengths::at(NM));
        assert_close(&values.0, &spectral, 0.02);
    };
    const WHITE: [f32; 4] = [0.924125, 1.17097, 1.0509971, 0.8083726];
    const ORANGE: [f32; 4] = [0.11496064, 0.17339887, 0.34439245, 0.7290021];
    check(&lamp(""), 0.3, [1.0; 3], WHITE);
    let colour = r#"<rgb name="color" value="1, 0.5, 0.2"/><float name="scale" value="3"/>"#;
    let filtered = [0.46621802, 1.0383297, 1.6811169, 2.578861];
    check(&lamp(colour), 0.3, [3.0, 1.5, 0.6], filtered);
    let board = |second: &str| {
        let first = r#"<rgb name="color0" value="0.9, 0.3, 0.1"/>"#;
        lamp(&format!(
            r#"<texture type="checkerboard">{first}{second}</texture>"#
        ))
    };
    let varying = board(r#"<float name="color1" value="2"/>"#);
    check(&varying, 0.3, [0.9, 0.3, 0.1], ORANGE);
    check(&varying, 0.7, [2.0; 3], WHITE.map(|value| 2.0 * value));
    let plain = board(r#"<rgb name="color1" value="0.9, 0.3, 0.1"/>"#);
    assert!(area_light(&plain).0.uniform_radiance().is_some());
    check(&plain, 0.7, [0.9, 0.3, 0.1], ORANGE);
}

#[test]
fn daylight_that_is_wrong_is_refused() {
    let texture = r#"<texture type="checkerboard"/>"#;
    let lamp = |content: &str| {
        load_all(&format!(
            r#"<shape type="rectangle"><emitter type="area"><texture type="d65" name="radiance">{content}</texture></emitter></shape>"#
        ))
        .unwrap_err()
    };
    for (content, message) in [
        (
            format!(r#"{texture}<float name="scale" value="2"/>"#),
            "either a texture or `scale`",
        ),
        (
            format!(r#"{texture}<rgb name="color" value="1"/>"#),
            "either a texture or `color`",
        ),
        (format!("{texture}{texture}"), "one texture at most"),
        (
            r#"<float name="color" value="2"/>"#.to_owned(),
            "has to be an <rgb>",
        ),
        (r#"<float name="scale" value="-1"/>"#.to_owned(), "-1"),
        (
            r#"<texture type="marble"/>"#.to_owned(),
            "mesh_attribute, d65",
        ),
    ] {
        let said = lamp(&content);
        assert!(said.contains(message), "{said}");
    }
    let everywhere = |content: &str| {
        load_all(&format!(
            r#"<emitter type="constant"><spectrum type="d65" name="radiance">{content}</spectrum></emitter>"#
        ))
    };
    assert!(everywhere(r#"<float name="scale" value="2"/>"#).is_ok());
    assert!(
        everywhere(texture)
            .unwrap_err()
            .contains("the same everywhere")
    );
}
