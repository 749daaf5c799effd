//! Images that a scene names: PNG, JPEG, BMP, Radiance HDR, OpenEXR and PFM, told apart by their first bytes.

mod exr_file;
mod pfm;

use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::{Path, PathBuf};

use image::codecs::hdr::HdrDecoder;
use image::{ColorType, DynamicImage, ImageDecoder, ImageFormat, ImageReader, ImageResult, Limits};

use super::ImageSize;
use super::error::SceneError;
use super::xml::{Document, Object};

/// The most pixels of an image: more would be gigabytes.
const MAX_PIXELS: u64 = 1 << 28;

/// How Radiance files begin.
const RADIANCE: &[u8] = b"#?";

/// An image as its file holds it.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageFile {
    /// Its size.
    pub size: ImageSize,
    /// What a pixel consists of.
    pub channels: Channels,
    /// What its numbers mean.
    pub encoding: Encoding,
    /// `channels.count()` numbers for each pixel, row by row from the top; those of 8-bit and 16-bit files scaled to
    /// [0, 1]. Those of other files can be any, also infinite or not a number.
    pub values: Vec<f32>,
}

/// What a pixel of an image consists of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channels {
    /// One number.
    Grey,
    /// One number and opacity.
    GreyAlpha,
    /// Red, green and blue.
    Rgb,
    /// Red, green, blue and opacity.
    Rgba,
}

/// What the numbers of an image are proportional to. Opacities are linear in both.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Light: files of floating-point numbers.
    Linear,
    /// Light after sRGB's transfer function: files of integers.
    Srgb,
}

/// Why an image cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}: {problem}", file.display())]
pub struct ImageFileError {
    /// The file.
    pub file: PathBuf,
    /// What is wrong with it.
    pub problem: String,
}

/// The image that the parameter `filename` of `object` names, looked for as the scene says.
pub(super) fn load(object: &Object, document: &Document) -> Result<ImageFile, SceneError> {
    const NAME: &str = "filename";
    let filename = object.string(NAME)?.ok_or_else(|| object.missing(NAME))?;
    let path = document.resolve(object, NAME, filename)?;
    ImageFile::read(&path).map_err(|error| object.parameter_error(NAME, error.to_string()))
}

impl Channels {
    /// Numbers per pixel.
    pub fn count(self) -> usize {
        self.colours() + usize::from(self.has_alpha())
    }

    /// Numbers per pixel without the opacity.
    pub fn colours(self) -> usize {
        match self {
            Self::Grey | Self::GreyAlpha => 1,
            Self::Rgb | Self::Rgba => 3,
        }
    }

    /// Whether the last number is an opacity.
    pub fn has_alpha(self) -> bool {
        matches!(self, Self::GreyAlpha | Self::Rgba)
    }
}

impl ImageFile {
    /// Reads an image. What the format is decides its content, not its name.
    ///
    /// # Errors
    /// A file that cannot be read, that is damaged or of another format, or that is too large.
    pub fn read(path: &Path) -> Result<Self, ImageFileError> {
        let read = || {
            let mut file = BufReader::new(File::open(path).map_err(|error| error.to_string())?);
            let mut start = Vec::with_capacity(16);
            file.by_ref()
                .take(16)
                .read_to_end(&mut start)
                .and_then(|_| file.rewind())
                .map_err(|error| error.to_string())?;
            if start.starts_with(exr_file::MAGIC) {
                exr_file::read(file)
            } else if pfm::is_pfm(&start) {
                pfm::read(file)
            } else {
                Self::decode(file, &start)
            }
        };
        read().map_err(|problem| ImageFileError {
            file: path.to_owned(),
            problem,
        })
    }

    /// The same image with values that are proportional to light.
    pub fn into_linear(mut self) -> Self {
        if self.encoding == Encoding::Srgb {
            let colours = self.channels.colours();
            for pixel in self.values.chunks_exact_mut(self.channels.count()) {
                for value in &mut pixel[..colours] {
                    *value = srgb_to_linear(*value);
                }
            }
            self.encoding = Encoding::Linear;
        }
        self
    }

    /// Red, green and blue of every pixel, row by row from the top; where the image is grey, the same number thrice.
    pub fn rgb(&self) -> impl ExactSizeIterator<Item = [f32; 3]> {
        let colours = self.channels.colours();
        let pixels = self.values.chunks_exact(self.channels.count());
        pixels.map(move |pixel| match pixel[..colours] {
            [r, g, b] => [r, g, b],
            _ => [pixel[0]; 3],
        })
    }

