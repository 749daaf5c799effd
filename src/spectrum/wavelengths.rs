//! The wavelengths that a path carries, drawn with the importance of the eye's sensitivity.

use super::cie::{WAVELENGTH_MAX, WAVELENGTH_MIN};
use crate::functions::ln;
use crate::lanes::CHUNK;

/// Steepness of the density, in 1/nm (Radziszewski et al. 2009, "An improved technique for full spectral
/// rendering", equation 10).
const STEEPNESS: f64 = 0.0072;
/// Wavelength of the greatest density, in nm.
const PEAK: f64 = 538.0;
/// tanh(STEEPNESS * (WAVELENGTH_MIN - PEAK)); `tanh` cannot be evaluated at compile time.
const TANH_MIN: f64 = -0.856_910_625_469_828;
/// tanh(STEEPNESS * (WAVELENGTH_MAX - PEAK)).
const TANH_MAX: f64 = 0.970_591_346_940_269_8;

/// `N` wavelengths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wavelengths<const N: usize> {
    nm: [f32; N],
}

impl<const N: usize> Wavelengths<N> {
    /// Draws a hero wavelength from the uniform number `u` in [0, 1), and the others from `u` rotated by
    /// multiples of 1/N (Wilkie et al. 2014, "Hero wavelength spectral sampling").
    ///
    /// Each wavelength on its own has the density p(λ) ∝ 1/cosh²(0.0072 (λ - 538)) on
    /// [`WAVELENGTH_MIN`]`..=`[`WAVELENGTH_MAX`] (Radziszewski et al. 2009).
    #[inline(always)]
    pub fn sample(u: f32) -> Self {
        Self {
            nm: std::array::from_fn(|i| wavelength_at(tanh_of(rotation::<N>(u, i)))),
        }
    }

    /// The probability density with which each of those was drawn, per nm.
    #[inline(always)]
    pub fn pdf(u: f32) -> [f32; N] {
        let [densities] = Self::pdf_each(&[u]);
        densities
    }

    /// [`Self::pdf`] for each of the numbers `u`.
    #[inline(always)]
    pub(super) fn pdf_each<const LANES: usize>(u: &[f32; LANES]) -> [[f32; N]; LANES] {
        let mut densities = u.map(|u| std::array::from_fn(|i| rotation::<N>(u, i)));
        for density in densities.as_flattened_mut() {
            *density = density_at(tanh_of(*density));
        }
        densities
    }

    /// Appends `count` of them, at most [`CHUNK`], each drawn by [`Self::sample`] from its number `u`.
    #[inline(always)]
    pub(super) fn sample_each(u: &[f32; CHUNK], count: usize, drawn: &mut Vec<Self>) {
        // One loop over the wavelengths of several: those of one do not fill a vector register.
        const LANES: usize = 16;
        for u in u[..count].chunks(LANES) {
            let mut rotated = [[0.0; N]; LANES];
            for (rotated, &u) in rotated.iter_mut().zip(u) {
                *rotated = std::array::from_fn(|i| rotation::<N>(u, i));
            }
            let mut nm = rotated;
            for nm in nm.as_flattened_mut() {
                *nm = wavelength_at(tanh_of(*nm));
            }
            for &nm in &nm[..u.len()] {
                drawn.push(Self { nm });
            }
        }
    }

    /// Chosen wavelengths, in nm.
    pub(crate) fn at(nm: [f32; N]) -> Self {
        Self { nm }
    }

    /// The wavelengths, in nm; the hero first.
    #[inline]
    pub fn nm(&self) -> &[f32; N] {
        &self.nm
    }
}

/// The uniform number of wavelength `i` of `N`, if that of the hero is `u`.
#[inline(always)]
fn rotation<const N: usize>(u: f32, i: usize) -> f32 {
    let shifted = u + i as f32 / N as f32;
    if shifted >= 1.0 {
        shifted - 1.0
    } else {
        shifted
    }
}

/// The inverse hyperbolic tangent by one logarithm. The library's keeps more digits near 0; here a difference of 1e-7
/// is less than 1e-4 nm.
#[inline(always)]
fn atanh(x: f32) -> f32 {
    0.5 * ln((1.0 + x) / (1.0 - x))
}

/// tanh of the scaled distance from the peak at the quantile `u` in [0, 1].
#[inline(always)]
fn tanh_of(u: f32) -> f32 {
    const RANGE: f32 = (TANH_MAX - TANH_MIN) as f32;
    TANH_MIN as f32 + RANGE * u
}

/// The wavelength in nm at a scaled distance from the peak with this `tanh`.
#[inline(always)]
fn wavelength_at(tanh: f32) -> f32 {
    let nm = PEAK as f32 + atanh(tanh) * (1.0 / STEEPNESS) as f32;
    nm.clamp(WAVELENGTH_MIN, WAVELENGTH_MAX)
}

