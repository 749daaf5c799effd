//! Whether an image fits into memory.

use super::RenderError;
use crate::film::PixelStatistics;
use crate::scene::ImageSize;

/// Bytes that a pixel takes: its sums, the image made of them, and that image's channels as they are encoded.
const BYTES_PER_PIXEL: usize = size_of::<PixelStatistics>() + 3 * size_of::<[f32; 3]>();

/// The same for the second moments: their sums, the image made of them, and the channels of both moments as they are encoded.
const BYTES_FOR_MOMENTS: usize = size_of::<[f64; 3]>() + 3 * size_of::<[f32; 3]>();

/// An error where the film alone would need more memory than the system can give, so that this is said at once instead
/// of the process being killed later.
pub(super) fn check(size: ImageSize, second_moments: bool) -> Result<(), RenderError> {
    let gibibytes = |bytes: f64| bytes / f64::from(1 << 30);
    let bytes = BYTES_PER_PIXEL + if second_moments { BYTES_FOR_MOMENTS } else { 0 };
    let needed = size.pixels() as f64 * bytes as f64;
    match available_bytes() {
        Some(available) if needed > available => Err(RenderError::OutOfMemory {
            width: size.width,
            height: size.height,
            needed: gibibytes(needed),
            available: gibibytes(available),
        }),
        _ => Ok(()),
    }
}

/// What the system could give to new programs, in bytes, where it tells.
fn available_bytes() -> Option<f64> {
    let info = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = info
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kibibytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_absurd_images_are_refused() {
        let size = |side| ImageSize {
            width: side,
            height: side,
        };
        assert!(check(size(800), true).is_ok());
        let message = check(size(u32::MAX), false).unwrap_err().to_string();
        assert!(message.contains("make it smaller"), "{message}");
    }
}
