//! Many colours at once, such as the texels of an image.

use std::collections::HashMap;
use std::sync::OnceLock;

use super::upsampling::SigmoidPolynomial;
use super::values::Spectrum;
use super::wavelengths::Wavelengths;

/// Reflectances, each by its colour under D65. Their spectra are found when the first of them is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Reflectances {
    rgb: Vec<[f32; 3]>,
    spectra: OnceLock<Vec<SigmoidPolynomial>>,
}

impl Reflectances {
    /// Reflectances of the given colours: linear sRGB, in [0, 1] where they are to be asked for by wavelength.
    pub fn new(rgb: Vec<[f32; 3]>) -> Self {
        Self {
            rgb,
            spectra: OnceLock::new(),
        }
    }

    /// The colour of an entry.
    #[inline]
    pub fn rgb(&self, entry: usize) -> [f32; 3] {
        self.rgb[entry]
    }

    /// The colours of all entries.
    pub fn all_rgb(&self) -> &[[f32; 3]] {
        &self.rgb
    }

    /// The values of an entry at `wavelengths`.
    #[inline]
    pub fn evaluate<const N: usize>(
        &self,
        entry: usize,
        wavelengths: &Wavelengths<N>,
    ) -> Spectrum<N> {
        let spectrum = &self.spectra()[entry];
        Spectrum(wavelengths.nm().map(|nm| spectrum.at(nm)))
    }

    /// The spectra of all entries. Colours that occur often, as those of images with few bits do, are fitted once.
    fn spectra(&self) -> &[SigmoidPolynomial] {
        self.spectra.get_or_init(|| {
            let mut known = HashMap::new();
            let mut fit = |rgb: &[f32; 3]| {
                let key = rgb.map(f32::to_bits);
                *known
                    .entry(key)
                    .or_insert_with(|| SigmoidPolynomial::fit_quickly(*rgb))
            };
            self.rgb.iter().map(&mut fit).collect()
        })
    }
}
