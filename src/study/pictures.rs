//! The images of a study: means, noise, errors, and the parts worth enlarging.

use std::path::Path;

use super::StudyError;
use super::false_colour::write_false_colour;
use super::kept::{StudyFolder, file_name};
use super::measures::{relative_error_map, variance_between};
use super::reference::Reference;
use super::results::{Crop, Images, VarianceIntervals};
use crate::film::{ExrOptions, Image, read_exr, write_exr, write_png};

/// The share of pixels whose error is above the top of the false colours: fireflies must not darken the rest.
const ABOVE_THE_SCALE: f64 = 0.01;

/// Side of an enlarged part, as a share of the image's shorter side.
const CROP_SHARE: u32 = 8;

/// What is left of all repetitions of one competitor.
#[derive(Clone, Debug)]
pub struct Gathered {
    /// The mean of the repetitions.
    pub mean: Image,
    /// The first repetition.
    pub first: Image,
    /// The variance between the repetitions; `None` for a single one.
    pub variance: Option<VarianceIntervals>,
}

/// Reads the images of all repetitions of `competitor`. `lit` says of every pixel whether it sees a light directly.
///
/// # Errors
/// One is missing or damaged.
pub fn gather(
    folder: &StudyFolder,
    competitor: &str,
    repetitions: usize,
    lit: &[bool],
) -> Result<Gathered, StudyError> {
    let images: Result<Vec<Image>, _> = (0..repetitions)
        .map(|repetition| read_exr(&folder.repetition(competitor, repetition)))
        .collect();
    let mut images = images?;
    let variance = variance_between(&images, lit);
    let mean = mean_of(&images);
    Ok(Gathered {
        mean,
        first: images.swap_remove(0),
        variance,
    })
}

/// The mean of images of one size, of which there is at least one.
fn mean_of(images: &[Image]) -> Image {
    let size = images[0].size();
    let mut mean = Image::black(size);
    for index in 0..size.pixels() {
        let sum = |channel: usize| {
            let values = images
                .iter()
                .map(|image| f64::from(image.pixels()[index][channel]));
            values.sum::<f64>()
        };
        *mean.pixel_mut(index as u32 % size.width, index as u32 / size.width) =
            std::array::from_fn(|channel| (sum(channel) / images.len() as f64) as f32);
    }
    mean
}

/// Writes the images of a competitor, and says where they are, relative to the folder.
///
/// # Errors
/// The disk refuses.
pub fn write_images(
    folder: &StudyFolder,
    competitor: &str,
    gathered: &Gathered,
    reference: &Reference,
    scale: f64,
) -> Result<Images, StudyError> {
    let name = file_name(competitor);
    let images = Images {
        exr: format!("images/{name}.exr"),
        png: format!("images/{name}.png"),
        one_png: format!("images/{name}-1.png"),
        error_png: format!("images/{name}-error.png"),
        error_scale: scale,
    };
    let at = |file: &str| folder.path().join(Path::new(file));
    write_exr(&at(&images.exr), &gathered.mean, &ExrOptions::default())?;
    write_png(&at(&images.png), &gathered.mean)?;
    write_png(&at(&images.one_png), &gathered.first)?;
    let errors = relative_error_map(&gathered.first, reference);
    write_false_colour(
        &at(&images.error_png),
        gathered.first.size(),
        &errors,
        scale,
    )?;
    Ok(images)
}

/// The relative squared error at the top of the false colours, one for all competitors: above it are 1 % of the pixels
/// of that competitor which has the most error.
pub fn error_scale(gathered: &[Gathered], reference: &Reference) -> f64 {
    let top = gathered.iter().map(|competitor| {
        let mut errors = relative_error_map(&competitor.first, reference);
        let place = ((errors.len() - 1) as f64 * (1.0 - ABOVE_THE_SCALE)) as usize;
        f64::from(*errors.select_nth_unstable_by(place, f32::total_cmp).1)
    });
    top.fold(f64::MIN_POSITIVE, f64::max)
}

/// Two parts of the image in which the competitors' errors differ most.
pub fn telling_crops(gathered: &[Gathered], reference: &Reference) -> Vec<Crop> {
    let size = reference.image().size();
    let side = (size.width.min(size.height) / CROP_SHARE).max(1);
    let maps: Vec<Vec<f32>> = gathered
        .iter()
        .map(|competitor| relative_error_map(&competitor.first, reference))
        .collect();
    let error_in = |map: &[f32], crop: &Crop| {
        let rows = crop.y..crop.y + crop.height;
        let row = |y: u32| (y * size.width + crop.x) as usize;
        rows.flat_map(|y| &map[row(y)..row(y) + crop.width as usize])
            .map(|&error| f64::from(error))
            .sum::<f64>()
    };
    let contrast = |crop: &Crop| {
        let errors = maps.iter().map(|map| error_in(map, crop));
        let (low, high) = errors.fold((f64::INFINITY, 0.0_f64), |(low, high), error| {
            (low.min(error), high.max(error))
        });
        high - low
    };
    let starts = |length: u32| (0..=length - side).step_by((side as usize / 2).max(1));
    let mut crops: Vec<(f64, Crop)> = starts(size.height)
        .flat_map(|y| starts(size.width).map(move |x| (x, y)))
        .map(|(x, y)| Crop {
            x,
            y,
            width: side,
            height: side,
        })
        .map(|crop| (contrast(&crop), crop))
        .collect();
    crops.sort_by(|a, b| b.0.total_cmp(&a.0));
    let Some(&(_, best)) = crops.first() else {
        return Vec::new();
    };
    // The second is another place, not the first one moved a little.
    let far = |crop: &Crop| crop.x.abs_diff(best.x).max(crop.y.abs_diff(best.y)) >= 2 * side;
    let second = crops.iter().map(|&(_, crop)| crop).find(far);
    std::iter::once(best).chain(second).collect()
}
