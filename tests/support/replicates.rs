//! Independent renders of one scene, which differ in their seed alone: their spread is the noise.

use cohort::scene::ImageSize;

use super::estimate::Estimate;

/// Channels of a pixel: R, G and B.
pub const CHANNELS: usize = 3;

/// The luminance of linear sRGB.
const LUMINANCE: [f64; CHANNELS] = [0.212_671, 0.715_160, 0.072_169];

/// Images of equal size and equal numbers of samples, with independent noise.
///
/// Everything that a test needs to know of the noise is taken from how they differ. That holds whatever samples and
/// pixels of one image have to do with each other: those of a population are not independent, and filters that are
/// wider than a pixel share samples between pixels.
#[derive(Clone, Debug)]
pub struct Replicates {
    /// Size of each image.
    pub size: ImageSize,
    images: Vec<Vec<[f32; CHANNELS]>>,
}

impl Replicates {
    /// No images yet.
    pub fn new(size: ImageSize) -> Self {
        Self {
            size,
            images: Vec::new(),
        }
    }

    /// Adds an image, row by row from the top.
    pub fn push(&mut self, pixels: Vec<[f32; CHANNELS]>) {
        assert_eq!(
            pixels.len(),
            self.size.pixels(),
            "the image has another size"
        );
        self.images.push(pixels);
    }

    /// The images, each row by row from the top.
    pub fn images(&self) -> impl Iterator<Item = &[[f32; CHANNELS]]> {
        self.images.iter().map(Vec::as_slice)
    }

    /// The number of images.
    pub fn count(&self) -> usize {
        self.images.len()
    }

    /// Estimates of the mean of every block of `side` x `side` pixels (less at the right and lower border), one list
    /// per channel.
    pub fn blocks(&self, side: usize) -> [Vec<Estimate>; CHANNELS] {
        let (width, height) = (self.size.width as usize, self.size.height as usize);
        let mut lists = [const { Vec::new() }; CHANNELS];
        for y in (0..height).step_by(side) {
            for x in (0..width).step_by(side) {
                let (end_x, end_y) = ((x + side).min(width), (y + side).min(height));
                let pixels = ((end_x - x) * (end_y - y)) as f64;
                for (channel, list) in lists.iter_mut().enumerate() {
                    let mean = |image: &Vec<[f32; CHANNELS]>| {
                        let rows =
                            (y..end_y).flat_map(|y| &image[y * width + x..y * width + end_x]);
                        rows.map(|pixel| f64::from(pixel[channel])).sum::<f64>() / pixels
                    };
                    let means: Vec<f64> = self.images.iter().map(mean).collect();
                    list.push(Estimate::of(means.iter().copied()));
                }
            }
        }
        lists
    }

    /// The mean over all pixels of the image of each channel and, at the end, of the luminance.
    pub fn means(&self) -> [Estimate; CHANNELS + 1] {
        self.means_over(&vec![true; self.size.pixels()])
    }

    /// The same over those pixels for which `mask` is true.
    pub fn means_over(&self, mask: &[bool]) -> [Estimate; CHANNELS + 1] {
        let pixels = mask.iter().filter(|&&counts| counts).count() as f64;
        let means: Vec<[f64; CHANNELS + 1]> = self
            .images
            .iter()
            .map(|image| {
                let mut means = [0.0; CHANNELS + 1];
                for (pixel, _) in image.iter().zip(mask).filter(|&(_, &counts)| counts) {
                    for channel in 0..CHANNELS {
                        let value = f64::from(pixel[channel]) / pixels;
                        means[channel] += value;
                        means[CHANNELS] += LUMINANCE[channel] * value;
                    }
                }
                means
            })
            .collect();
        std::array::from_fn(|channel| Estimate::of(means.iter().map(|mean| mean[channel])))
    }

    /// Which pixels are at least one pixel away from all whose luminance, in the mean of all images, is above `limit`.
    pub fn far_from_brighter_than(&self, limit: f64) -> Vec<bool> {
        let (width, height) = (self.size.width as usize, self.size.height as usize);
        let bright: Vec<bool> = (0..width * height)
            .map(|index| {
                let luminance = |image: &Vec<[f32; CHANNELS]>| -> f64 {
                    (0..CHANNELS)
                        .map(|c| LUMINANCE[c] * f64::from(image[index][c]))
                        .sum()
                };
                self.images.iter().map(luminance).sum::<f64>() > limit * self.count() as f64
            })
            .collect();
        let near = |index: usize| {
            let (x, y) = (index % width, index / width);
            let columns = x.saturating_sub(1)..(x + 2).min(width);
            (y.saturating_sub(1)..(y + 2).min(height))
                .any(|y| columns.clone().any(|x| bright[y * width + x]))
        };
        (0..width * height).map(|index| !near(index)).collect()
    }
}
