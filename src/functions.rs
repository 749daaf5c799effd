//! Functions of one number in single precision, as polynomials: unlike those of the system's library they are the same everywhere, nobody need be called for
//! them, and loops over them become vector instructions.

use std::f32::consts::{FRAC_PI_2, LOG2_E, SQRT_2};

/// Sums with it have their integers in the last bits.
const INTEGERS: f32 = 1.5 * (1 << 23) as f32;

/// ln 2 in two parts, of which the first has few digits: products with integers are exact.
const LN_2: [f32; 2] = [0.693_359_4, -2.121_944_4e-4];

/// Sine and cosine of an angle between -pi/4 and pi/4, within two units of the last place: the minimax polynomials of
/// Cephes (`sinf.c`, Moshier 1992).
#[inline(always)]
pub fn sin_cos_of_eighth(angle: f32) -> (f32, f32) {
    let z = angle * angle;
    let sin = ((-1.951_529_6e-4 * z + 8.332_161e-3) * z - 1.666_665_5e-1) * z * angle + angle;
    let cos = ((2.443_315_7e-5 * z - 1.388_731_6e-3) * z + 4.166_664_6e-2) * z * z - 0.5 * z + 1.0;
    (sin, cos)
}

/// Sine and cosine of a part of a whole turn, in [0, 1].
#[inline(always)]
pub fn sin_cos_of_turn(part: f32) -> (f32, f32) {
    let quarters = 4.0 * part;
    let nearest = (quarters + INTEGERS) - INTEGERS;
    let (sin, cos) = sin_cos_of_eighth((quarters - nearest) * FRAC_PI_2);
    let number = (nearest + INTEGERS).to_bits();
    let is_odd = number & 1 != 0;
    let (sin, cos) = if is_odd { (cos, sin) } else { (sin, cos) };
    // The sine is negative in the third and the fourth quarter, the cosine in the second and the third.
    let sin = f32::from_bits(sin.to_bits() ^ (number & 2) << 30);
    let cos = f32::from_bits(cos.to_bits() ^ (number.wrapping_add(1) & 2) << 30);
    (sin, cos)
}

/// The arc tangent of a number between -1 and 1, within 2e-8 but for rounding (Abramowitz and Stegun 1964, 4.4.49).
#[inline(always)]
pub fn atan_of_at_most_one(x: f32) -> f32 {
    const COEFFICIENTS: [f32; 8] = [
        0.002_866_225_7,
        -0.016_165_737,
        0.042_909_614,
        -0.075_289_64,
        0.106_562_64,
        -0.142_089,
        0.199_935_51,
        -0.333_331_45,
    ];
    let z = x * x;
    let sum = COEFFICIENTS.into_iter().fold(0.0, |sum, a| (sum + a) * z);
    x + x * sum
}

/// The exponential of a number that is not positive, within two units of the last place; 0 below -87 (Cephes, `expf.c`).
#[inline(always)]
pub fn exp_of_negative(x: f32) -> f32 {
    const COEFFICIENTS: [f32; 6] = [
        1.987_569_2e-4,
        1.398_2e-3,
        8.333_452e-3,
        4.166_579_6e-2,
        1.666_666_5e-1,
        0.5,
    ];
    let shifted = x.max(-87.0) * LOG2_E + INTEGERS;
    let power = shifted - INTEGERS;
    let rest = x.max(-87.0) - power * LN_2[0] - power * LN_2[1];
    let sum = COEFFICIENTS.into_iter().fold(0.0, |sum, c| sum * rest + c);
    let mantissa = sum * rest * rest + rest + 1.0;
    let exponent = shifted.to_bits().wrapping_sub(INTEGERS.to_bits()) << 23;
    let value = f32::from_bits(mantissa.to_bits().wrapping_add(exponent));
    if x < -87.0 { 0.0 } else { value }
}

/// The natural logarithm of a positive number that is not subnormal, within two units of the last place (Cephes, `logf.c`).
#[inline(always)]
pub fn ln(x: f32) -> f32 {
    const COEFFICIENTS: [f32; 9] = [
        7.037_683_6e-2,
        -1.151_461e-1,
        1.167_699_9e-1,
        -1.242_014_1e-1,
        1.424_932_3e-1,
        -1.666_805_8e-1,
        2.000_071_4e-1,
        -2.499_999_4e-1,
        3.333_333e-1,
    ];
    // Powers of two are taken off so that what is left lies between the roots of 1/2 and of 2.
    let bits = x.to_bits();
    let power = (bits.wrapping_sub((0.5 * SQRT_2).to_bits()) as i32) >> 23;
    let rest = f32::from_bits(bits.wrapping_sub((power as u32) << 23)) - 1.0;
    let power = power as f32;
    let sum = COEFFICIENTS.into_iter().fold(0.0, |sum, c| sum * rest + c);
    let z = rest * rest;
    rest + (sum * rest * z + power * LN_2[1] - 0.5 * z) + power * LN_2[0]
}

/// The error function, within two units of the last place: the minimax polynomials of Juffa 2015 ("my_erff", stackoverflow.com/questions/35148198).
#[inline(always)]
pub fn erf(x: f32) -> f32 {
    const CENTRE: [f32; 6] = [
        -5.967_617_e-4,
        4.991_192e-3,
        -2.676_813_5e-2,
        1.128_199_2e-1,
        -3.761_253_4e-1,
        1.283_791_7e-1,
    ];
    const TAIL: [f32; 7] = [
        -1.728_534_7e-5,
        3.831_972_6e-4,
        -3.883_964_4e-3,
        2.425_462_2e-2,
        -1.067_778_8e-1,
        -6.348_467e-1,
        -1.287_175_1e-1,
    ];
    let (size, square) = (x.abs(), x * x);
    let centre = CENTRE.into_iter().fold(0.0, |sum, c| sum * square + c) * x + x;
    // Beyond 4 it is 1.
    let size = size.min(4.0);
    let tail = TAIL.into_iter().fold(0.0, |sum, c| sum * size + c) * size - size;
    let tail = (1.0 - exp_of_negative(tail)).copysign(x);
    if size > 0.927_734_4 { tail } else { centre }
}

