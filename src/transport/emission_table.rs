//! What lamps emit, evaluated once per path and not at every vertex that looks at them.

use super::batch::CameraPaths;
use crate::room::make_room;
use crate::scene::{AreaLight, Emitter};
use crate::spectrum::{Colour, SpectralCurve};

/// With more curves than this, a path would evaluate more of them than it looks at.
const MOST_CURVES: usize = 2;

/// The spectra of area lights, where a scene has so few different ones that every path evaluates them all as it starts.
pub(super) struct EmissionTable {
    /// The different spectra; none where there are too many.
    curves: Vec<SpectralCurve>,
    /// By emitter: which of them it has.
    curve_of: Vec<usize>,
}

impl EmissionTable {
    /// The table of a scene's emitters.
    pub fn new(emitters: &[Emitter]) -> Self {
        let mut curves: Vec<SpectralCurve> = Vec::new();
        let mut curve_of = Vec::new();
        for emitter in emitters {
            let Emitter::Area(light) = emitter else {
                curve_of.push(usize::MAX);
                continue;
            };
            let known = curves.iter().position(|curve| *curve == light.radiance);
            curve_of.push(known.unwrap_or(curves.len()));
            if known.is_none() {
                curves.push(light.radiance.clone());
            }
        }
        if curves.len() > MOST_CURVES {
            curves.clear();
        }
        Self { curves, curve_of }
    }

    /// Evaluates the spectra at the wavelengths of every path.
    #[inline(always)]
    pub fn prepare<C: Colour>(&self, paths: &mut CameraPaths<C>) {
        make_room(
            &mut paths.emission,
            paths.wavelengths.len() * self.curves.len(),
        );
        let curves_of = |wavelengths| self.curves.iter().map(move |curve| (curve, wavelengths));
        let colours = paths.wavelengths.iter().flat_map(curves_of);
        C::evaluate_each(colours, |radiance| paths.emission.push(radiance));
    }

    /// The radiance of emitter number `emitter`, which is `light`, at the wavelengths of `path`.
    #[inline(always)]
    pub fn radiance<C: Colour>(
        &self,
        paths: &CameraPaths<C>,
        path: usize,
        emitter: usize,
        light: &AreaLight,
    ) -> C::Spectrum {
        if self.curves.is_empty() {
            return C::evaluate(&light.radiance, &paths.wavelengths[path]);
        }
        paths.emission[path * self.curves.len() + self.curve_of[emitter]]
    }
}
