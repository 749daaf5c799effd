//! # `fixed-depth`
//!
//! No decision: every particle has exactly one child,
//!
//! ```text
//! nu = 1
//! ```
//!
//! and paths end only where the render's greatest depth cuts them off, or where nothing can reach the pixel any more.
//!
//! **Settings:** none.
//!
//! **When it wins:** as the yardstick against which the others are measured. It has no noise of its own, but
//! spends as much time on paths that carry almost nothing as on those that carry everything; and without a greatest
//! depth it never ends in a closed room.

use super::{Population, Strategy};

/// Gives every particle one child; see the [module](self).
#[derive(Clone, Copy, Debug)]
pub struct FixedDepth;

impl FixedDepth {
    /// The strategy's name.
    pub const NAME: &str = "fixed-depth";
}

impl Strategy for FixedDepth {
    fn name(&self) -> &'static str {
        Self::NAME
    }

    fn settings(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    fn expected_counts(&self, _: &Population, nu: &mut [f32]) {
        nu.fill(1.0);
    }
}
