//! A plain image in memory.

use std::path::PathBuf;

use thiserror::Error;

use crate::scene::ImageSize;

/// An image of linear sRGB values, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    size: ImageSize,
    pixels: Vec<[f32; 3]>,
}

/// Why an image file could not be written or read.
#[derive(Debug, Error)]
pub enum FilmFileError {
    /// The file system refused.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The encoder refused.
    #[error("cannot encode {}: {message}", path.display())]
    Encode {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
    /// The file is missing, or it is no EXR with R, G and B channels.
    #[error("cannot read {} as an EXR with channels R, G and B: {message}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        message: String,
    },
}

impl Image {
    /// A black image.
    pub fn black(size: ImageSize) -> Self {
        Self {
            size,
            pixels: vec![[0.0; 3]; size.pixels()],
        }
    }

    /// Size in pixels.
    pub fn size(&self) -> ImageSize {
        self.size
    }

    /// The pixels, row by row from the top.
    pub fn pixels(&self) -> &[[f32; 3]] {
        &self.pixels
    }

    /// The pixel in column `x` and row `y`.
    ///
    /// # Panics
    /// Outside of the image.
    pub fn pixel(&self, x: u32, y: u32) -> [f32; 3] {
        self.pixels[self.index(x, y)]
    }

    /// The pixel in column `x` and row `y`.
    ///
    /// # Panics
    /// Outside of the image.
    pub fn pixel_mut(&mut self, x: u32, y: u32) -> &mut [f32; 3] {
        let index = self.index(x, y);
        &mut self.pixels[index]
    }

    /// The mean of every channel over all pixels.
    pub fn mean(&self) -> [f64; 3] {
        let mut sum = [0.0; 3];
        for pixel in &self.pixels {
            for (sum, value) in sum.iter_mut().zip(pixel) {
                *sum += f64::from(*value);
            }
        }
        sum.map(|sum| sum / self.pixels.len() as f64)
    }

    fn index(&self, x: u32, y: u32) -> usize {
        assert!(
            x < self.size.width && y < self.size.height,
            "pixel ({x}, {y}) of {:?}",
            self.size
        );
        y as usize * self.size.width as usize + x as usize
    }
}
