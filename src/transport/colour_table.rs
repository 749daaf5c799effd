//! Colours of a scene that every path evaluates once, as it starts, and not at every vertex that asks for them.

use crate::room::make_room;
use crate::spectrum::{Colour, SpectralCurve};

/// Different colours, by number.
pub(super) struct ColourTable {
    curves: Vec<SpectralCurve>,
    /// With more colours than this, a path would evaluate more of them than it asks for.
    most: usize,
}

impl ColourTable {
    /// A table without colours; as long as it has no more than `most`, every path evaluates them all.
    pub fn new(most: usize) -> Self {
        Self {
            curves: Vec::new(),
            most,
        }
    }

    /// The number of a colour, which becomes one of the table if it is none yet.
    pub fn number_of(&mut self, curve: &SpectralCurve) -> usize {
        let known = self.curves.iter().position(|known| known == curve);
        known.unwrap_or_else(|| {
            self.curves.push(curve.clone());
            self.curves.len() - 1
        })
    }

    /// A colour by its number.
    #[inline(always)]
    pub fn curve(&self, number: usize) -> &SpectralCurve {
        &self.curves[number]
    }

    /// Whether every path evaluates all of them: where there are few, and they are not the same on every path anyway.
    #[inline(always)]
    pub fn is_prepared<C: Colour>(&self) -> bool {
        C::RANDOM_NUMBERS > 0 && self.curves.len() <= self.most
    }

    /// Evaluates the colours at the `wavelengths` of every path, where they are to be: `values` become those of one path side by side.
    #[inline(always)]
    pub fn prepare<C: Colour>(
        &self,
        wavelengths: &[C::Wavelengths],
        values: &mut Vec<C::Spectrum>,
    ) {
        let curves = if self.is_prepared::<C>() {
            self.curves.as_slice()
        } else {
            &[]
        };
        make_room(values, wavelengths.len() * curves.len());
        C::evaluate_all(curves, wavelengths, values);
    }

    /// Of the `values` that were [prepared](Self::prepare), that of colour number `number` on `path`.
    #[inline(always)]
    pub fn prepared<S: Copy>(&self, values: &[S], path: usize, number: usize) -> S {
        values[path * self.curves.len() + number]
    }
}
