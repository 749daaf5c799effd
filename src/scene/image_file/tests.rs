use std::io::Cursor;

use image::{ImageBuffer, Luma, LumaA, Rgb, Rgba};

use super::*;

/// Writes `bytes` into a file and reads that.
fn read(bytes: &[u8]) -> Result<ImageFile, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("image");
    std::fs::write(&path, bytes).unwrap();
    ImageFile::read(&path).map_err(|error| {
        assert_eq!(error.file, path);
        error.problem
    })
}

fn encoded(image: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, format).unwrap();
    bytes.into_inner()
}

const SIZE: ImageSize = ImageSize {
    width: 3,
    height: 2,
};

/// The image of [`SIZE`] with a colour that tells columns from rows.
fn picture() -> ImageBuffer<Rgb<u8>, Vec<u8>> {
    ImageBuffer::from_fn(3, 2, |x, y| Rgb([51 * x as u8, 255 * y as u8, 102]))
}

const PICTURE: [f32; 18] = [
    0.0, 0.0, 0.4, 0.2, 0.0, 0.4, 0.4, 0.0, 0.4, // the upper row
    0.0, 1.0, 0.4, 0.2, 1.0, 0.4, 0.4, 1.0, 0.4,
];

#[track_caller]
fn assert_close(values: &[f32], expected: &[f32], tolerance: f32) {
    assert_eq!(values.len(), expected.len());
    for (value, expected) in values.iter().zip(expected) {
        assert!((value - expected).abs() <= tolerance, "{values:?}");
    }
}

#[test]
fn integers_are_srgb_from_0_to_1() {
    for format in [ImageFormat::Png, ImageFormat::Bmp] {
        let image = read(&encoded(picture(), format)).unwrap();
        assert_eq!((image.size, image.channels), (SIZE, Channels::Rgb));
        assert_eq!(image.encoding, Encoding::Srgb);
        assert_close(&image.values, &PICTURE, 1e-6);
        let linear = image.into_linear();
        assert_eq!(linear.encoding, Encoding::Linear);
        // mi.Bitmap of the same, converted to linear: 0.2 -> 0.0331, 0.4 -> 0.13287
        assert_close(
            &linear.values[9..15],
            &[0.0, 1.0, 0.132_868, 0.033_105, 1.0, 0.132_868],
            2e-6,
        );
    }
}

#[test]
fn photographs_are_read() {
    let grey = ImageBuffer::from_pixel(16, 8, Luma([128_u8]));
    let image = read(&encoded(grey, ImageFormat::Jpeg)).unwrap();
    assert_eq!((image.size.width, image.size.height), (16, 8));
    assert_eq!(
        (image.channels, image.encoding),
        (Channels::Grey, Encoding::Srgb)
    );
    assert_close(&image.values, &[128.0 / 255.0; 128], 0.005);
    assert_eq!(image.rgb().len(), 128);
}

#[test]
fn opacities_stay_as_they_are() {
    let grey = ImageBuffer::from_pixel(1, 1, LumaA([65535_u16, 13107]));
    let image = read(&encoded(grey, ImageFormat::Png))
        .unwrap()
        .into_linear();
    assert_eq!(image.channels, Channels::GreyAlpha);
    assert_close(&image.values, &[1.0, 0.2], 1e-6);
    assert_eq!(image.rgb().collect::<Vec<_>>(), [[1.0; 3]]);
    let colour = ImageBuffer::from_pixel(1, 1, Rgba([255_u8, 0, 102, 102]));
    let image = read(&encoded(colour, ImageFormat::Png))
        .unwrap()
        .into_linear();
    assert_eq!(image.channels, Channels::Rgba);
    assert_close(&image.values, &[1.0, 0.0, 0.132_868, 0.4], 2e-6);
}

#[test]
fn floating_point_files_are_linear() {
    let picture: Vec<f32> = PICTURE.iter().map(|value| 100.0 * value).collect();
    let buffer: ImageBuffer<Rgb<f32>, Vec<f32>> =
        ImageBuffer::from_raw(3, 2, picture.clone()).unwrap();
    let radiance = encoded(buffer, ImageFormat::Hdr);
    // Mitsuba and others call it so.
    let rgbe = [b"#?RGBE", &radiance[b"#?RADIANCE".len()..]].concat();
    for file in [radiance, rgbe] {
        let image = read(&file).unwrap();
        assert_eq!((image.size, image.channels), (SIZE, Channels::Rgb));
        // Eight bits beside a common exponent.
        assert_close(&image.values, &picture, 0.5);
        assert_eq!(image.clone().into_linear(), image);
    }

    for (order, bytes) in [
        ("-1.0", f32::to_le_bytes as fn(f32) -> [u8; 4]),
        ("1.0", f32::to_be_bytes),
    ] {
        let mut file = format!("PF\n3 2\n{order}\n").into_bytes();
        // The lower row comes first.
        for value in picture[9..].iter().chain(&picture[..9]) {
            file.extend(bytes(*value));
        }
        let image = read(&file).unwrap();
        assert_eq!((image.size, image.channels), (SIZE, Channels::Rgb));
        assert_eq!(
            (image.values, image.encoding),
            (picture.clone(), Encoding::Linear)
        );
    }
}

