//! What lamps emit, evaluated once per path and not at every vertex that looks at them.

use super::batch::CameraPaths;
use super::colour_table::ColourTable;
use crate::scene::Emitter;
use crate::spectrum::Colour;

/// Vertices look at one lamp each: with more colours than this, a path would evaluate more of them than it looks at.
const MOST_COLOURS: usize = 2;

/// The spectra of area lights.
pub(super) struct EmissionTable {
    colours: ColourTable,
    /// By emitter: the number of its colour; without meaning where it has none, or one that varies.
    colour_of: Vec<usize>,
}

impl EmissionTable {
    /// The table of a scene's emitters.
    pub fn new(emitters: &[Emitter]) -> Self {
        let mut colours = ColourTable::new(MOST_COLOURS);
        let colour_of = emitters.iter().map(|emitter| match emitter {
            Emitter::Area(light) => light
                .uniform_radiance()
                .map_or(usize::MAX, |radiance| colours.number_of(radiance)),
            _ => usize::MAX,
        });
        Self {
            colour_of: colour_of.collect(),
            colours,
        }
    }

    /// Evaluates the spectra at the wavelengths of every path, where there are few.
    #[inline(always)]
    pub fn prepare<C: Colour>(&self, paths: &mut CameraPaths<C>) {
        self.colours
            .prepare::<C>(&paths.wavelengths, &mut paths.emission);
    }

    /// The radiance of emitter number `emitter`, an area light of the same radiance everywhere, at the wavelengths of `path`.
    #[inline(always)]
    pub fn radiance<C: Colour>(
        &self,
        paths: &CameraPaths<C>,
        path: usize,
        emitter: usize,
    ) -> C::Spectrum {
        let number = self.colour_of[emitter];
        if self.colours.is_prepared::<C>() {
            self.colours.prepared(&paths.emission, path, number)
        } else {
            C::evaluate(self.colours.curve(number), &paths.wavelengths[path])
        }
    }
}
