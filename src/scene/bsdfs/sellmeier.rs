//! `sellmeier`: the index of refraction of a glass or crystal at every wavelength, for `int_ior` and `ext_ior`. Not a plugin of Mitsuba's,
//! which knows no dispersion.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `glass` | string | one of `baf10`, `bak1`, `bk7`, `diamond`, `f2`, `fused silica`, `lasf9`, `sapphire`, `sf10`, `sf11`, `water` | |
//! | `b` | vector | instead of `glass`: Sellmeier's coefficients B1, B2, B3 | |
//! | `c` | vector | with `b`: C1, C2, C3 in square micrometres | |
//!
//! ```xml
//! <bsdf type="dielectric"><spectrum name="int_ior" type="sellmeier"><string name="glass" value="sf11"/></spectrum></bsdf>
//! ```
//!
//! Sellmeier 1871: n^2 = 1 + sum of B l^2 / (l^2 - C), where l is the wavelength in vacuum in micrometres.

use crate::scene::error::{SceneError, list};
use crate::scene::xml::Object;
use crate::spectrum::{SpectralCurve, WAVELENGTH_MAX, WAVELENGTH_MIN};

/// A term's B, and its C in square micrometres.
type Term = [f64; 2];

/// Known glasses. Schott's catalogue (N-BAF10, N-BAK1, N-BK7, F2, LASF9, SF10, SF11); diamond: Peter 1923; fused silica: Malitson
/// 1965; sapphire, ordinary ray: Malitson and Dodge 1972; water at 20 degrees Celsius: Daimon and Masumura 2007.
const GLASSES: [(&str, &[Term]); 11] = [
    (
        "baf10",
        &[
            [1.5851495, 0.00926681282],
            [0.143559385, 0.0424489805],
            [1.08521269, 105.613573],
        ],
    ),
    (
        "bak1",
        &[
            [1.12365662, 0.00644742752],
            [0.309276848, 0.0222284402],
            [0.881511957, 107.297751],
        ],
    ),
    (
        "bk7",
        &[
            [1.03961212, 0.00600069867],
            [0.231792344, 0.0200179144],
            [1.01046945, 103.560653],
        ],
    ),
    ("diamond", &[[0.3306, 0.030625], [4.3356, 0.011236]]),
    (
        "f2",
        &[
            [1.34533359, 0.00997743871],
            [0.209073176, 0.0470450767],
            [0.937357162, 111.886764],
        ],
    ),
    (
        "fused silica",
        &[
            [0.6961663, 0.0046791482],
            [0.4079426, 0.0135120631],
            [0.8974794, 97.9340025],
        ],
    ),
    (
        "lasf9",
        &[
            [2.00029547, 0.0121426017],
            [0.298926886, 0.0538736236],
            [1.80691843, 156.530829],
        ],
    ),
    (
        "sapphire",
        &[
            [1.4313493, 0.0052799261],
            [0.65054713, 0.0142382647],
            [5.3414021, 325.017834],
        ],
    ),
    (
        "sf10",
        &[
            [1.61625977, 0.0127534559],
            [0.259229334, 0.0581983954],
            [1.07762317, 116.60768],
        ],
    ),
    (
        "sf11",
        &[
            [1.73848403, 0.0136068604],
            [0.311168974, 0.0615960463],
            [1.17490871, 121.922711],
        ],
    ),
    (
        "water",
        &[
            [0.5684027565, 0.005101829712],
            [0.1726177391, 0.01821153936],
            [0.02086189578, 0.02620722293],
            [0.1130748688, 10.69792721],
        ],
    ),
];

/// The index that the plugin describes.
pub(super) fn load(object: &Object) -> Result<SpectralCurve, SceneError> {
    if object.plugin != "sellmeier" {
        return Err(object.unsupported(&["sellmeier"]));
    }
    let glass = object.string("glass")?;
    let coefficients = (object.vector("b")?, object.vector("c")?);
    object.finish()?;
    let curve = match (glass, coefficients) {
        (Some(name), (None, None)) => curve(terms_of(object, name)?),
        (None, (Some(b), Some(c))) => {
            let terms = [[b.x, c.x], [b.y, c.y], [b.z, c.z]];
            curve(&terms)
        }
        _ => return Err(object.error("a `sellmeier` needs either `glass` or both `b` and `c`")),
    };
    curve.ok_or_else(|| {
        object.error("Sellmeier's equation with these coefficients has no solution at some wavelength from 360 to 830 nm")
    })
}

fn terms_of(object: &Object, name: &str) -> Result<&'static [Term], SceneError> {
    let known = GLASSES
        .iter()
        .find(|(known, _)| known.eq_ignore_ascii_case(name));
    known.map(|&(_, terms)| terms).ok_or_else(|| {
        let names: Vec<&str> = GLASSES.iter().map(|&(name, _)| name).collect();
        let message = format!(
            "the glass `{name}` is not known; known are: {}",
            list(&names)
        );
        object.parameter_error("glass", message)
    })
}

/// The index at the wavelength `nm`; `None` where the equation has no solution.
fn index(terms: &[Term], nm: f64) -> Option<f32> {
    let squared = nm * nm * 1e-6;
    let sum: f64 = terms
        .iter()
        .map(|&[b, c]| b * squared / (squared - c))
        .sum();
    let index = (1.0 + sum).sqrt() as f32;
    (index.is_finite() && index > 0.0).then_some(index)
}

/// The index over the wavelengths of light, tabulated so finely that what lies between is within 1e-6.
fn curve(terms: &[Term]) -> Option<SpectralCurve> {
    const STEP: u16 = 1;
    let entries: Option<Vec<(f32, f32)>> = (WAVELENGTH_MIN as u16..=WAVELENGTH_MAX as u16)
        .step_by(STEP.into())
        .map(|nm| Some((f32::from(nm), index(terms, f64::from(nm))?)))
        .collect();
    SpectralCurve::glass_index(&entries?).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The catalogues' indices at the helium d line, 587.5618 nm.
    #[test]
    fn glasses_have_the_indices_of_their_catalogues() {
        for (name, expected) in [
            ("baf10", 1.67003),
            ("bak1", 1.57250),
            ("bk7", 1.51680),
            ("diamond", 2.4175),
            ("f2", 1.62004),
            ("fused silica", 1.45846),
            ("lasf9", 1.85025),
            ("sapphire", 1.76823),
            ("sf10", 1.72825),
            ("sf11", 1.78472),
            ("water", 1.33340),
        ] {
            let (_, terms) = GLASSES.iter().find(|(known, _)| *known == name).unwrap();
            let found = index(terms, 587.5618).unwrap();
            assert!((found - expected).abs() < 6e-5, "{name}: {found}");
        }
    }

    #[test]
    fn dispersion_is_normal_and_the_channels_have_the_index_at_the_sodium_line() {
        for (name, terms) in GLASSES {
            let [blue, red] = [400.0, 700.0].map(|nm| index(terms, nm).unwrap());
            assert!(blue > red, "{name}");
            let channel = curve(terms).unwrap().rgb()[0];
            assert!(
                (channel - index(terms, 589.3).unwrap()).abs() < 1e-5,
                "{name}"
            );
        }
    }

    #[test]
    fn resonances_among_the_wavelengths_have_no_index() {
        assert!(curve(&[[1.0, 0.25]]).is_none());
    }
}
