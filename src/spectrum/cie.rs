//! The standard observer, the illuminant D65 and linear sRGB.

use super::cie_tables::{CIE_1931, D65, ENTRIES};
use super::piecewise_linear::GridPlace;

/// The shortest wavelength carried by a path, in nm.
pub const WAVELENGTH_MIN: f32 = 360.0;
/// The longest wavelength carried by a path, in nm.
pub const WAVELENGTH_MAX: f32 = 830.0;

/// Distance of the entries of the CIE's tables, in nm.
pub(super) const STEP: f32 = 5.0;

/// Divides the integral of ȳ out of X, Y and Z, per nm.
///
/// Mitsuba's constant, and so the absolute scale of our images. It comes from a sum over 1000 points and is
/// 0.1 % greater than the reciprocal of the integral of the linear interpolant, 106.857 nm.
pub(super) const Y_NORMALISATION: f64 = 1.0 / 106.750_259_399_414_06;

/// Scales the relative power of D65 to a luminance of 1 (under [`Y_NORMALISATION`]).
pub(super) const D65_NORMALISATION: f64 = 1.0 / 98.997_417_518_762_55;

/// Linear sRGB from CIE XYZ, row by row (ITU-R BT.709 primaries, white point D65).
const SRGB_FROM_XYZ: [[f64; 3]; 3] = [
    [3.240_479, -1.537_150, -0.498_535],
    [-0.969_256, 1.875_991, 0.041_556],
    [0.055_648, -0.204_043, 1.057_311],
];

/// CIE XYZ from linear sRGB, row by row: the inverse.
const XYZ_FROM_SRGB: [[f64; 3]; 3] = [
    [0.412_453, 0.357_580, 0.180_423],
    [0.212_671, 0.715_160, 0.072_169],
    [0.019_334, 0.119_193, 0.950_227],
];

/// Linear sRGB of the normalised XYZ values (1, 1, 1): the equal-energy illuminant E.
pub(super) const ILLUMINANT_E: [f64; 3] = srgb_from_xyz([1.0, 1.0, 1.0]);

/// The colour matching functions seen as linear sRGB and normalised, per nm, from one of the CIE's entries to the next: see
/// [`matching_srgb`]. The fourth channel is nothing: so each is one vector.
#[derive(Clone, Copy)]
#[repr(C, align(32))]
struct MatchingInterval {
    value: [f32; 4],
    /// What is added on the way to the next entry.
    difference: [f32; 4],
}

static MATCHING_SRGB: [MatchingInterval; ENTRIES - 1] = {
    let nothing = MatchingInterval {
        value: [0.0; 4],
        difference: [0.0; 4],
    };
    let mut table = [nothing; ENTRIES - 1];
    let mut i = 0;
    while i < ENTRIES - 1 {
        let (here, next) = (
            normalised_srgb(CIE_1931[i]),
            normalised_srgb(CIE_1931[i + 1]),
        );
        let mut channel = 0;
        while channel < 3 {
            table[i].value[channel] = here[channel];
            table[i].difference[channel] = next[channel] - here[channel];
            channel += 1;
        }
        i += 1;
    }
    table
};

/// The colour of an entry of the CIE's table.
const fn normalised_srgb([x, y, z]: [f32; 3]) -> [f32; 3] {
    let [r, g, b] = srgb_from_xyz([x as f64, y as f64, z as f64]);
    [
        (r * Y_NORMALISATION) as f32,
        (g * Y_NORMALISATION) as f32,
        (b * Y_NORMALISATION) as f32,
    ]
}

/// Linear sRGB (unbounded) of CIE XYZ.
const fn srgb_from_xyz(xyz: [f64; 3]) -> [f64; 3] {
    let m = &SRGB_FROM_XYZ;
    [
        m[0][0] * xyz[0] + m[0][1] * xyz[1] + m[0][2] * xyz[2],
        m[1][0] * xyz[0] + m[1][1] * xyz[1] + m[1][2] * xyz[2],
        m[2][0] * xyz[0] + m[2][1] * xyz[1] + m[2][2] * xyz[2],
    ]
}

/// CIE XYZ of linear sRGB.
#[inline]
pub fn xyz_from_srgb(rgb: [f64; 3]) -> [f64; 3] {
    XYZ_FROM_SRGB.map(|row| row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2])
}

/// The weight of the wavelength `nm` in linear sRGB, per nm: the integral over the wavelength of a spectral
/// radiance times this is its linear sRGB colour. Linear between the CIE's entries; `nm` must lie in
/// [`WAVELENGTH_MIN`]`..=`[`WAVELENGTH_MAX`].
pub(super) fn matching_srgb(nm: f32) -> [f32; 3] {
    let GridPlace { entry, fraction } = locate(nm);
    let [r, g, b, _] = matching_srgb_at(entry, fraction);
    [r, g, b]
}

