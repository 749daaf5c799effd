//! What lamps emit, evaluated once per path and not at every vertex that looks at them.

use super::batch::CameraPaths;
use crate::room::make_room;
use crate::scene::Emitter;
use crate::spectrum::{Colour, SpectralCurve};

/// With more curves than this, a path would evaluate more of them than it looks at.
const MOST_CURVES: usize = 2;

/// The spectra of area lights. Where a scene has so few different ones, every path evaluates them all as it starts.
pub(super) struct EmissionTable {
    /// The different spectra.
    curves: Vec<SpectralCurve>,
    /// By emitter: which of them it has; without meaning where it has none, or one that varies.
    curve_of: Vec<usize>,
    /// How many of them every path evaluates: all or none.
    prepared: usize,
}

impl EmissionTable {
    /// The table of a scene's emitters.
    pub fn new(emitters: &[Emitter]) -> Self {
        let mut curves: Vec<SpectralCurve> = Vec::new();
        let mut curve_of = Vec::new();
        for emitter in emitters {
            let radiance = match emitter {
                Emitter::Area(light) => light.uniform_radiance(),
                _ => None,
            };
            let Some(radiance) = radiance else {
                curve_of.push(usize::MAX);
                continue;
            };
            let known = curves.iter().position(|curve| curve == radiance);
            curve_of.push(known.unwrap_or(curves.len()));
            if known.is_none() {
                curves.push(radiance.clone());
            }
        }
        let is_small = curves.len() <= MOST_CURVES;
        Self {
            prepared: if is_small { curves.len() } else { 0 },
            curves,
            curve_of,
        }
    }

    /// Evaluates the spectra at the wavelengths of every path.
    #[inline(always)]
    pub fn prepare<C: Colour>(&self, paths: &mut CameraPaths<C>) {
        make_room(&mut paths.emission, paths.wavelengths.len() * self.prepared);
        let curves = &self.curves[..self.prepared];
        let curves_of = |wavelengths| curves.iter().map(move |curve| (curve, wavelengths));
        let colours = paths.wavelengths.iter().flat_map(curves_of);
        C::evaluate_each(colours, |radiance| paths.emission.push(radiance));
    }

    /// The radiance of emitter number `emitter`, an area light of the same radiance everywhere, at the wavelengths of `path`.
    #[inline(always)]
    pub fn radiance<C: Colour>(
        &self,
        paths: &CameraPaths<C>,
        path: usize,
        emitter: usize,
    ) -> C::Spectrum {
        let curve = self.curve_of[emitter];
        if self.prepared == 0 {
            return C::evaluate(&self.curves[curve], &paths.wavelengths[path]);
        }
        paths.emission[path * self.prepared + curve]
    }
}