/// The density there, per nm: 1/cosh² is 1 - tanh².
#[inline(always)]
fn density_at(tanh: f32) -> f32 {
    const NORMALISATION: f32 = (STEEPNESS / (TANH_MAX - TANH_MIN)) as f32;
    NORMALISATION * (1.0 - tanh * tanh)
}

#[cfg(test)]
mod tests {
    use super::*;
    use statrs::distribution::{ChiSquared, ContinuousCDF};

    /// The wavelength at the quantile `u`, and its density.
    fn sample_visible(u: f32) -> (f32, f32) {
        (wavelength_at(tanh_of(u)), density_at(tanh_of(u)))
    }

    /// The density of Radziszewski et al. 2009, written down once more in its usual form.
    fn density(nm: f64) -> f64 {
        let unnormalised = |nm: f64| (0.0072 * (nm - 538.0)).cosh().powi(-2);
        let integral =
            ((0.0072f64 * (830.0 - 538.0)).tanh() - (0.0072f64 * (360.0 - 538.0)).tanh()) / 0.0072;
        unnormalised(nm) / integral
    }

    #[test]
    fn the_limits_are_the_hyperbolic_tangents_they_stand_for() {
        assert!((TANH_MIN - (STEEPNESS * (f64::from(WAVELENGTH_MIN) - PEAK)).tanh()).abs() < 1e-14);
        assert!((TANH_MAX - (STEEPNESS * (f64::from(WAVELENGTH_MAX) - PEAK)).tanh()).abs() < 1e-14);
    }

    #[test]
    fn the_density_integrates_to_one_and_belongs_to_the_wavelength() {
        let steps = 100_000;
        let mut integral = 0.0;
        let mut previous = sample_visible(0.0);
        for i in 0..=steps {
            let (nm, pdf) = sample_visible(i as f32 / steps as f32);
            assert!(
                (f64::from(pdf) - density(f64::from(nm))).abs() < 2e-8,
                "{nm} nm: {pdf}"
            );
            integral += 0.5 * f64::from(pdf + previous.1) * f64::from(nm - previous.0);
            previous = (nm, pdf);
        }
        assert!((integral - 1.0).abs() < 1e-5, "{integral}");
    }

    #[test]
    fn every_wavelength_follows_the_density() {
        const BINS: usize = 47;
        let draws = 40_000;
        let mut counts = [[0u32; BINS]; 4];
        let mut random = rand_mt::Mt::new(1);
        for _ in 0..draws {
            let u = (random.next_u32() >> 8) as f32 / (1u32 << 24) as f32;
            for (i, nm) in Wavelengths::<4>::sample(u).nm().iter().enumerate() {
                counts[i][(((nm - 360.0) / 10.0) as usize).min(BINS - 1)] += 1;
            }
        }
        for counts in counts {
            let statistic: f64 = counts
                .iter()
                .enumerate()
                .map(|(bin, &count)| {
                    let start = 360.0 + 10.0 * bin as f64;
                    let share: f64 = (0..100)
                        .map(|i| density(start + 0.1 * (f64::from(i) + 0.5)) * 0.1)
                        .sum();
                    let expected = share * f64::from(draws);
                    (f64::from(count) - expected).powi(2) / expected
                })
                .sum();
            let p = ChiSquared::new((BINS - 1) as f64).unwrap().sf(statistic);
            assert!(p > 0.001, "chi-square {statistic}, p = {p}");
        }
    }

    #[test]
    fn the_others_are_rotations_of_the_hero() {
        let drawn = Wavelengths::<4>::sample(0.6);
        for (i, quantile) in [0.6, 0.85, 0.1, 0.35].into_iter().enumerate() {
            let (nm, pdf) = sample_visible(quantile);
            assert!(
                (drawn.nm()[i] - nm).abs() < 1e-3
                    && (Wavelengths::<4>::pdf(0.6)[i] / pdf - 1.0).abs() < 1e-5
            );
        }
    }

    #[test]
    fn mitsuba_draws_the_same_wavelengths() {
        // mi.sample_rgb_spectrum(0.25): wavelength, reciprocal density.
        let (nm, pdf) = sample_visible(0.25);
        assert!((nm - 479.15405).abs() < 1e-3 && (1.0 / pdf - 302.17682).abs() < 1e-2);
    }

    #[test]
    fn the_ends_stay_in_range() {
        for u in [0.0, f32::from_bits(1.0f32.to_bits() - 1), 0.75, 0.999_999_9] {
            let drawn = Wavelengths::<4>::sample(u);
            for i in 0..4 {
                assert!((WAVELENGTH_MIN..=WAVELENGTH_MAX).contains(&drawn.nm()[i]));
                assert!(Wavelengths::<4>::pdf(u)[i] > 2e-4);
            }
        }
    }
}
