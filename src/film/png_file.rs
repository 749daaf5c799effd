//! PNG files: what an eye sees of the image.

use std::path::Path;

use super::{FilmFileError, Image, WholeFile};
use crate::scene::ImageSize;

/// Below this value colours stay as they are; above, they are compressed.
const SHOULDER: f32 = 0.8;

/// Writes an 8-bit sRGB PNG of a linear image.
///
/// Tone mapping leaves everything whose largest channel is up to 0.8 as it is and rolls off what is brighter towards 1,
/// with its hue kept: a lamp is white or coloured instead of cut off channel by channel.
pub fn write_png(path: &Path, image: &Image) -> Result<(), FilmFileError> {
    write_rgb8(path, image.size(), &srgb_bytes(image))
}

/// Writes three bytes of sRGB by pixel, row by row from the top, as a PNG.
pub fn write_rgb8(path: &Path, size: ImageSize, bytes: &[u8]) -> Result<(), FilmFileError> {
    WholeFile::create(path)?.finish(|writer| {
        let refuse = |error: png::EncodingError| FilmFileError::Encode {
            path: path.to_owned(),
            message: error.to_string(),
        };
        let mut encoder = png::Encoder::new(writer, size.width, size.height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut png = encoder.write_header().map_err(refuse)?;
        png.write_image_data(bytes).map_err(refuse)?;
        png.finish().map_err(refuse)
    })
}

/// What [`write_png`] writes: three bytes of tone-mapped sRGB by pixel, row by row from the top.
pub fn srgb_bytes(image: &Image) -> Vec<u8> {
    let pixels = image.pixels().iter();
    pixels
        .flat_map(|&pixel| tone_map(pixel).map(encode))
        .collect()
}

/// Linear values in [0, 1]; negative ones (colours beyond sRGB) become 0.
fn tone_map(pixel: [f32; 3]) -> [f32; 3] {
    let positive = pixel.map(|value| if value > 0.0 { value } else { 0.0 });
    let peak = positive.into_iter().fold(0.0, f32::max);
    if peak <= SHOULDER {
        return positive;
    }
    let rest = 1.0 - SHOULDER;
    let compressed = SHOULDER + rest * (1.0 - (-(peak - SHOULDER) / rest).exp());
    positive.map(|value| {
        if value.is_finite() {
            value * (compressed / peak)
        } else {
            1.0
        }
    })
}

/// The transfer function of sRGB (IEC 61966-2-1).
fn encode(linear: f32) -> u8 {
    let encoded = if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    };
    (encoded * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mid_tones_are_plain_srgb_and_lamps_keep_their_hue() {
        assert_eq!(tone_map([0.2, 0.5, 0.8]).map(encode), [124, 188, 231]);
        let lamp = tone_map([40.0, 20.0, 10.0]);
        assert!(lamp[0] <= 1.0 && (lamp[0] / lamp[1] - 2.0).abs() < 1e-5);
        assert_eq!(tone_map([-1.0, f32::NAN, f32::INFINITY]), [0.0, 0.0, 1.0]);
    }
}
