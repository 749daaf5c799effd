//! The image files of the competitors: read, cut, put side by side, and turned into text that a page can hold.

use std::fs;
use std::io::Cursor;
use std::path::Path;

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;

use super::ReportError;
use crate::study::results::{Crop, Results};

/// Pixels between the parts of the figure.
const GAP: usize = 8;
/// Crops below each image of the figure, as in the paper.
const CROPS_IN_FIGURE: usize = 2;

/// An 8-bit RGB picture, rows from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    pixels: Vec<[u8; 3]>,
}

impl Picture {
    /// A white picture.
    fn white(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            pixels: vec![[255; 3]; width * height],
        }
    }

    /// Reads a PNG of any depth and colour type; transparency is ignored.
    pub fn read(path: &Path) -> Result<Self, ReportError> {
        let bytes = read(path)?;
        let refuse = |error: png::DecodingError| ReportError::Decode {
            path: path.to_owned(),
            message: error.to_string(),
        };
        let mut decoder = png::Decoder::new(Cursor::new(bytes));
        decoder.set_transformations(png::Transformations::normalize_to_color8());
        let mut reader = decoder.read_info().map_err(refuse)?;
        let size = reader.output_buffer_size().unwrap_or_default();
        let mut buffer = vec![0; size];
        let frame = reader.next_frame(&mut buffer).map_err(refuse)?;
        let channels = frame.color_type.samples();
        let pixels =
            buffer[..frame.buffer_size()]
                .chunks_exact(channels)
                .map(|pixel| match *pixel {
                    [r, g, b] | [r, g, b, _] => [r, g, b],
                    [grey, ..] => [grey; 3],
                    [] => [0; 3],
                });
        Ok(Self {
            width: frame.width as usize,
            height: frame.height as usize,
            pixels: pixels.collect(),
        })
    }

    /// The part that lies inside of the picture.
    pub fn cropped(&self, crop: &Crop) -> Self {
        let clamp = |start: u32, length: u32, end: usize| {
            let start = (start as usize).min(end);
            start..start.saturating_add(length as usize).min(end)
        };
        let columns = clamp(crop.x, crop.width, self.width);
        let rows = clamp(crop.y, crop.height, self.height);
        let pixels = rows
            .clone()
            .flat_map(|row| &self.pixels[row * self.width..][columns.clone()]);
        Self {
            width: columns.len(),
            height: rows.len(),
            pixels: pixels.copied().collect(),
        }
    }

    /// The picture in another size; every pixel is that of the nearest one.
    fn resized(&self, width: usize, height: usize) -> Self {
        let pixels = (0..height).flat_map(|row| {
            let source = row * self.height / height * self.width;
            (0..width).map(move |column| self.pixels[source + column * self.width / width])
        });
        Self {
            width,
            height,
            pixels: pixels.collect(),
        }
    }

    /// Lays another picture over this one; it has to fit.
    fn paste(&mut self, other: &Self, x: usize, y: usize) {
        for (row, pixels) in other.pixels.chunks_exact(other.width.max(1)).enumerate() {
            self.pixels[(y + row) * self.width + x..][..other.width].copy_from_slice(pixels);
        }
    }

    /// The picture as the bytes of a PNG file.
    pub fn to_png(&self) -> Result<Vec<u8>, ReportError> {
        let refuse = |error: png::EncodingError| ReportError::Encode {
            what: "a picture",
            message: error.to_string(),
        };
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        let mut writer = encoder.write_header().map_err(refuse)?;
        writer
            .write_image_data(self.pixels.as_flattened())
            .map_err(refuse)?;
        writer.finish().map_err(refuse)?;
        Ok(bytes)
    }
}

/// Reads a file.
pub fn read(path: &Path) -> Result<Vec<u8>, ReportError> {
    fs::read(path).map_err(|source| ReportError::Read {
        path: path.to_owned(),
        source,
    })
}

/// The bytes of a PNG file as an address that holds them.
pub fn data_uri(png: &[u8]) -> String {
    format!("data:image/png;base64,{}", STANDARD.encode(png))
}

/// The figure: one repetition of every competitor in a row, two crops below each. `None` without competitors.
///
/// Files are looked for in `folder`. Pictures of different sizes are drawn in the size of the first.
pub fn figure(results: &Results, folder: &Path) -> Result<Option<Vec<u8>>, ReportError> {
    let mut pictures = Vec::new();
    for competitor in &results.competitors {
        pictures.push(Picture::read(&folder.join(&competitor.images.one_png))?);
    }
    let Some(first) = pictures.first() else {
        return Ok(None);
    };
    let (width, height) = (first.width, first.height);
    let crops: Vec<&Crop> = results
        .crops
        .iter()
        .filter(|crop| {
            let cropped = first.cropped(crop);
            cropped.width > 0 && cropped.height > 0
        })
        .take(CROPS_IN_FIGURE)
        .collect();
    let crop_width = match crops.len() {
        0 => 0,
        count => width.saturating_sub(GAP * (count - 1)) / count,
    };
    // Of equal height, whatever their shapes are, so that the row is even.
    let crop_height = crops
        .iter()
        .map(|crop| crop_width * crop.height as usize / crop.width.max(1) as usize)
        .min()
        .unwrap_or(0);
    let below = if crops.is_empty() {
        0
    } else {
        GAP + crop_height
    };
    let mut figure = Picture::white(pictures.len() * (width + GAP) - GAP, height + below);
    for (index, picture) in pictures.iter().enumerate() {
        let left = index * (width + GAP);
        figure.paste(&picture.resized(width, height), left, 0);
        for (place, crop) in crops.iter().enumerate() {
            let cropped = picture.cropped(&with_shape(crop, crop_width, crop_height));
            if cropped.width > 0 && cropped.height > 0 {
                let enlarged = cropped.resized(crop_width, crop_height);
                figure.paste(&enlarged, left + place * (crop_width + GAP), height + GAP);
            }
        }
    }
    figure.to_png().map(Some)
}

/// The crop with fewer rows, from its middle, where it is too high for the shape `width` by `height`.
fn with_shape(crop: &Crop, width: usize, height: usize) -> Crop {
    let rows = (crop.width as usize * height / width.max(1)) as u32;
    let rows = rows.clamp(1, crop.height.max(1));
    Crop {
        y: crop.y + (crop.height - rows.min(crop.height)) / 2,
        height: rows,
        ..*crop
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crops_end_at_the_border_and_survive_a_png() {
        let mut picture = Picture::white(4, 3);
        picture.paste(
            &Picture {
                width: 1,
                height: 1,
                pixels: vec![[1, 2, 3]],
            },
            3,
            2,
        );
        let crop = Crop {
            x: 2,
            y: 1,
            width: 9,
            height: 9,
        };
        let cropped = picture.cropped(&crop);
        assert_eq!((cropped.width, cropped.height), (2, 2));
        assert_eq!(cropped.pixels[3], [1, 2, 3]);
        let file = tempfile::NamedTempFile::new().unwrap();
        fs::write(file.path(), cropped.to_png().unwrap()).unwrap();
        assert_eq!(Picture::read(file.path()).unwrap(), cropped);
        let enlarged = cropped.resized(4, 4);
        assert_eq!(enlarged.pixels[15], [1, 2, 3]);
        assert_eq!(enlarged.pixels[5], [255; 3]);
    }
}
