//! The film: which sample falls where, the sums per pixel, and the files that show them.

mod checked_file;
mod exr_file;
mod filter;
mod image;
mod neighbourhood;
mod pixels;
mod png_file;
mod second_moments;
mod statistics;
mod sums;
mod tiles;
mod whole_file;

pub use checked_file::{CheckedFileError, read_checked, write_checked};
pub use exr_file::{ExrMoments, ExrOptions, read_exr, read_exr_variance, write_exr};
pub use filter::{FilterSample, FilterSampler, PixelFilter};
pub use image::{FilmFileError, Image};
pub use neighbourhood::neighbourhood_sums;
pub use pixels::TilePixels;
pub use png_file::{srgb_bytes, write_png, write_rgb8};
pub use second_moments::SecondMoments;
pub use statistics::PixelStatistics;
pub use sums::{Accumulator, CompensatedSum, FilmSums};
pub use tiles::{Film, FilmTile, TILE_SIDE};
pub use whole_file::WholeFile;
