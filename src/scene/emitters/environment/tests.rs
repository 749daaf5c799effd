use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::*;
use crate::sampling::{RandomStream, StreamKey};
use crate::scene::emitters::tests::{NM, assert_close, load_all};
use crate::scene::{Channels, Encoding, ImageSize};
use crate::spectrum::{Rgb, Spectral, Wavelengths};

/// A picture with black, grey, dark and bright pixels.
const PICTURE: [[[f32; 3]; 4]; 5] = [
    [[1.0, 0.5, 0.25], [0.0; 3], [2.0; 3], [0.1, 0.7, 0.2]],
    [[0.3, 0.3, 0.9], [5.0, 4.0, 1.0], [0.0; 3], [0.2, 0.1, 0.4]],
    [
        [0.6, 0.2, 0.1],
        [0.5; 3],
        [0.25, 0.75, 1.0],
        [3.0, 1.0, 2.0],
    ],
    [[0.0; 3], [0.4, 0.4, 0.1], [1.0; 3], [0.9, 0.3, 0.3]],
    [[0.2; 3], [1.0, 0.0, 0.0], [0.5, 0.25, 0.5], [0.0, 0.1, 0.3]],
];

fn image<const W: usize, const H: usize>(rows: [[[f32; 3]; W]; H]) -> ImageFile {
    ImageFile {
        size: ImageSize {
            width: W as u32,
            height: H as u32,
        },
        channels: Channels::Rgb,
        encoding: Encoding::Linear,
        values: rows.into_iter().flatten().flatten().collect(),
    }
}

fn turned() -> Mat3 {
    Mat3::from_axis_angle(Vec3::new(1.0, 1.0, 0.0).normalize(), 30_f32.to_radians())
}

fn environment(scale: f32, compensates: bool, to_world: Mat3) -> EnvironmentMap {
    EnvironmentMap::new(&image(PICTURE), scale, compensates, to_world.transpose()).unwrap()
}

/// `e = mi.load_dict({'type': 'envmap', 'bitmap': …, 'scale': 2, 'to_world': T().rotate(axis, 30)})`: `e.eval(si)` of
/// `scalar_rgb` and, at [`NM`], of `scalar_spectral`, and the former's `e.pdf_direction(it, ds)`.
#[test]
fn radiance_and_density_are_mitsubas() {
    let light = environment(2.0, false, turned());
    for (direction, rgb, spectral, pdf) in [
        (
            [0.0, 0.0, -1.0],
            [1.5139, 0.504633, 0.697454],
            [0.409371, 0.322644, 0.386521, 1.0406],
            0.041311,
        ),
        (
            [1.0, 0.0, 0.0],
            [1.60132, 1.27947, 0.883628],
            [1.13342, 1.45116, 1.40214, 1.36471],
            0.064297,
        ),
        (
            [0.618853, 0.309426, -0.721995],
            [1.25294, 0.611261, 0.466985],
            [0.492615, 0.572188, 0.653089, 1.24651],
            0.037799,
        ),
        (
            [-0.341882, -0.911685, 0.227921],
            [1.81901, 1.69568, 1.77782],
            [1.77917, 1.97309, 1.72002, 1.54826],
            0.103499,
        ),
        (
            [0.104828, 0.943456, 0.314485],
            [1.64691, 0.885109, 0.495848],
            [0.395205, 0.566858, 0.75669, 1.16199],
            0.110770,
        ),
        (
            [-0.880451, 0.17609, -0.440225],
            [5.52132, 1.84044, 3.61864],
            [5.67099, 2.70071, 2.19473, 6.11437],
            0.150384,
        ),
    ] {
        let direction = Vec3::from(direction);
        let values = light.radiance::<Rgb>(direction, &());
        assert_close(&values.0, &rgb, 1e-4);
        let values = light.radiance::<Spectral<4>>(direction, &Wavelengths::at(NM));
        assert_close(&values.0, &spectral, 0.01);
        assert_close(&[light.pdf(direction).0], &[pdf], 1e-3);
    }
}