#[test]
fn openexr_is_read_whatever_its_numbers() {
    use exr::prelude::{AnyChannel, AnyChannels, Encoding, Image, Layer, LayerAttributes};
    use exr::prelude::{FlatSamples, SmallVec, WritableImage, f16};
    let write = |channels: Vec<AnyChannel<FlatSamples>>| {
        let channels = AnyChannels::sort(SmallVec::from_vec(channels));
        let attributes = LayerAttributes::default();
        let layer = Layer::new((2, 1), attributes, Encoding::SMALL_LOSSLESS, channels);
        let mut bytes = Cursor::new(Vec::new());
        let image = Image::from_layer(layer);
        image.write().to_buffered(&mut bytes).unwrap();
        bytes.into_inner()
    };
    let single = |name, values: [f32; 2]| AnyChannel::new(name, FlatSamples::F32(values.to_vec()));
    let half = |name, values: [f32; 2]| {
        AnyChannel::new(name, FlatSamples::F16(values.map(f16::from_f32).to_vec()))
    };
    let colours = || {
        vec![
            single("R", [1.0, 2.0]),
            half("G", [3.0, 4.0]),
            single("B", [5.0, 6.0]),
        ]
    };
    let image = read(&write(colours())).unwrap();
    assert_eq!(image.channels, Channels::Rgb);
    assert_eq!(image.values, [1.0, 3.0, 5.0, 2.0, 4.0, 6.0]);
    let with_alpha = colours().into_iter().chain([half("A", [0.5, 1.0])]);
    let image = read(&write(with_alpha.collect())).unwrap();
    assert_eq!(image.channels, Channels::Rgba);
    assert_eq!(image.values, [1.0, 3.0, 5.0, 0.5, 2.0, 4.0, 6.0, 1.0]);
    let image = read(&write(vec![
        single("Y", [7.0, 8.0]),
        single("depth", [0.0, 1.0]),
    ]))
    .unwrap();
    assert_eq!(
        (image.channels, image.values),
        (Channels::Grey, vec![7.0, 8.0])
    );
    let problem = read(&write(vec![single("depth", [0.0, 1.0])])).unwrap_err();
    assert!(
        problem.contains("R, G and B") && problem.contains("depth"),
        "{problem}"
    );
}

#[test]
fn what_is_no_image_is_refused() {
    for (bytes, message) in [
        (&b""[..], "not an image"),
        (b"hello, world, this is text", "not an image"),
        (b"GIF89a..........", "not an image"),
        (b"PF\n3 2\n-1.0\n....", "truncated: 4 of 72"),
        (b"PF\n3 two\n-1.0\n", "`two`"),
        (b"Pf\n1 1\n0\n....", "scale"),
        (b"Pf\n0 1\n1\n", "0 x 1"),
        (b"Pf\n60000 60000\n1\n", "60000 x 60000"),
        (b"Pf\n99999999999999999999 1\n1\n", "pixels"),
    ] {
        let problem = read(bytes).unwrap_err();
        assert!(problem.contains(message), "{problem}");
    }
    let missing = ImageFile::read(Path::new("no/such.png"))
        .unwrap_err()
        .to_string();
    assert!(
        missing.starts_with("no/such.png: No such file"),
        "{missing}"
    );
}

/// A damaged file is an error or another image; it neither panics nor asks for endless memory.
#[test]
fn damage_does_no_harm() {
    let hdr: ImageBuffer<Rgb<f32>, Vec<f32>> = ImageBuffer::from_pixel(9, 5, Rgb([0.5; 3]));
    let folder = tempfile::tempdir().unwrap();
    let exr = folder.path().join("a.exr");
    let black = crate::film::Image::black(SIZE);
    crate::film::write_exr(&exr, &black, &crate::film::ExrOptions::default()).unwrap();
    let files = [
        encoded(picture(), ImageFormat::Png),
        encoded(picture(), ImageFormat::Jpeg),
        encoded(picture(), ImageFormat::Bmp),
        encoded(hdr, ImageFormat::Hdr),
        std::fs::read(exr).unwrap(),
        b"Pf\n1 1\n-1.0\nabcd".to_vec(),
    ];
    for file in files {
        assert!(read(&file).is_ok());
        for end in (0..file.len()).step_by(1 + file.len() / 64) {
            let _ = read(&file[..end]);
        }
        for at in (0..file.len()).step_by(1 + file.len() / 128) {
            for damage in [0, 1, 0x7f, 0xff] {
                let mut damaged = file.clone();
                damaged[at] = damage;
                let _ = read(&damaged);
            }
        }
    }
}

#[test]
fn numbers_that_do_not_fit_are_found() {
    let mut image = read(&encoded(picture(), ImageFormat::Png)).unwrap();
    assert_eq!(image.find_unfit(f32::is_finite), None);
    image.values[14] = f32::NAN;
    let message = image.find_unfit(f32::is_finite).unwrap();
    assert_eq!(message, "the pixel in column 1 of row 1 (from 0) is NaN");
}
