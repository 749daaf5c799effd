//! Images from files: PNG, JPEG, BMP, TGA, RGBE by the `image` crate, OpenEXR by the `exr` crate, PFM by a few lines.

use std::fs;
use std::path::Path;

use exr::prelude as exr;
use image::{DynamicImage, ImageReader};

/// An image as its file holds it.
#[derive(Debug)]
pub(super) struct ImageFile {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Its pixels, row by row from the top.
    pub pixels: Pixels,
    /// Whether numbers are encoded by the curve of sRGB, as those of files with integers are.
    pub is_encoded: bool,
}

/// The pixels of an image, 0 for black and 1 for white. What a file says of transparency is left out.
#[derive(Debug)]
pub(super) enum Pixels {
    /// One number each.
    Grey(Vec<f32>),
    /// Red, green and blue.
    Rgb(Vec<[f32; 3]>),
}

/// The most pixels of an image: beyond, a file is taken for damaged.
const MOST_PIXELS: usize = 1 << 29;

/// Reads an image.
///
/// # Errors
/// What is wrong with the file, in words that follow on "cannot read FILE: ".
pub(super) fn read(path: &Path) -> Result<ImageFile, String> {
    let extension = path.extension().and_then(|extension| extension.to_str());
    match extension.map(str::to_ascii_lowercase).as_deref() {
        Some("exr") => read_exr(path),
        Some("pfm") => read_pfm(path),
        _ => read_other(path),
    }
}

fn read_other(path: &Path) -> Result<ImageFile, String> {
    let reader = ImageReader::open(path)
        .and_then(ImageReader::with_guessed_format)
        .map_err(|error| error.to_string())?;
    let image = reader.decode().map_err(|error| error.to_string())?;
    let (width, height) = (image.width() as usize, image.height() as usize);
    let is_encoded = !matches!(
        image,
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_)
    );
    let pixels = if image.color().has_color() {
        let pixels = image.into_rgb32f();
        Pixels::Rgb(pixels.pixels().map(|pixel| pixel.0).collect())
    } else {
        let pixels = image.into_luma16();
        let number = |value: u16| f32::from(value) / f32::from(u16::MAX);
        Pixels::Grey(pixels.pixels().map(|pixel| number(pixel.0[0])).collect())
    };
    Ok(ImageFile {
        width,
        height,
        pixels,
        is_encoded,
    })
}

fn read_exr(path: &Path) -> Result<ImageFile, String> {
    use exr::{ReadChannels, ReadLayers};
    let image = exr::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .map_err(|error| error.to_string())?;
    let layer = image.layer_data;
    let (width, height) = (layer.size.x(), layer.size.y());
    let channels = &layer.channel_data.list;
    let channel = |name: &str| {
        let found = channels.iter().find(|channel| channel.name.eq(name));
        found.filter(|channel| channel.sampling == exr::Vec2(1, 1))
    };
    let values = |channel: &exr::AnyChannel<exr::FlatSamples>| -> Vec<f32> {
        channel.sample_data.values_as_f32().collect()
    };
    let pixels = match (channel("R"), channel("G"), channel("B"), channel("Y")) {
        (Some(red), Some(green), Some(blue), _) => {
            let [red, green, blue] = [red, green, blue].map(values);
            let pixels = red.into_iter().zip(green).zip(blue);
            Pixels::Rgb(
                pixels
                    .map(|((red, green), blue)| [red, green, blue])
                    .collect(),
            )
        }
        (_, _, _, Some(luminance)) => Pixels::Grey(values(luminance)),
        _ => return Err("it has neither the channels R, G and B nor Y".to_owned()),
    };
    Ok(ImageFile {
        width,
        height,
        pixels,
        is_encoded: false,
    })
}

