//! What a strategy that learns is to make small.

use std::fmt::{self, Display};
use std::str::FromStr;

use serde::Serialize;

use super::SettingError;

/// Which error of the image is to become small.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Objective {
    /// Relative to the brightness of each pixel.
    #[default]
    Relative,
    /// As it is: bright pixels count most.
    Mse,
}

impl Objective {
    /// Every objective.
    pub const ALL: [Self; 2] = [Self::Relative, Self::Mse];

    fn name(self) -> &'static str {
        match self {
            Self::Relative => "relative",
            Self::Mse => "mse",
        }
    }
}

impl Display for Objective {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Objective {
    type Err = SettingError;

    fn from_str(text: &str) -> Result<Self, SettingError> {
        SettingError::choose("objective", text, &Self::ALL)
    }
}
