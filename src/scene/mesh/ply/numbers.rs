//! The numbers behind a PLY header, one after the other.

use super::header::Scalar;

/// Why there is no further number.
#[derive(Debug)]
pub(super) enum NumberError {
    /// The file ends.
    End,
    /// What stands there is not a number of the type that it should be.
    Malformed(String),
}

/// A file's numbers in order. `f64` holds every value of every PLY type exactly.
pub(super) trait Numbers {
    /// The next number.
    fn next(&mut self, scalar: Scalar) -> Result<f64, NumberError>;

    /// How many bytes are left; nothing is ever allocated for more elements than these can hold.
    fn bytes_left(&self) -> usize;

    /// Whether only white space is left where that means nothing, or nothing at all.
    fn is_at_end(&self) -> bool;
}

/// Numbers as text.
pub(super) struct Ascii<'a> {
    pub(super) rest: &'a [u8],
}

impl Numbers for Ascii<'_> {
    fn next(&mut self, scalar: Scalar) -> Result<f64, NumberError> {
        let text = self.rest.trim_ascii_start();
        let end = text
            .iter()
            .position(u8::is_ascii_whitespace)
            .unwrap_or(text.len());
        let (token, rest) = text.split_at(end);
        if token.is_empty() {
            return Err(NumberError::End);
        }
        self.rest = rest;
        let token = String::from_utf8_lossy(token);
        let malformed =
            |kind: &str| NumberError::Malformed(format!("`{token}` is not {kind} number"));
        if matches!(scalar, Scalar::F32 | Scalar::F64) {
            return token.parse().map_err(|_| malformed("a"));
        }
        let range = match scalar {
            Scalar::I8 => -0x80..=0x7f,
            Scalar::U8 => 0..=0xff,
            Scalar::I16 => -0x8000..=0x7fff,
            Scalar::U16 => 0..=0xffff,
            Scalar::U32 => 0..=0xffff_ffff,
            _ => i64::from(i32::MIN)..=i64::from(i32::MAX),
        };
        match token.parse::<i64>() {
            Ok(integer) if range.contains(&integer) => Ok(integer as f64),
            Ok(_) => Err(malformed("within the type of the")),
            Err(_) => Err(malformed("a whole")),
        }
    }

    fn bytes_left(&self) -> usize {
        self.rest.len()
    }

    fn is_at_end(&self) -> bool {
        self.rest.trim_ascii_start().is_empty()
    }
}

/// Numbers as they are in memory, the most significant byte first if `BIG_ENDIAN`.
pub(super) struct Binary<'a, const BIG_ENDIAN: bool> {
    pub(super) rest: &'a [u8],
}

impl<const BIG_ENDIAN: bool> Binary<'_, BIG_ENDIAN> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], NumberError> {
        let (bytes, rest) = self.rest.split_first_chunk().ok_or(NumberError::End)?;
        self.rest = rest;
        let mut bytes: [u8; N] = *bytes;
        if BIG_ENDIAN {
            bytes.reverse();
        }
        Ok(bytes)
    }
}

impl<const BIG_ENDIAN: bool> Numbers for Binary<'_, BIG_ENDIAN> {
    fn next(&mut self, scalar: Scalar) -> Result<f64, NumberError> {
        Ok(match scalar {
            Scalar::I8 => i8::from_le_bytes(self.take()?).into(),
            Scalar::U8 => u8::from_le_bytes(self.take()?).into(),
            Scalar::I16 => i16::from_le_bytes(self.take()?).into(),
            Scalar::U16 => u16::from_le_bytes(self.take()?).into(),
            Scalar::I32 => i32::from_le_bytes(self.take()?).into(),
            Scalar::U32 => u32::from_le_bytes(self.take()?).into(),
            Scalar::F32 => f32::from_le_bytes(self.take()?).into(),
            Scalar::F64 => f64::from_le_bytes(self.take()?),
        })
    }

    fn bytes_left(&self) -> usize {
        self.rest.len()
    }

    fn is_at_end(&self) -> bool {
        self.rest.is_empty()
    }
}
