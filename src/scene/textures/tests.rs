//! Textures are Mitsuba's.

use std::path::Path;

use glam::Vec2;

use super::{FloatTexture, Pattern, SpectrumTexture, TextureLoader};
use crate::scene::shapes::SurfaceParameters;
use crate::scene::xml::{self, Class, SceneSource};
use crate::spectrum::{Rgb, Spectral, SpectrumArithmetic, Wavelengths};

/// Where Mitsuba was asked, in texture coordinates.
const UVS: [[f32; 2]; 3] = [[0.1, 0.2], [0.73, 0.41], [-0.3, 1.7]];

fn at(uv: [f32; 2]) -> SurfaceParameters<'static> {
    SurfaceParameters {
        uv: Vec2::from(uv),
        ..SurfaceParameters::default()
    }
}

/// The colour that `texture`, with `FILE` for the path of an image, is.
fn colour(texture: &str, file: &Path) -> Result<SpectrumTexture, String> {
    load(texture, file, |object, loader| {
        loader.reflectance(object, "t", 0.5)
    })
}

fn number(texture: &str, file: &Path) -> Result<FloatTexture, String> {
    load(texture, file, |object, loader| {
        loader.number(object, "t", 0.5)
    })
}

fn load<T>(
    texture: &str,
    file: &Path,
    get: impl Fn(&crate::scene::xml::Object, &mut TextureLoader) -> Result<T, crate::scene::SceneError>,
) -> Result<T, String> {
    let texture = texture.replace("FILE", file.to_str().unwrap());
    let text = format!(r#"<scene version="3.0.0"><bsdf type="any">{texture}</bsdf></scene>"#);
    let source = SceneSource::Text {
        name: "test",
        text: &text,
    };
    let document = xml::parse(&source, &[], &[]).map_err(|error| error.to_string())?;
    let object = &document.root.children(Class::Bsdf)[0].object;
    get(object, &mut TextureLoader::new(&document)).map_err(|error| error.to_string())
}

/// An image of 4 x 3 texels in red, green and blue, encoded by sRGB where the format is.
fn image() -> image::RgbImage {
    image::RgbImage::from_fn(4, 3, |x, y| {
        let value = |step: u32| ((x * 37 + y * 91 + step * 53) % 256) as u8;
        image::Rgb([value(0), value(1), value(2)])
    })
}

/// The texels that [`image`] stands for, linear.
fn texel(x: u32, y: u32) -> [f32; 3] {
    image().get_pixel(x, y).0.map(|value| {
        let value = f32::from(value) / 255.0;
        if value <= 0.04045 {
            value / 12.92
        } else {
            ((value + 0.055) / 1.055).powf(2.4)
        }
    })
}

fn assert_close(ours: [f32; 3], expected: [f32; 3], tolerance: f32) {
    for (a, b) in ours.into_iter().zip(expected) {
        assert!(
            (a - b).abs() < tolerance,
            "{ours:?} instead of {expected:?}"
        );
    }
}

/// Every format that has a lossless form gives the same image; texels are met at their centres.
#[test]
fn all_formats_hold_the_same_image() {
    let folder = tempfile::tempdir().unwrap();
    let mut files = Vec::new();
    for name in ["a.png", "a.bmp"] {
        let path = folder.path().join(name);
        image().save(&path).unwrap();
        files.push(path);
    }
    let exr_path = folder.path().join("a.exr");
    exr::prelude::write_rgb_file(&exr_path, 4, 3, |x, y| {
        let [r, g, b] = texel(x as u32, y as u32);
        (r, g, b)
    })
    .unwrap();
    files.push(exr_path);
    let pfm_path = folder.path().join("a.pfm");
    let mut pfm = b"PF\n4 3\n1.0\n".to_vec();
    for y in (0..3).rev() {
        for x in 0..4 {
            texel(x, y)
                .iter()
                .for_each(|value| pfm.extend(value.to_be_bytes()));
        }
    }
    std::fs::write(&pfm_path, pfm).unwrap();
    files.push(pfm_path);
    for file in files {
        let texture = colour(
            r#"<texture type="bitmap" name="t"><string name="filename" value="FILE"/></texture>"#,
            &file,
        );
        let texture = texture.unwrap();
        for x in 0..4 {
            for y in 0..3 {
                let uv = [(x as f32 + 0.5) / 4.0, (y as f32 + 0.5) / 3.0];
                let found = texture.spectrum::<Rgb>(&at(uv), &()).0;
                assert_close(found, texel(x, y), 1e-5);
                // By wavelength the texels are spectra of that colour: their mean over many wavelengths is about as bright.
                let wavelengths = Wavelengths::<8>::sample(0.4);
                let spectrum = texture.spectrum::<Spectral<8>>(&at(uv), &wavelengths);
                assert!(
                    spectrum
                        .components()
                        .iter()
                        .all(|v| (0.0..=1.0).contains(v))
                );
            }
        }
    }
}

#[test]
fn jpegs_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.jpg");
    let grey = image::GrayImage::from_pixel(16, 16, image::Luma([188]));
    grey.save(&path).unwrap();
    let xml = r#"<texture type="bitmap" name="t"><string name="filename" value="FILE"/></texture>"#;
    // One colour is no texture any more.
    let SpectrumTexture::Uniform(curve) = colour(xml, &path).unwrap() else {
        panic!("a grey image varies");
    };
    assert_close(curve.rgb(), [0.5029; 3], 2e-3);
}