/// The same with `'mis_compensation': True`, unscaled and not turned.
#[test]
fn compensated_densities_are_mitsubas() {
    let light = environment(1.0, true, Mat3::IDENTITY);
    for (direction, pdf) in [
        ([0.0, 0.0, -1.0], 0.0987329),
        ([1.0, 0.0, 0.0], 0.0),
        ([0.618853, 0.309426, -0.721995], 0.00608390),
        ([-0.341882, -0.911685, 0.227921], 0.0651594),
        ([0.104828, 0.943456, 0.314485], 0.508253),
        ([-0.880451, 0.17609, -0.440225], 0.123669),
    ] {
        assert_close(&[light.pdf(direction.into()).0], &[pdf], 1e-3);
    }
}

/// Chi-square over cells of equal solid angle, of the density that `pdf` claims.
#[test]
fn directions_follow_the_density() {
    const AROUND: usize = 24;
    const DOWN: usize = 12;
    const FINE: usize = 16;
    const DRAWS: usize = 200_000;
    for compensates in [false, true] {
        let light = environment(1.0, compensates, turned());
        let mut random = RandomStream::new(StreamKey {
            seed: 3,
            tile: 0,
            pass: 0,
        });
        let mut counts = [0.0; AROUND * DOWN];
        for _ in 0..DRAWS {
            let u = random.uniform_2d();
            let Some(sample) = light.sample::<Rgb>(&(), u) else {
                continue;
            };
            let direction = sample.direction;
            assert!((direction.length() - 1.0).abs() < 1e-5);
            let pdf = sample.pdf.unwrap().0;
            assert_close(&[light.pdf(direction).0], &[pdf], 2e-3);
            let radiance = light.radiance::<Rgb>(direction, &());
            assert_close(&(sample.weight * pdf).0, &radiance.0, 2e-3);
            let around = (direction.y.atan2(direction.x) / (2.0 * PI)).rem_euclid(1.0);
            let (across, down) = (
                around * AROUND as f32,
                (0.5 - 0.5 * direction.z) * DOWN as f32,
            );
            counts[(down as usize).min(DOWN - 1) * AROUND + (across as usize).min(AROUND - 1)] +=
                1.0;
        }
        let (mut statistic, mut freedom, mut total) = (0.0, -1.0, 0.0);
        for (cell, count) in counts.into_iter().enumerate() {
            let mut expected = 0.0;
            for step in 0..FINE * FINE {
                let place = |cell: usize, step: usize, cells: usize| {
                    (cell as f32 + (step as f32 + 0.5) / FINE as f32) / cells as f32
                };
                let longitude = 2.0 * PI * place(cell % AROUND, step % FINE, AROUND);
                let z = 1.0 - 2.0 * place(cell / AROUND, step / FINE, DOWN);
                let r = (1.0 - z * z).sqrt();
                let direction = Vec3::new(r * longitude.cos(), r * longitude.sin(), z);
                expected += f64::from(light.pdf(direction).0);
            }
            expected *= 4.0 * std::f64::consts::PI / (AROUND * DOWN * FINE * FINE) as f64;
            total += expected;
            expected *= DRAWS as f64;
            if expected >= 8.0 {
                statistic += (count - expected) * (count - expected) / expected;
                freedom += 1.0;
            }
        }
        assert!(
            (total - 1.0).abs() < 2e-3,
            "the density integrates to {total}"
        );
        let p = ChiSquared::new(freedom).unwrap().sf(statistic);
        assert!(
            p > 1e-4,
            "compensated {compensates}: {statistic} of {freedom}, p = {p}"
        );
    }
}

#[test]
fn black_surroundings_send_nothing() {
    let image = image([[[0.0; 3]; 2]; 3]);
    let light = EnvironmentMap::new(&image, 1.0, false, Mat3::IDENTITY).unwrap();
    assert!(light.sample::<Rgb>(&(), [0.5; 2]).is_none());
    assert!(light.radiance::<Rgb>(Vec3::X, &()).is_black());
    assert_eq!(light.pdf(Vec3::X), SolidAnglePdf(0.0));
}

/// The density at the poles has a finite limit, and no sample there is infinite.
#[test]
fn poles_do_no_harm() {
    let light = environment(1.0, false, Mat3::IDENTITY);
    for direction in [
        Vec3::Y,
        -Vec3::Y,
        Vec3::new(1e-7, 1.0, 0.0),
        Vec3::new(0.0, -1.0, 1e-6),
    ] {
        assert!(light.pdf(direction).0.is_finite());
        assert!(light.radiance::<Rgb>(direction, &()).is_finite());
    }
    for u in [0.0, 1e-8, 1e-4, 0.5, 0.999_999_94] {
        for v in [0.0, 1e-8, 1e-4, 0.999_9, 0.999_999_94] {
            if let Some(sample) = light.sample::<Rgb>(&(), [u, v]) {
                assert!(
                    sample.weight.is_finite() && sample.direction.is_finite(),
                    "{u} {v}"
                );
            }
        }
    }
}

