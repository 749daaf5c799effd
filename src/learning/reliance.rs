//! Which of what was learned is relied on.

use std::fmt::{self, Display};

use serde::{Deserialize, Serialize};

/// Which of what was learned a render goes by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Reliance {
    /// Whether the strategy is told, if it [asks](crate::walk::Strategy::learns); otherwise it decides as before it has learned anything.
    pub counts: bool,
    /// Whether directions are guided, if they are to be.
    pub guiding: bool,
}

impl Reliance {
    /// On everything.
    pub const ALL: Self = Self {
        counts: true,
        guiding: true,
    };
}

impl Display for Reliance {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match (self.counts, self.guiding) {
            (true, true) => "counts and guiding",
            (true, false) => "counts",
            (false, true) => "guiding",
            (false, false) => "nothing",
        })
    }
}
