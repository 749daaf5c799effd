//! Portable float maps: a header of text and 32-bit numbers, row by row from the bottom (Debevec's format, as Mitsuba writes it).

use std::io::Read;

use super::{Channels, Encoding, ImageFile, size};

/// Whether a file that starts like this is a portable float map.
pub(super) fn is_pfm(start: &[u8]) -> bool {
    matches!(start, [b'P', b'F' | b'f', space, ..] if space.is_ascii_whitespace())
}

/// Reads a portable float map.
pub(super) fn read(mut file: impl Read) -> Result<ImageFile, String> {
    let channels = match word(&mut file)?.as_str() {
        "PF" => Channels::Rgb,
        _ => Channels::Grey,
    };
    let side = |text: String| {
        let invalid = || format!("`{text}` in its header is no number of pixels");
        text.parse::<u64>().map_err(|_| invalid())
    };
    let size = size(side(word(&mut file)?)?, side(word(&mut file)?)?)?;
    let scale = word(&mut file)?;
    // Its sign is the order of the bytes.
    let order: f32 = scale
        .parse()
        .ok()
        .filter(|&scale: &f32| scale.is_finite() && scale != 0.0)
        .ok_or_else(|| format!("`{scale}` in its header is no scale"))?;
    let row_length = size.width as usize * channels.count();
    let expected = 4 * row_length * size.height as usize;
    let mut bytes = Vec::new();
    file.take(expected as u64)
        .read_to_end(&mut bytes)
        .map_err(|error| error.to_string())?;
    if bytes.len() < expected {
        return Err(format!(
            "the file is truncated: {} of {expected} bytes of pixels are there",
            bytes.len()
        ));
    }
    let number = |bytes: &[u8]| {
        let bytes = [bytes[0], bytes[1], bytes[2], bytes[3]];
        let value = if order < 0.0 {
            f32::from_le_bytes(bytes)
        } else {
            f32::from_be_bytes(bytes)
        };
        value * order.abs()
    };
    let rows = bytes.chunks_exact(4 * row_length).rev();
    Ok(ImageFile {
        size,
        channels,
        encoding: Encoding::Linear,
        values: rows
            .flat_map(|row| row.chunks_exact(4).map(number))
            .collect(),
    })
}

/// The next word of the header and the one white space behind it.
fn word(file: &mut impl Read) -> Result<String, String> {
    const LONGEST: usize = 64;
    let mut word = String::new();
    let mut byte = [0];
    while word.len() < LONGEST {
        file.read_exact(&mut byte)
            .map_err(|error| format!("its header cannot be read: {error}"))?;
        if byte[0].is_ascii_whitespace() {
            return Ok(word);
        }
        word.push(byte[0].into());
    }
    Err("its header is damaged".to_owned())
}
