//! The colours of many finished paths at once.
//!
//! One path has too few wavelengths to fill a vector register. So what can be is done in one loop over all wavelengths of several
//! paths.

use super::cie::{locate, matching_srgb_at};
use super::values::Spectrum;
use super::wavelengths::Wavelengths;

/// Paths that are taken together.
const LANES: usize = 16;

/// Appends the linear sRGB colours of `radiances`, each at the `wavelengths` that were drawn from the number in `draws` beside it.
#[inline(always)]
pub(super) fn to_rgb<const N: usize>(
    radiances: &[Spectrum<N>],
    wavelengths: &[Wavelengths<N>],
    draws: &[f32],
    colours: &mut Vec<[f32; 3]>,
) {
    let (mut u, mut nm) = ([0.0; LANES], [[0.0; N]; LANES]);
    let mut estimates = [[0.0; N]; LANES];
    let (mut entries, mut fractions) = ([[0; N]; LANES], [[0.0; N]; LANES]);
    let chunks = radiances
        .chunks(LANES)
        .zip(wavelengths.chunks(LANES).zip(draws.chunks(LANES)));
    for (radiances, (wavelengths, draws)) in chunks {
        u[..draws.len()].copy_from_slice(draws);
        for (lane, (radiance, wavelengths)) in radiances.iter().zip(wavelengths).enumerate() {
            estimates[lane] = radiance.0;
            nm[lane] = *wavelengths.nm();
        }
        let pdfs = Wavelengths::<N>::pdf_each(&u);
        for (estimate, pdf) in estimates
            .as_flattened_mut()
            .iter_mut()
            .zip(pdfs.as_flattened())
        {
            *estimate /= pdf * N as f32;
        }
        let places = entries
            .as_flattened_mut()
            .iter_mut()
            .zip(fractions.as_flattened_mut());
        for ((entry, fraction), &nm) in places.zip(nm.as_flattened()) {
            let place = locate(nm);
            (*entry, *fraction) = (place.entry, place.fraction);
        }
        for lane in 0..radiances.len() {
            let mut rgb = [0.0; 4];
            for i in 0..N {
                let weights = matching_srgb_at(entries[lane][i], fractions[lane][i]);
                for (sum, weight) in rgb.iter_mut().zip(weights) {
                    *sum += weight * estimates[lane][i];
                }
            }
            let [r, g, b, _] = rgb;
            colours.push([r, g, b]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_path_has_its_own_colour() {
        let draws: Vec<f32> = (0..57).map(|i| i as f32 / 57.0).collect();
        let wavelengths: Vec<_> = draws.iter().map(|&u| Wavelengths::<4>::sample(u)).collect();
        let radiance = |i| Spectrum([0.5, 1.0, 2.0, 0.1].map(|value| value * i as f32));
        let radiances: Vec<_> = (0..57).map(radiance).collect();
        let mut colours = Vec::new();
        to_rgb(&radiances, &wavelengths, &draws, &mut colours);
        assert_eq!(colours.len(), 57);
        for (i, colour) in colours.into_iter().enumerate() {
            let mut alone = Vec::new();
            let path = i..i + 1;
            let (radiances, draws) = (&radiances[path.clone()], &draws[path.clone()]);
            to_rgb(radiances, &wavelengths[path], draws, &mut alone);
            assert_eq!([colour], *alone);
        }
    }
}
