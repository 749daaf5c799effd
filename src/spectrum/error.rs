//! What can be wrong with a colour that a scene gives.

use std::fmt;

/// Why a colour of the scene cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CurveError {
    /// A tabulated curve with fewer than two entries.
    #[error(
        "a tabulated spectrum needs at least two entries (wavelength in nm and value), found {count}"
    )]
    TooFewEntries {
        /// Number of entries given.
        count: usize,
    },
    /// A wavelength that is not a positive finite number.
    #[error(
        "entry {entry} of the spectrum has the wavelength {nm}: a positive number of nm is needed"
    )]
    InvalidWavelength {
        /// Index of the entry, from 1.
        entry: usize,
        /// The wavelength given.
        nm: f32,
    },
    /// A wavelength that is not greater than the one before it.
    #[error(
        "the wavelengths of a spectrum must increase, but entry {entry} has {nm} nm after {previous_nm} nm"
    )]
    NotIncreasing {
        /// Index of the entry, from 1.
        entry: usize,
        /// The wavelength of the entry before, in nm.
        previous_nm: f32,
        /// The wavelength given, in nm.
        nm: f32,
    },
    /// A reflectance outside [0, 1].
    #[error("reflectance {value}{place} is not in the range from 0 to 1")]
    InvalidReflectance {
        /// The value given.
        value: f32,
        /// Where in the colour it stands.
        place: Place,
    },
    /// An index of refraction or absorption that is negative or not a number of reasonable size.
    #[error("index {value}{place} is not a number from 0 to 1e6")]
    InvalidIndex {
        /// The value given.
        value: f32,
        /// Where in the colour it stands.
        place: Place,
    },
    /// An emission that is negative or not a number of reasonable size.
    #[error("emission {value}{place} is not a number from 0 to 1e30")]
    InvalidEmission {
        /// The value given.
        value: f32,
        /// Where in the colour it stands.
        place: Place,
    },
}

/// Where in a colour a value stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// At all wavelengths alike.
    Everywhere,
    /// At one wavelength, in nm.
    Wavelength(f32),
    /// In one of the channels 0 (red), 1 (green) and 2 (blue).
    Channel(usize),
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Everywhere => Ok(()),
            Self::Wavelength(nm) => write!(f, " at {nm} nm"),
            Self::Channel(0) => write!(f, " of the red channel"),
            Self::Channel(1) => write!(f, " of the green channel"),
            Self::Channel(_) => write!(f, " of the blue channel"),
        }
    }
}
