//! Errors as colours.

use std::path::Path;

use crate::film::{FilmFileError, write_rgb8};
use crate::scene::ImageSize;

/// The colour for a value in [0, 1] (clamped), sRGB: black, violet, orange, light yellow. Equal steps look equal, in grey
/// as well (the colour map "inferno").
pub fn colour(value: f64) -> [u8; 3] {
    colorous::INFERNO
        .eval_continuous(value.clamp(0.0, 1.0))
        .as_array()
}

/// Writes relative squared errors, row by row from the top, as a PNG: the colour is that of the error itself (the square
/// root), linear from 0 to that of `scale`.
///
/// # Errors
/// The file cannot be written.
pub fn write_false_colour(
    path: &Path,
    size: ImageSize,
    errors: &[f32],
    scale: f64,
) -> Result<(), FilmFileError> {
    let bytes: Vec<u8> = errors
        .iter()
        .flat_map(|&error| colour((f64::from(error) / scale).sqrt()))
        .collect();
    write_rgb8(path, size, &bytes)
}
