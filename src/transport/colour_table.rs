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

    /// The number of a colour, which becomes one of the table if it is none yet. In a table with too many to be evaluated by every path,
    /// the same colour may have several numbers: scenes can have thousands of materials, and nobody compares each with all.
    pub fn number_of(&mut self, curve: &SpectralCurve) -> usize {
        let mut searched = self.curves.iter().take(self.most + 1);
        let known = searched.position(|known| known == curve);
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::{Rgb, Spectral, Wavelengths};

    #[test]
    fn few_colours_are_prepared_and_many_are_not() {
        let mut table = ColourTable::new(2);
        let curves =
            [0.25, 0.5, 0.75].map(|r| SpectralCurve::rgb_reflectance([r, 0.5, 0.1]).unwrap());
        assert_eq!(table.number_of(&curves[0]), 0);
        assert_eq!(table.number_of(&curves[1]), 1);
        assert_eq!(table.number_of(&curves[0]), 0);
        let wavelengths: Vec<_> = [0.1, 0.6, 0.9].map(Wavelengths::<4>::sample).into();
        let mut values = Vec::new();
        table.prepare::<Spectral<4>>(&wavelengths, &mut values);
        for (path, wavelengths) in wavelengths.iter().enumerate() {
            for (number, curve) in curves[..2].iter().enumerate() {
                let value = table.prepared(&values, path, number);
                assert_eq!(value, curve.evaluate(wavelengths));
            }
        }
        // In three channels they are the same on every path.
        assert!(!table.is_prepared::<Rgb>());

        assert_eq!(table.number_of(&curves[2]), 2);
        assert_eq!(table.number_of(&curves[1]), 1);
        let other = SpectralCurve::constant_reflectance(0.5).unwrap();
        let numbers = [0, 1].map(|_| table.number_of(&other));
        assert!(numbers.iter().all(|&number| table.curve(number) == &other));
        assert!(!table.is_prepared::<Spectral<4>>());
        table.prepare::<Spectral<4>>(&wavelengths, &mut values);
        assert!(values.is_empty());
    }
}
