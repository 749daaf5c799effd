//! How a peer is named: `mitsuba`, or `mitsuba:VARIANT`.

use std::fmt::{self, Display};
use std::str::FromStr;

use thiserror::Error;

use crate::render::ColourMode;

/// The name of one of Mitsuba's variants, such as `scalar_rgb` or `llvm_ad_spectral`. Which of them there are, the Python
/// package knows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MitsubaVariant(String);

/// A peer as it is named on the command line: `mitsuba`, or `mitsuba:VARIANT`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PeerName {
    /// The variant, if one is named.
    pub variant: Option<MitsubaVariant>,
}

/// Why a text names no peer.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum PeerNameError {
    /// Another renderer.
    #[error(
        "unknown peer `{0}`: peers are `mitsuba` and `mitsuba:VARIANT`, such as `mitsuba:scalar_rgb`"
    )]
    Renderer(String),
    /// Characters that no variant has.
    #[error(
        "`{0}` is no variant of Mitsuba: their names have small letters, digits and `_`, such as `llvm_ad_rgb`"
    )]
    Variant(String),
}

impl MitsubaVariant {
    /// The plainest variant that carries colours like this: `scalar_rgb` or `scalar_spectral`.
    pub fn scalar(colour: ColourMode) -> Self {
        Self(match colour {
            ColourMode::Rgb => "scalar_rgb".into(),
            ColourMode::Spectral(_) => "scalar_spectral".into(),
        })
    }

    /// The name that Mitsuba knows it by.
    pub fn name(&self) -> &str {
        &self.0
    }
}

impl PeerName {
    /// The variant that is named, or the scalar one for this colour.
    pub fn variant_for(&self, colour: ColourMode) -> MitsubaVariant {
        let named = self.variant.clone();
        named.unwrap_or_else(|| MitsubaVariant::scalar(colour))
    }
}

impl FromStr for PeerName {
    type Err = PeerNameError;

    fn from_str(text: &str) -> Result<Self, PeerNameError> {
        let (renderer, variant) = match text.split_once(':') {
            Some((renderer, variant)) => (renderer, Some(variant)),
            None => (text, None),
        };
        if renderer != "mitsuba" {
            return Err(PeerNameError::Renderer(text.to_owned()));
        }
        let variant = variant.map(str::parse).transpose()?;
        Ok(Self { variant })
    }
}

impl FromStr for MitsubaVariant {
    type Err = PeerNameError;

    fn from_str(text: &str) -> Result<Self, PeerNameError> {
        let fits = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
        if text.is_empty() || !text.chars().all(fits) {
            return Err(PeerNameError::Variant(text.to_owned()));
        }
        Ok(Self(text.to_owned()))
    }
}

/// The name in reports: `mitsuba:scalar_rgb`.
impl Display for MitsubaVariant {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "mitsuba:{}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_variant_may_be_left_to_the_colour() {
        let name: PeerName = "mitsuba".parse().unwrap();
        let variant = |colour| name.variant_for(colour).to_string();
        assert_eq!(variant(ColourMode::Rgb), "mitsuba:scalar_rgb");
        assert_eq!(variant(ColourMode::default()), "mitsuba:scalar_spectral");
        let name: PeerName = "mitsuba:llvm_ad_rgb".parse().unwrap();
        assert_eq!(
            name.variant_for(ColourMode::default()).name(),
            "llvm_ad_rgb"
        );
    }

    #[test]
    fn other_names_are_refused() {
        for text in ["pbrt", "", "Mitsuba", "pbrt:scalar_rgb"] {
            let error = text.parse::<PeerName>().unwrap_err();
            assert_eq!(error, PeerNameError::Renderer(text.into()));
        }
        for text in ["", "Scalar", "a b", "scalar-rgb"] {
            let error = format!("mitsuba:{text}").parse::<PeerName>().unwrap_err();
            assert_eq!(error, PeerNameError::Variant(text.into()));
        }
    }
}