/// The height map of the tests, by Mitsuba 3.9.1: `eval_1` and `eval_1_grad` at [`UVS`] for every `wrap_mode` and `filter_type`, with `to_uv`
/// `scale([2, 3, 1]).translate([0.1, 0.2, 0]).rotate([0, 0, 1], 20)`.
#[test]
fn lookups_are_mitsubas() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.pfm");
    let mut pfm = b"Pf 4 4 -1\n".to_vec();
    for i in 0..16u8 {
        pfm.extend(f32::from(i * 7 % 5 * 2).mul_add(0.1, 0.05).to_le_bytes());
    }
    std::fs::write(&path, pfm).unwrap();
    for (wrap, filter, values, gradients) in LOOKUPS {
        let xml = format!(
            r#"<texture type="bitmap" name="t"><string name="filename" value="FILE"/><boolean name="raw" value="true"/>
            <string name="wrap_mode" value="{wrap}"/><string name="filter_type" value="{filter}"/><transform name="to_uv">
            <rotate z="1" angle="20"/><translate x="0.1" y="0.2"/><scale x="2" y="3"/></transform></texture>"#
        );
        let FloatTexture::Varying(pattern) = number(&xml, &path).unwrap() else {
            panic!("it varies");
        };
        let Pattern::Bitmap(bitmap) = &pattern else {
            panic!("it is a bitmap");
        };
        for ((uv, value), gradient) in UVS.into_iter().zip(values).zip(gradients) {
            let found = bitmap.number(Vec2::from(uv));
            // Mitsuba keeps texels in 16 bits.
            assert!(
                (found - value).abs() < 1e-3,
                "{wrap} {filter} {uv:?}: {found} instead of {value}"
            );
            let found = bitmap.gradient(Vec2::from(uv));
            let error = (found - Vec2::from(gradient)).length();
            assert!(
                error < 1e-2,
                "{wrap} {filter} {uv:?}: {found} instead of {gradient:?}"
            );
        }
    }
}

/// `wrap_mode`, `filter_type`, the values and their gradients.
type Lookup = (&'static str, &'static str, [f32; 3], [[f32; 2]; 3]);

const LOOKUPS: [Lookup; 6] = [
    (
        "repeat",
        "nearest",
        [0.65000, 0.05000, 0.25000],
        [[0.00000, 0.00000], [0.00000, 0.00000], [0.00000, 0.00000]],
    ),
    (
        "repeat",
        "bilinear",
        [0.49328, 0.37825, 0.43961],
        [
            [-0.64982, -0.98275],
            [-1.98912, -2.67261],
            [2.18617, -3.34973],
        ],
    ),
    (
        "mirror",
        "nearest",
        [0.05000, 0.45000, 0.45000],
        [[0.00000, 0.00000], [0.00000, 0.00000], [0.00000, 0.00000]],
    ),
    (
        "mirror",
        "bilinear",
        [0.30582, 0.39136, 0.60731],
        [
            [-0.85369, 1.52999],
            [-1.36532, 5.60499],
            [3.00702, -1.09446],
        ],
    ),
    (
        "clamp",
        "nearest",
        [0.45000, 0.25000, 0.05000],
        [[0.00000, 0.00000], [0.00000, 0.00000], [0.00000, 0.00000]],
    ),
    (
        "clamp",
        "bilinear",
        [0.25181, 0.25000, 0.05000],
        [[3.00702, -1.09446], [0.00000, 0.00000], [0.00000, 0.00000]],
    ),
];

#[test]
fn checkerboards_are_mitsubas() {
    let xml = r#"<texture type="checkerboard" name="t"/>"#;
    let (colours, numbers) = (
        colour(xml, Path::new("")).unwrap(),
        number(xml, Path::new("")).unwrap(),
    );
    // eval and eval_1 of Mitsuba 3.9.1, which differ
    for (uv, colour, number) in [
        ([0.3, 0.6], 0.2, 0.4),
        ([0.3, 0.3], 0.4, 0.2),
        ([0.7, 0.3], 0.2, 0.4),
        ([0.5, 0.2], 0.4, 0.2),
    ] {
        assert_eq!(colours.spectrum::<Rgb>(&at(uv), &()).0, [colour; 3]);
        assert_eq!(numbers.number(&at(uv)), number);
    }
}

#[test]
fn what_is_wrong_with_an_image_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let xml = r#"<texture type="bitmap" name="t"><string name="filename" value="FILE"/></texture>"#;
    let message = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        colour(xml, &path).unwrap_err()
    };
    let bright = [b"Pf 1 1 -1\n".as_slice(), &2.5f32.to_le_bytes()].concat();
    for (message, part) in [
        (message("b.pfm", b"Pf 4 3 -1\nabc"), "b.pfm"),
        (message("c.pfm", b"P6 4 3 255\nabc"), "c.pfm"),
        (
            message("a.pfm", &bright),
            "column 0 of row 0 (from 0) is 2.5; a texture has numbers from 0 to 1",
        ),
        (message("d.png", b"no image"), "d.png"),
        (message("e.exr", b"no image"), "e.exr"),
        (
            colour(r#"<texture type="bitmap" name="t"/>"#, Path::new("")).unwrap_err(),
            "needs the parameter `filename`",
        ),
        (
            colour(r#"<texture type="marble" name="t"/>"#, Path::new("")).unwrap_err(),
            "supported are: bitmap, checkerboard, mesh_attribute",
        ),
    ] {
        assert!(message.contains(part), "{message}");
        assert!(
            message.contains("<test>:1:") || message.contains("test:1:"),
            "{message}"
        );
    }
}