    /// The first pixel with a number that does not fit, in words; `None` where all do.
    pub fn find_unfit(&self, fits: impl Fn(f32) -> bool) -> Option<String> {
        let index = self.values.iter().position(|&value| !fits(value))?;
        let pixel = index / self.channels.count();
        let width = self.size.width as usize;
        Some(format!(
            "the pixel in column {} of row {} (from 0) is {}",
            pixel % width,
            pixel / width,
            self.values[index]
        ))
    }

    /// Reads what the library `image` knows.
    fn decode(file: BufReader<File>, start: &[u8]) -> Result<Self, String> {
        const UNKNOWN: &str =
            "it is not an image of a known format; known are PNG, JPEG, BMP, HDR, OpenEXR and PFM";
        let format = if start.starts_with(RADIANCE) {
            ImageFormat::Hdr
        } else {
            image::guess_format(start).map_err(|_| UNKNOWN)?
        };
        let encoding = match format {
            ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::Bmp => Encoding::Srgb,
            ImageFormat::Hdr => Encoding::Linear,
            _ => return Err(UNKNOWN.to_owned()),
        };
        let decoded = if format == ImageFormat::Hdr {
            decode_radiance(file)
        } else {
            let mut reader = ImageReader::with_format(file, format);
            reader.limits(limits());
            reader.decode()
        };
        let image = decoded.map_err(|error| error.to_string())?;
        let size = size(image.width().into(), image.height().into())?;
        let channels = match image.color() {
            ColorType::L8 | ColorType::L16 => Channels::Grey,
            ColorType::La8 | ColorType::La16 => Channels::GreyAlpha,
            ColorType::Rgb8 | ColorType::Rgb16 | ColorType::Rgb32F => Channels::Rgb,
            _ => Channels::Rgba,
        };
        Ok(Self {
            size,
            channels,
            encoding,
            values: values(image, channels),
        })
    }
}

/// What an image may take.
fn limits() -> Limits {
    let mut limits = Limits::default();
    limits.max_image_width = Some(ImageSize::MAX_SIDE);
    limits.max_image_height = Some(ImageSize::MAX_SIDE);
    limits.max_alloc = Some(16 * MAX_PIXELS);
    limits
}

/// Reads a Radiance file, whatever program it says has written it: `#?RADIANCE`, `#?RGBE` and others are all about the same.
fn decode_radiance(file: BufReader<File>) -> ImageResult<DynamicImage> {
    let mut decoder = HdrDecoder::new_nonstrict(file)?;
    let mut limits = limits();
    limits.reserve(decoder.total_bytes())?;
    decoder.set_limits(limits)?;
    DynamicImage::from_decoder(decoder)
}

/// The numbers of a decoded image.
fn values(image: DynamicImage, channels: Channels) -> Vec<f32> {
    let from_bytes = |bytes: Vec<u8>| bytes.into_iter().map(|v| f32::from(v) / 255.0).collect();
    let from_words = |words: Vec<u16>| words.into_iter().map(|v| f32::from(v) / 65535.0).collect();
    match image {
        DynamicImage::ImageLuma8(image) => from_bytes(image.into_raw()),
        DynamicImage::ImageLumaA8(image) => from_bytes(image.into_raw()),
        DynamicImage::ImageRgb8(image) => from_bytes(image.into_raw()),
        DynamicImage::ImageRgba8(image) => from_bytes(image.into_raw()),
        DynamicImage::ImageLuma16(image) => from_words(image.into_raw()),
        DynamicImage::ImageLumaA16(image) => from_words(image.into_raw()),
        DynamicImage::ImageRgb16(image) => from_words(image.into_raw()),
        DynamicImage::ImageRgba16(image) => from_words(image.into_raw()),
        other if channels == Channels::Rgb => other.into_rgb32f().into_raw(),
        other => other.into_rgba32f().into_raw(),
    }
}

/// The size of an image that can be read.
fn size(width: u64, height: u64) -> Result<ImageSize, String> {
    let side = |length| {
        u32::try_from(length)
            .ok()
            .filter(|length| (1..=ImageSize::MAX_SIDE).contains(length))
    };
    match (side(width), side(height)) {
        (Some(width), Some(height)) if u64::from(width) * u64::from(height) <= MAX_PIXELS => {
            Ok(ImageSize { width, height })
        }
        _ => Err(format!(
            "it has {width} x {height} pixels; it must have some, at most {} on a side and {MAX_PIXELS} in all",
            ImageSize::MAX_SIDE
        )),
    }
}

/// Light for a value of sRGB, both from 0 to 1 (IEC 61966-2-1).
pub fn srgb_to_linear(value: f32) -> f32 {
    if value <= 0.04045 {
        value / 12.92
    } else {
        ((value + 0.055) / 1.055).powf(2.4)
    }
}

#[cfg(test)]
mod tests;