/// Portable float maps: `PF` or `Pf`, width, height, a scale whose sign tells the byte order, then rows from the bottom.
fn read_pfm(path: &Path) -> Result<ImageFile, String> {
    let bytes = fs::read(path).map_err(|error| error.to_string())?;
    let mut rest = &bytes[..];
    let mut word = || {
        let start = rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let length = rest[start..].iter().position(u8::is_ascii_whitespace)?;
        let word = std::str::from_utf8(&rest[start..start + length]).ok()?;
        // One white space after the header's last word belongs to it.
        rest = &rest[start + length + 1..];
        Some(word)
    };
    let header = (word(), word(), word(), word());
    let (Some(kind @ ("PF" | "Pf")), Some(width), Some(height), Some(scale)) = header else {
        return Err("it does not begin like a PFM file".to_owned());
    };
    let (Ok(width), Ok(height), Ok(scale)) = (
        width.parse::<usize>(),
        height.parse::<usize>(),
        scale.parse::<f32>(),
    ) else {
        return Err("its width, height or scale is not a number".to_owned());
    };
    let channels = if kind == "PF" { 3 } else { 1 };
    let count = width
        .checked_mul(height)
        .filter(|&count| count <= MOST_PIXELS);
    let count = count.ok_or_else(|| format!("{width} x {height} pixels are too many"))?;
    if rest.len() != count * channels * 4 {
        return Err(format!(
            "{width} x {height} pixels with {channels} channels need {} bytes, but it has {}",
            count * channels * 4,
            rest.len()
        ));
    }
    let number = |bytes: &[u8]| {
        let bytes = [bytes[0], bytes[1], bytes[2], bytes[3]];
        let number = if scale < 0.0 {
            f32::from_le_bytes(bytes)
        } else {
            f32::from_be_bytes(bytes)
        };
        number * scale.abs()
    };
    let rows = rest.chunks_exact((width * channels * 4).max(1)).rev();
    let numbers = rows.flat_map(|row| row.chunks_exact(4)).map(number);
    let pixels = if channels == 1 {
        Pixels::Grey(numbers.collect())
    } else {
        let numbers: Vec<f32> = numbers.collect();
        Pixels::Rgb(
            numbers
                .chunks_exact(3)
                .map(|rgb| [rgb[0], rgb[1], rgb[2]])
                .collect(),
        )
    };
    Ok(ImageFile {
        width,
        height,
        pixels,
        is_encoded: false,
    })
}

impl ImageFile {
    /// The image in numbers proportional to light, which `raw` says that it is in already; with a flaw, if it has one, such as an
    /// impossible number.
    pub fn decoded(mut self, raw: bool) -> Result<Self, String> {
        if self.width == 0 || self.height == 0 {
            return Err("it has no pixels".to_owned());
        }
        if self.is_encoded && !raw {
            match &mut self.pixels {
                Pixels::Grey(pixels) => pixels.iter_mut().for_each(|value| *value = linear(*value)),
                Pixels::Rgb(pixels) => pixels.iter_mut().for_each(|rgb| *rgb = rgb.map(linear)),
            }
        }
        self.is_encoded = false;
        let flaw = self.numbers().position(|number| !number.is_finite());
        let Some(index) = flaw else {
            return Ok(self);
        };
        let pixel = index / self.channels();
        let (x, y) = (pixel % self.width, pixel / self.width);
        Err(format!("the pixel ({x}, {y}) is infinite or not a number"))
    }

    fn channels(&self) -> usize {
        match &self.pixels {
            Pixels::Grey(_) => 1,
            Pixels::Rgb(_) => 3,
        }
    }

    /// All numbers, row by row.
    fn numbers(&self) -> impl Iterator<Item = f32> {
        let (grey, rgb): (&[f32], &[[f32; 3]]) = match &self.pixels {
            Pixels::Grey(pixels) => (pixels, &[]),
            Pixels::Rgb(pixels) => (&[], pixels),
        };
        grey.iter().chain(rgb.iter().flatten()).copied()
    }

    /// Where the first number outside of [0, 1] is: column, row and the number.
    pub fn first_outside_unit(&self) -> Option<(usize, usize, f32)> {
        let outside = |&(_, number): &(usize, f32)| !(0.0..=1.0).contains(&number);
        let (index, number) = self.numbers().enumerate().find(outside)?;
        let pixel = index / self.channels();
        Some((pixel % self.width, pixel / self.width, number))
    }
}

/// The light of a number encoded by sRGB's curve (IEC 61966-2-1).
fn linear(encoded: f32) -> f32 {
    if encoded <= 0.04045 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}