/// [`matching_srgb`], and 0, at a `fraction` of the way from an `entry` to the next.
#[inline(always)]
pub(super) fn matching_srgb_at(entry: u32, fraction: f32) -> [f32; 4] {
    let MatchingInterval { value, difference } = MATCHING_SRGB[entry as usize];
    std::array::from_fn(|i| value[i] + fraction * difference[i])
}

/// Spectral radiance of the illuminant D65 of luminance 1 at the wavelength `nm`, which must lie in
/// [`WAVELENGTH_MIN`]`..=`[`WAVELENGTH_MAX`].
#[inline(always)]
pub(super) fn illuminant_d65(nm: f32) -> f32 {
    let GridPlace { entry, fraction } = locate(nm);
    let entry = entry as usize;
    (D65[entry] + fraction * (D65[entry + 1] - D65[entry])) * D65_NORMALISATION as f32
}

/// The entry of a CIE table at or before `nm`, and the fraction of the way from there to the next.
#[inline(always)]
pub(super) fn locate(nm: f32) -> GridPlace {
    let position = (nm - WAVELENGTH_MIN) * (1.0 / STEP);
    GridPlace::of(position, (ENTRIES - 2) as f32)
}

/// Unbounded linear sRGB of a quantity given over the wavelength in nm, under the illuminant E (`emission`) or
/// D65 (`reflectance`), by the sum over 1000 points that Mitsuba uses, so that both see the same colour.
///
/// Compared with the exact integral the sum is 0.1 % small; [`Y_NORMALISATION`] makes up for that in emission,
/// but not in a reflectance, where a perfect white has the colour (0.99899, 0.99887, 0.99880).
fn sum_srgb(value: impl Fn(f32) -> f64) -> [f64; 3] {
    const POINTS: u32 = 1000;
    let width = f64::from(WAVELENGTH_MAX - WAVELENGTH_MIN);
    let mut sum = [0.0; 3];
    for i in 0..POINTS {
        let nm = WAVELENGTH_MIN + (f64::from(i) / f64::from(POINTS - 1) * width) as f32;
        let value = value(nm);
        for (sum, weight) in sum.iter_mut().zip(matching_srgb(nm)) {
            *sum += f64::from(weight) * value;
        }
    }
    sum.map(|channel| channel * width / f64::from(POINTS))
}

/// Linear sRGB of the emission `value` (over the wavelength in nm), without negative components.
pub(super) fn srgb_of_emission(value: impl Fn(f32) -> f32) -> [f32; 3] {
    sum_srgb(|nm| f64::from(value(nm))).map(|channel| channel.max(0.0) as f32)
}

/// Linear sRGB of the reflectance `value` (over the wavelength in nm) under D65, limited to [0, 1].
pub(super) fn srgb_of_reflectance(value: impl Fn(f32) -> f32) -> [f32; 3] {
    srgb_under_d65(value).map(|channel| channel.clamp(0.0, 1.0) as f32)
}

/// Unbounded linear sRGB of the reflectance `value` (over the wavelength in nm) under D65.
pub(super) fn srgb_under_d65(value: impl Fn(f32) -> f32) -> [f64; 3] {
    sum_srgb(|nm| f64::from(value(nm)) * f64::from(illuminant_d65(nm)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_tables_are_met_at_their_entries_and_linear_between() {
        assert_eq!(illuminant_d65(360.0), 46.6383 * D65_NORMALISATION as f32);
        assert_eq!(illuminant_d65(830.0), 60.3125 * D65_NORMALISATION as f32);
        let halfway = 0.5 * (illuminant_d65(500.0) + illuminant_d65(505.0));
        assert!((illuminant_d65(502.5) - halfway).abs() < 1e-6);
        // mi.spectrum_to_srgb([1, 2, 3, 4], [450, 520, 555, 601]): a mean over four wavelengths.
        let mut srgb = [0.0; 3];
        for (i, nm) in [450.0, 520.0, 555.0, 601.0].into_iter().enumerate() {
            for (srgb, weight) in srgb.iter_mut().zip(matching_srgb(nm)) {
                *srgb += weight * (i + 1) as f32 / 4.0;
            }
        }
        for (srgb, mitsuba) in srgb
            .into_iter()
            .zip([0.020_087_6, 0.016_487_2, 0.002_326_41])
        {
            assert!((srgb - mitsuba).abs() < 1e-6, "{srgb} {mitsuba}");
        }
    }

    #[test]
    fn d65_has_luminance_one_and_the_colour_white() {
        // The trapezoidal rule on a fine grid is the integral of the (nearly quadratic) product.
        let mut srgb = [0.0; 3];
        for i in 0..4700 {
            let nm = 360.05 + 0.1 * i as f32;
            for (srgb, weight) in srgb.iter_mut().zip(matching_srgb(nm)) {
                *srgb += f64::from(weight * illuminant_d65(nm)) * 0.1;
            }
        }
        assert!(
            srgb.iter().all(|channel| (channel - 1.0).abs() < 2.5e-4),
            "{srgb:?}"
        );
    }
}