#[test]
fn what_cannot_surround_is_refused() {
    let new = |image: &ImageFile, scale| {
        EnvironmentMap::new(image, scale, false, Mat3::IDENTITY).unwrap_err()
    };
    assert!(new(&image([[[1.0; 3]; 1]; 3]), 1.0).contains("2 x 3"));
    assert!(new(&image([[[1.0; 3]; 2]; 2]), 1.0).contains("2 x 3"));
    for bad in [-1.0, f32::NAN, f32::INFINITY, 1e31] {
        let mut picture = PICTURE;
        picture[2][1][0] = bad;
        let message = new(&image(picture), 1.0);
        assert!(message.contains("column 1 of row 2"), "{message}");
    }
    assert!(new(&image(PICTURE), 1e30).contains("radiance"));
}

#[test]
fn scene_files_name_the_image() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sky.pfm");
    let mut bytes = b"PF\n4 5\n-1\n".to_vec();
    for row in PICTURE.iter().rev() {
        bytes.extend(row.iter().flatten().flat_map(|value| value.to_le_bytes()));
    }
    std::fs::write(&path, bytes).unwrap();
    let filename = format!(r#"<string name="filename" value="{}"/>"#, path.display());
    let scene = |parameters: &str| {
        load_all(&format!(
            r#"<emitter type="envmap">{filename}{parameters}</emitter>"#
        ))
    };
    let found = scene(
        r#"<float name="scale" value="2"/><transform name="to_world"><rotate y="1" angle="90"/></transform>"#,
    )
    .unwrap();
    let emitter = &found.emitters[0];
    assert!(emitter.surrounds() && !emitter.is_delta());
    // +z of the image is +x of the world.
    let expected = environment(2.0, false, Mat3::IDENTITY).radiance::<Rgb>(Vec3::Z, &());
    let seen = emitter.surrounding_radiance::<Rgb>(Vec3::X, &());
    assert_close(&seen.0, &expected.0, 1e-3);
    for (parameters, message) in [
        (r#"<float name="scale" value="-1"/>"#, "`scale`"),
        (
            r#"<transform name="to_world"><scale x="2"/></transform>"#,
            "stretch",
        ),
        (r#"<boolean name="no_such" value="true"/>"#, "no_such"),
    ] {
        let error = scene(parameters).unwrap_err();
        assert!(error.contains(message), "{error}");
    }
    let two = format!(r#"<emitter type="envmap">{filename}</emitter><emitter type="constant"/>"#);
    assert!(load_all(&two).unwrap_err().contains("surrounds"));
    let missing =
        r#"<emitter type="envmap"><string name="filename" value="no/such.exr"/></emitter>"#;
    assert!(load_all(missing).unwrap_err().contains("no/such.exr"));
}

/// An image of one colour and the constant light that takes its place: every direction, by wavelength and in three channels.
#[test]
fn an_image_of_one_colour_is_a_constant_light() {
    let colour = [0.75, 0.25, 1.5];
    let map = EnvironmentMap::new(&image([[colour; 4]; 5]), 2.0, false, turned()).unwrap();
    assert_eq!(map.uniform(), Some(colour.map(|channel| 2.0 * channel)));
    assert_eq!(environment(2.0, false, turned()).uniform(), None);
    let light = ConstantLight {
        radiance: SpectralCurve::rgb_emission(map.uniform().unwrap()).unwrap(),
    };
    for direction in [Vec3::X, Vec3::NEG_Y, Vec3::new(0.6, 0.0, -0.8)] {
        let rgb = map.radiance::<Rgb>(direction, &());
        assert_close(&rgb.0, &light.radiance::<Rgb>(&()).0, 1e-5);
        let at = Wavelengths::at(NM);
        let spectral = map.radiance::<Spectral<4>>(direction, &at);
        assert_close(&spectral.0, &light.radiance::<Spectral<4>>(&at).0, 1e-3);
    }
}
