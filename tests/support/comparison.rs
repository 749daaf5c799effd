//! Whether two renderers agree on an image, block by block and as a whole.

use std::fmt::{self, Display};

use super::estimate::{Estimate, sidak_threshold};
use super::replicates::{CHANNELS, Replicates};

/// The probability that pixels of images of the same thing fail as a family, as in Mitsuba's own render tests.
const SIGNIFICANCE: f64 = 0.01;
/// The same for blocks. Dozens of images are compared, and the means of a few hundred skewed samples are not quite
/// normal: at 0.01 some image would fail by chance. A real error is many standard errors.
const BLOCK_SIGNIFICANCE: f64 = 1e-4;
/// The share of single pixels that must pass, as in Mitsuba's own render tests.
const PIXELS_THAT_PASS: f64 = 0.9975;
/// The means of the whole image may be so many standard errors apart.
const LARGEST_MEAN_Z: f64 = 4.0;

/// What a comparison found.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// What was compared.
    pub what: String,
    /// Side of a block in pixels.
    pub block_side: usize,
    /// Numbers that were compared: blocks times channels.
    pub blocks: usize,
    /// The largest |z| of a block.
    pub worst_block: f64,
    /// The mean of z^2 over all blocks: 1 if the images differ by noise alone.
    pub mean_square: f64,
    /// The share of single pixels and channels within Šidák's threshold.
    pub pixels_that_pass: f64,
    judges_pixels: bool,
    /// Mean of each channel, and at the end of the luminance: ours and the reference's.
    pub means: [(Estimate, Estimate); CHANNELS + 1],
}

impl Comparison {
    /// Compares images with those of a reference, in blocks of `block_side` x `block_side` pixels: enough samples
    /// that their means are normal, few enough pixels that a local error shows.
    pub fn new(
        what: impl Into<String>,
        ours: &Replicates,
        reference: &Replicates,
        block_side: usize,
    ) -> Self {
        assert_eq!(ours.size, reference.size, "the images differ in size");
        let blocks = differences(ours, reference, block_side);
        let pixels = differences(ours, reference, 1);
        let threshold = sidak_threshold(SIGNIFICANCE, pixels.len());
        let passing = pixels.iter().filter(|z| z.abs() <= threshold).count();
        let (mine, theirs) = (ours.means(), reference.means());
        Self {
            what: what.into(),
            block_side,
            blocks: blocks.len(),
            worst_block: blocks.iter().fold(0.0, |worst: f64, z| worst.max(z.abs())),
            mean_square: blocks.iter().map(|z| z * z).sum::<f64>() / blocks.len() as f64,
            pixels_that_pass: passing as f64 / pixels.len() as f64,
            judges_pixels: true,
            means: std::array::from_fn(|channel| (mine[channel], theirs[channel])),
        }
    }

    /// The same comparison by blocks and means alone: for images whose pixels are a few bright samples each, so that
    /// single ones are far from normal.
    pub fn without_single_pixels(self) -> Self {
        Self {
            judges_pixels: false,
            ..self
        }
    }

    /// Everything that is wrong, one line each.
    pub fn complaints(&self) -> Vec<String> {
        let mut list = Vec::new();
        let threshold = sidak_threshold(BLOCK_SIGNIFICANCE, self.blocks);
        if self.worst_block > threshold {
            let worst = self.worst_block;
            list.push(format!(
                "a block is off by {worst:.2} standard errors; {threshold:.2} are allowed"
            ));
        }
        // The variance of z^2 is 2. Channels of one block are taken for one number: they share their noise.
        let allowed = 1.0 + 5.0 * (2.0 * CHANNELS as f64 / self.blocks as f64).sqrt();
        if self.mean_square > allowed {
            let found = self.mean_square;
            list.push(format!(
                "the mean of z^2 over all blocks is {found:.3}; {allowed:.3} is allowed"
            ));
        }
        if self.judges_pixels && self.pixels_that_pass < PIXELS_THAT_PASS {
            let share = 100.0 * self.pixels_that_pass;
            list.push(format!("only {share:.3} % of the pixels pass"));
        }
        for (name, (ours, reference)) in CHANNEL_NAMES.iter().zip(&self.means) {
            let z = ours.z_of_difference(reference);
            if z.abs() > LARGEST_MEAN_Z {
                list.push(format!(
                    "the mean of {name} is {}, and the reference's is {}: {z:.2} standard errors",
                    ours.mean, reference.mean
                ));
            }
        }
        list
    }

    /// Fails unless the images agree.
    pub fn assert(&self) {
        println!("{self}");
        let complaints = self.complaints();
        assert!(complaints.is_empty(), "{self}\n{}", complaints.join("\n"));
    }
}

/// What the means are means of.
pub const CHANNEL_NAMES: [&str; CHANNELS + 1] = ["R", "G", "B", "luminance"];

/// z of every block and channel, where anything arrives at all in one of the images.
fn differences(ours: &Replicates, reference: &Replicates, side: usize) -> Vec<f64> {
    let (ours, reference) = (ours.blocks(side), reference.blocks(side));
    let pairs = ours.iter().flatten().zip(reference.iter().flatten());
    pairs.map(|(a, b)| a.z_of_difference(b)).collect()
}

/// Asserts that two means are equal within `share`, and that they are known so well that this says something: the
/// `share` is at least three standard errors.
pub fn assert_equal_within(what: &str, share: f64, ours: &Estimate, reference: &Estimate) {
    let error = ours.error_of_difference(reference) / reference.mean;
    let deviation = ours.mean / reference.mean - 1.0;
    assert!(
        3.0 * error <= share,
        "{what}: the standard error of {:.3} % is too large to speak of {:.3} %",
        100.0 * error,
        100.0 * share
    );
    assert!(
        deviation.abs() <= share,
        "{what}: {} is {:+.3} % off the reference {}",
        ours.mean,
        100.0 * deviation,
        reference.mean
    );
}

impl Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(
            f,
            "{}: {} numbers of {2}x{2} pixels",
            self.what, self.blocks, self.block_side
        )?;
        write!(
            f,
            ", worst z {:.2}, mean z^2 {:.3}, {:.3} % of single pixels pass; means",
            self.worst_block,
            self.mean_square,
            100.0 * self.pixels_that_pass
        )?;
        for (name, (ours, reference)) in CHANNEL_NAMES.iter().zip(&self.means) {
            let (ratio, error) = (
                ours.mean / reference.mean - 1.0,
                ours.error_of_difference(reference) / reference.mean,
            );
            write!(
                f,
                " {name} {:+.3} % (+-{:.3} %)",
                100.0 * ratio,
                100.0 * error
            )?;
        }
        Ok(())
    }
}
