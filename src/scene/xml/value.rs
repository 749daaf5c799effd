//! What an attribute's text means: numbers, triples, colours, spectra.

use std::fs;
use std::path::Path;

use glam::{DMat4, DVec3};

/// The value of one parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `<boolean>`
    Boolean(bool),
    /// `<integer>`
    Integer(i64),
    /// `<float>`, always finite.
    Float(f64),
    /// `<string>`
    String(String),
    /// `<point>` or `<vector>`: Mitsuba takes either for the other.
    Vector(DVec3),
    /// `<rgb>`: linear sRGB.
    Rgb([f64; 3]),
    /// `<spectrum>`
    Spectrum(SpectrumValue),
    /// `<transform>`: to the space of the outside from the space of the object.
    Transform(DMat4),
}

impl Value {
    /// The element that holds such a value, for messages.
    pub(super) fn tag(&self) -> &'static str {
        match self {
            Self::Boolean(_) => "boolean",
            Self::Integer(_) => "integer",
            Self::Float(_) => "float",
            Self::String(_) => "string",
            Self::Vector(_) => "point",
            Self::Rgb(_) => "rgb",
            Self::Spectrum(_) => "spectrum",
            Self::Transform(_) => "transform",
        }
    }
}

/// A function of the wavelength.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectrumValue {
    /// The same at every wavelength.
    Constant(f64),
    /// At least two pairs of wavelength (nm, strictly increasing) and value.
    List(Vec<[f64; 2]>),
}

/// The parts of a list separated by commas or white space.
pub(super) fn tokens(text: &str) -> Vec<&str> {
    text.split(|c: char| c == ',' || c.is_whitespace())
        .filter(|token| !token.is_empty())
        .collect()
}

pub(super) fn number(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => Err(format!("`{text}` is not a finite number")),
        Err(_) => Err(format!("`{text}` is not a number")),
    }
}

fn numbers(text: &str) -> Result<Vec<f64>, String> {
    tokens(text).into_iter().map(number).collect()
}

pub(super) fn integer(text: &str) -> Result<i64, String> {
    let digits = text.trim();
    // Mitsuba reads no plus sign, and a file is to mean the same there.
    digits
        .parse()
        .ok()
        .filter(|_| !digits.starts_with('+'))
        .ok_or_else(|| format!("`{text}` is not an integer of 64 bits"))
}

pub(super) fn boolean(text: &str) -> Result<bool, String> {
    match text.to_ascii_lowercase().as_str() {
        "true" => Ok(true),
        "false" => Ok(false),
        _ => Err(format!("`{text}` is neither `true` nor `false`")),
    }
}

/// Three numbers.
pub(super) fn triple(text: &str) -> Result<DVec3, String> {
    match numbers(text)?[..] {
        [x, y, z] => Ok(DVec3::new(x, y, z)),
        _ => Err(format!("`{text}` has to be three numbers")),
    }
}

/// Three numbers, or one that stands for all three.
pub(super) fn triple_or_one(text: &str) -> Result<DVec3, String> {
    match numbers(text)?[..] {
        [x, y, z] => Ok(DVec3::new(x, y, z)),
        [all] => Ok(DVec3::splat(all)),
        _ => Err(format!("`{text}` has to be one or three numbers")),
    }
}

/// Linear sRGB as one or three numbers.
pub(super) fn rgb(text: &str) -> Result<[f64; 3], String> {
    if text.trim_start().starts_with('#') {
        return Err(format!(
            "`{text}`: Mitsuba 3 reads no hexadecimal colours; give one or three linear sRGB numbers"
        ));
    }
    triple_or_one(text).map(|colour| colour.to_array())
}

/// A constant, or a list such as "400:0.3, 404:0.4".
pub(super) fn spectrum(text: &str) -> Result<SpectrumValue, String> {
    let parts = tokens(text);
    if let [constant] = parts[..]
        && !constant.contains(':')
    {
        return number(constant).map(SpectrumValue::Constant);
    }
    let pair = |part: &str| match part.split_once(':') {
        Some((wavelength, value)) => Ok([number(wavelength)?, number(value)?]),
        None => Err(format!("`{part}` has to be wavelength:value")),
    };
    let list: Result<Vec<_>, _> = parts.into_iter().map(pair).collect();
    checked_list(list?).map(SpectrumValue::List)
}

/// A spectrum from a file of two columns, wavelength (nm) and value; `#` starts a comment line.
pub(super) fn spectrum_file(path: &Path) -> Result<SpectrumValue, String> {
    let text = fs::read_to_string(path)
        .map_err(|error| format!("cannot read the spectrum {}: {error}", path.display()))?;
    let in_line = |line: usize, message: String| format!("{}:{line}: {message}", path.display());
    let mut list = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let columns: Result<Vec<f64>, String> = line.split_whitespace().map(number).collect();
        match columns.map_err(|message| in_line(index + 1, message))?[..] {
            [wavelength, value] => list.push([wavelength, value]),
            _ => {
                let message = "a line has to hold a wavelength and a value".to_owned();
                return Err(in_line(index + 1, message));
            }
        }
    }
    let list = checked_list(list).map_err(|message| format!("{}: {message}", path.display()))?;
    Ok(SpectrumValue::List(list))
}

fn checked_list(list: Vec<[f64; 2]>) -> Result<Vec<[f64; 2]>, String> {
    if list.len() < 2 {
        return Err("a spectrum needs at least two wavelengths".to_owned());
    }
    match list.windows(2).find(|pair| pair[0][0] >= pair[1][0]) {
        Some(pair) => Err(format!(
            "the wavelengths have to increase, but {} follows {}",
            pair[1][0], pair[0][0]
        )),
        None => Ok(list),
    }
}
