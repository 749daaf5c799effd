//! Many colours at once, such as the texels of an image.

use std::collections::HashMap;
use std::sync::OnceLock;

use super::upsampling::SigmoidPolynomial;
use super::values::Spectrum;
use super::wavelengths::Wavelengths;

/// Reflectances, each by its colour under D65. Their spectra are found when the first of them is asked for.
///
/// Where lamps show them, they may be greater than 1: then they are the colour of their greatest component, times it.
#[derive(Clone, Debug, PartialEq)]
pub struct Reflectances {
    rgb: Vec<[f32; 3]>,
    /// Whether some are greater than 1.
    exceed_one: bool,
    spectra: OnceLock<Vec<SigmoidPolynomial>>,
}

/// What a colour is divided by so that it is in [0, 1]: its greatest component, at least 1.
fn scale(rgb: [f32; 3]) -> f32 {
    rgb.into_iter().fold(1.0, f32::max)
}

impl Reflectances {
    /// Reflectances of the given colours: linear sRGB, not negative where they are to be asked for by wavelength.
    pub fn new(rgb: Vec<[f32; 3]>) -> Self {
        Self {
            exceed_one: rgb.iter().flatten().any(|&component| component > 1.0),
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
        let values = Spectrum(wavelengths.nm().map(|nm| spectrum.at(nm)));
        if self.exceed_one {
            values * scale(self.rgb[entry])
        } else {
            values
        }
    }

    /// The spectra of all entries, as far as they are in [0, 1]. Colours that occur often, as those of images with few bits do, are
    /// fitted once.
    fn spectra(&self) -> &[SigmoidPolynomial] {
        self.spectra.get_or_init(|| {
            let mut known = HashMap::new();
            let mut fit = |rgb: &[f32; 3]| {
                let key = rgb.map(f32::to_bits);
                *known.entry(key).or_insert_with(|| {
                    let scale = scale(*rgb);
                    SigmoidPolynomial::fit_quickly(rgb.map(|channel| channel / scale))
                })
            };
            self.rgb.iter().map(&mut fit).collect()
        })
    }
}