/// The inverse error function (Giles 2012, "Approximating the erfinv function").
#[inline(always)]
pub fn inverse_erf(x: f32) -> f32 {
    const CENTRE: [f32; 9] = [
        2.810_226_4e-8,
        3.432_739_4e-7,
        -3.523_387_7e-6,
        -4.391_506_5e-6,
        2.185_808_7e-4,
        -1.253_725e-3,
        -4.177_681_6e-3,
        2.466_407_3e-1,
        1.501_409_4,
    ];
    const TAIL: [f32; 9] = [
        -2.002_142_6e-4,
        1.009_505_6e-4,
        1.349_343_2e-3,
        -3.673_428_4e-3,
        5.739_507_7e-3,
        -7.622_461_3e-3,
        9.438_870_5e-3,
        1.001_674,
        2.832_976_8,
    ];
    let x = x.clamp(-1.0 + f32::EPSILON, 1.0 - f32::EPSILON);
    let w = -ln((1.0 - x) * (1.0 + x));
    let polynomial = |coefficients: [f32; 9], w: f32| {
        let sum = coefficients.into_iter().fold(0.0, |sum, c| sum * w + c);
        x * sum
    };
    // No jump: both are worked out.
    let (centre, tail) = (
        polynomial(CENTRE, w - 2.5),
        polynomial(TAIL, w.sqrt() - 3.0),
    );
    if w < 5.0 { centre } else { tail }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The greatest difference to what is `exact`, in units of the last place of that, over a million numbers between `least` and `greatest`.
    fn worst(
        [least, greatest]: [f32; 2],
        f: impl Fn(f32) -> f32,
        exact: impl Fn(f64) -> f64,
    ) -> f64 {
        const N: u32 = 1_000_000;
        let numbers = (0..=N).map(|i| least + (greatest - least) * (i as f32 / N as f32));
        let errors = numbers.map(|x| {
            let exact = exact(f64::from(x));
            let unit = f64::from((exact as f32).abs().max(f32::MIN_POSITIVE) * f32::EPSILON);
            (f64::from(f(x)) - exact).abs() / unit
        });
        errors.fold(0.0, f64::max)
    }

    #[test]
    fn exponentials_and_logarithms_are_exact_in_nearly_all_digits() {
        assert!(worst([-87.0, 0.0], exp_of_negative, f64::exp) < 2.0);
        assert_eq!(exp_of_negative(-88.0), 0.0);
        assert_eq!(exp_of_negative(f32::NEG_INFINITY), 0.0);
        assert_eq!(exp_of_negative(0.0), 1.0);
        for range in [
            [0.01, 0.5],
            [0.5, 0.99],
            [1.01, 3.0],
            [1e-30, 1.0],
            [1.0, 1e30],
        ] {
            let units = worst(range, ln, f64::ln);
            assert!(units < 2.0, "{range:?}: {units}");
        }
        assert_eq!(ln(1.0), 0.0);
    }

    #[test]
    fn the_logarithm_is_close_where_it_is_small() {
        for i in 0..20_000 {
            let x = 1e-3 * 1.001_f32.powi(i % 14_000) * (1.0 + 1e-5 * (i % 77) as f32);
            let expected = f64::from(x).ln();
            let error = (f64::from(ln(x)) - expected).abs();
            assert!(error < 1e-7 * expected.abs().max(1.0), "{x}: {error}");
        }
    }

    #[test]
    fn the_error_function_is_exact_in_nearly_all_digits() {
        for range in [[-5.0, -0.9], [-1.0, 1.0], [0.9, 5.0]] {
            let units = worst(range, erf, libm::erf);
            assert!(units < 2.0, "{range:?}: {units}");
        }
        assert_eq!([erf(f32::INFINITY), erf(f32::NEG_INFINITY)], [1.0, -1.0]);
    }

    #[test]
    fn the_inverse_error_function_inverts() {
        for i in -999..=999 {
            let x = i as f32 / 1000.0;
            assert!((libm::erff(inverse_erf(x)) - x).abs() < 1e-6, "{x}");
        }
    }

    #[test]
    fn sine_and_cosine_are_those_of_the_system() {
        for i in -1000..=1000 {
            let angle = std::f32::consts::FRAC_PI_4 * (i as f32 / 1000.0);
            let (sin, cos) = sin_cos_of_eighth(angle);
            let (want_sin, want_cos) = f64::from(angle).sin_cos();
            assert!((f64::from(sin) - want_sin).abs() < 1.2e-7, "{angle}");
            assert!((f64::from(cos) - want_cos).abs() < 1.2e-7, "{angle}");
        }
    }

    #[test]
    fn turns_have_sines_and_cosines() {
        const N: u32 = 1 << 16;
        for i in 0..=N {
            let part = i as f32 / N as f32;
            let (sin, cos) = sin_cos_of_turn(part);
            let exact = (std::f64::consts::TAU * f64::from(part)).sin_cos();
            assert!((f64::from(sin) - exact.0).abs() < 2e-7, "{part}: {sin}");
            assert!((f64::from(cos) - exact.1).abs() < 2e-7, "{part}: {cos}");
        }
        assert_eq!(sin_cos_of_turn(0.25), (1.0, 0.0));
        assert_eq!(sin_cos_of_turn(0.5).1, -1.0);
    }
}
