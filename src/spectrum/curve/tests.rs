use super::*;
use proptest::prelude::*;

/// Where Mitsuba 3.9.1 was asked for the values below, in nm.
const NM: [f32; 4] = [410.0, 480.0, 550.0, 650.0];

#[track_caller]
fn assert_close<const N: usize>(ours: [f32; N], mitsuba: [f32; N], tolerance: f32) {
    for (a, b) in ours.into_iter().zip(mitsuba) {
        assert!(
            (a - b).abs() <= tolerance,
            "{ours:?} instead of {mitsuba:?}"
        );
    }
}

fn values(curve: &SpectralCurve) -> [f32; 4] {
    curve.evaluate(&Wavelengths::at(NM)).0
}

#[test]
fn constants_are_constant_reflectances_and_the_illuminant_e() {
    let reflectance = SpectralCurve::constant_reflectance(0.5).unwrap();
    assert_eq!(
        (reflectance.rgb(), values(&reflectance)),
        ([0.5; 3], [0.5; 4])
    );
    let emission = SpectralCurve::constant_emission(2.0).unwrap();
    assert_close(emission.rgb(), [2.40959, 1.89658, 1.81783], 1e-5);
    assert_eq!(values(&emission), [2.0; 4]);
}

#[test]
fn tables_have_mitsubas_colours() {
    let flat = [(360.0, 1.0), (830.0, 1.0)];
    let reflectance = SpectralCurve::tabulated_reflectance(&flat).unwrap();
    assert_close(reflectance.rgb(), [0.998985, 0.998874, 0.998802], 2e-6);
    let emission = SpectralCurve::tabulated_emission(&flat).unwrap();
    assert_close(emission.rgb(), [1.20488, 0.948228, 0.909267], 5e-6);

    let irregular = [(400.0, 0.343), (404.0, 0.445), (500.0, 0.2), (700.0, 0.4)];
    let reflectance = SpectralCurve::tabulated_reflectance(&irregular).unwrap();
    assert_close(reflectance.rgb(), [0.350856, 0.229242, 0.323214], 2e-6);
    let expected = [
        0.445 - 0.245 * 6.0 / 96.0,
        0.445 - 0.245 * 76.0 / 96.0,
        0.25,
        0.35,
    ];
    assert_close(values(&reflectance), expected, 1e-6);

    let regular = [(400.0, 0.0), (500.0, 8.0), (600.0, 15.6), (700.0, 18.4)];
    let emission = SpectralCurve::tabulated_emission(&regular).unwrap();
    assert_close(emission.rgb(), [20.7108, 10.8546, 2.77115], 5e-5);
    assert_close(values(&emission), [0.8, 6.4, 11.8, 17.0], 1e-5);
}

#[test]
fn flat_tables_are_constants() {
    type Load = fn(&[(f32, f32)]) -> Result<SpectralCurve, CurveError>;
    let all: [Load; 6] = [
        SpectralCurve::tabulated_reflectance,
        SpectralCurve::tabulated_emission,
        SpectralCurve::tabulated_unbounded,
        SpectralCurve::tabulated_index,
        SpectralCurve::material_index,
        SpectralCurve::glass_index,
    ];
    for load in all {
        let regular = load(&[(300.0, 0.7), (600.0, 0.7), (900.0, 0.7)]).unwrap();
        let irregular = load(&[(360.0, 0.7), (500.0, 0.7), (830.0, 0.7)]).unwrap();
        for flat in [regular, irregular] {
            assert!(flat.is_constant(), "{flat:?}");
            assert_eq!(values(&flat), [0.7; 4]);
        }
        let bent = load(&[(300.0, 0.7), (600.0, 0.7), (900.0, 0.6)]).unwrap();
        // Beyond its ends it is zero.
        let short = load(&[(400.0, 0.7), (900.0, 0.7)]).unwrap();
        assert!(!bent.is_constant() && !short.is_constant());
    }
}

#[test]
fn indices_have_mitsubas_channels() {
    // mi.load_string('<bsdf version="3.0.0" type="conductor"><spectrum name="eta" value="…"/></bsdf>'), scalar_rgb
    let table = [(400.0, 1.3), (500.0, 2.0), (700.0, 0.7)];
    let index = SpectralCurve::tabulated_index(&table).unwrap();
    assert_close(index.rgb(), [1.03118, 1.7723, 1.67554], 1e-5);
    assert_close(values(&index), [1.37, 1.86, 1.675, 1.025], 1e-5);
    let material = SpectralCurve::material_index(&table).unwrap();
    assert_eq!(values(&material), values(&index));
    let glass = SpectralCurve::glass_index(&table).unwrap();
    assert_close(glass.rgb(), [1.41955; 3], 1e-5);
    assert_eq!(values(&glass), values(&index));
    assert_eq!(
        values(&SpectralCurve::constant_index(2.5).unwrap()),
        [2.5; 4]
    );
    assert_eq!(
        SpectralCurve::constant_index(-1.0).unwrap_err().to_string(),
        "index -1 is not a number from 0 to 1e6"
    );
}

#[test]
fn colours_outside_the_gamut_lose_their_negative_part() {
    let narrow = [(500.0, 1.0), (510.0, 1.0)];
    let emission = SpectralCurve::tabulated_emission(&narrow).unwrap();
    assert_close(emission.rgb(), [0.0, 0.0712441, 0.0133142], 1e-6);
    let reflectance = SpectralCurve::tabulated_reflectance(&narrow).unwrap();
    assert_close(reflectance.rgb(), [0.0, 0.0781108, 0.0146232], 1e-6);
}

#[test]
fn rgb_reflectances_have_mitsubas_spectra() {
    for (rgb, mitsuba) in [
        (
            [0.63, 0.065, 0.05],
            [0.0972351, 0.0532586, 0.0876478, 0.898048],
        ),
        (
            [0.14, 0.45, 0.091],
            [0.0301978, 0.220153, 0.45912, 0.0631665],
        ),
        (
            [0.725, 0.71, 0.68],
            [0.666024, 0.693158, 0.711245, 0.723565],
        ),
        ([0.05, 0.1, 0.6], [0.843475, 0.335924, 0.107164, 0.0552814]),
    ] {
        let curve = SpectralCurve::rgb_reflectance(rgb).unwrap();
        assert_eq!(curve.rgb(), rgb);
        assert_close(values(&curve), mitsuba, 2e-3);
    }
}

#[test]
fn rgb_emissions_are_filtered_daylight_as_in_mitsuba() {
    for (rgb, mitsuba) in [
        ([17.0, 12.0, 4.0], [2.48017, 7.83187, 13.2149, 12.4462]),
        ([2.0, 2.0, 2.0], [1.84825, 2.34194, 2.10199, 1.61675]),
    ] {
        let curve = SpectralCurve::rgb_emission(rgb).unwrap();
        assert_eq!(curve.rgb(), rgb);
        assert_close(values(&curve), mitsuba, 1e-2);
    }
    assert_eq!(
        SpectralCurve::rgb_emission([0.0; 3]),
        Ok(SpectralCurve::BLACK)
    );
}

#[test]
fn black_is_known() {
    assert!(SpectralCurve::constant_emission(0.0).unwrap().is_black());
    assert!(SpectralCurve::rgb_reflectance([0.0; 3]).unwrap().is_black());
    assert!(
        SpectralCurve::tabulated_emission(&[(400.0, 0.0), (500.0, 0.0)])
            .unwrap()
            .is_black()
    );
    assert!(
        !SpectralCurve::tabulated_emission(&[(400.0, 0.0), (500.0, 1.0)])
            .unwrap()
            .is_black()
    );
    assert!(
        !SpectralCurve::rgb_emission([0.0, 0.0, 1e-6])
            .unwrap()
            .is_black()
    );
}

#[test]
fn impossible_values_are_errors_that_name_the_place() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -0.1, 1.5] {
        let place = Place::Everywhere;
        assert!(matches!(
            SpectralCurve::constant_reflectance(bad),
            Err(CurveError::InvalidReflectance { place: p, .. }) if p == place
        ));
        assert!(SpectralCurve::rgb_reflectance([0.5, bad, 0.5]).is_err());
        assert!(SpectralCurve::tabulated_reflectance(&[(400.0, 0.5), (500.0, bad)]).is_err());
    }
    for bad in [f32::NAN, f32::INFINITY, -0.1, 1e38] {
        assert!(SpectralCurve::constant_emission(bad).is_err());
        assert!(SpectralCurve::rgb_emission([1.0, 1.0, bad]).is_err());
        assert!(SpectralCurve::tabulated_emission(&[(400.0, bad), (500.0, 1.0)]).is_err());
    }
    assert_eq!(
        SpectralCurve::rgb_reflectance([0.5, 1.5, 0.5])
            .unwrap_err()
            .to_string(),
        "reflectance 1.5 of the green channel is not in the range from 0 to 1"
    );
    assert_eq!(
        SpectralCurve::tabulated_emission(&[(400.0, 1.0), (500.0, -1.0)])
            .unwrap_err()
            .to_string(),
        "emission -1 at 500 nm is not a number from 0 to 1e30"
    );
}

proptest! {
    #[test]
    fn no_input_panics_and_what_is_accepted_is_finite(
        entries in prop::collection::vec((prop::num::f32::ANY, prop::num::f32::ANY), 0..5),
        rgb in prop::array::uniform3(prop::num::f32::ANY),
        u in 0.0f32..1.0,
    ) {
        let curves = [
            SpectralCurve::tabulated_emission(&entries),
            SpectralCurve::tabulated_reflectance(&entries),
            SpectralCurve::rgb_emission(rgb),
            SpectralCurve::rgb_reflectance(rgb),
        ];
        for curve in curves.into_iter().flatten() {
            let values = curve.evaluate(&Wavelengths::<4>::sample(u)).0;
            prop_assert!(values.iter().chain(&curve.rgb()).all(|v| v.is_finite() && *v >= 0.0), "{curve:?}");
        }
    }

    #[test]
    fn accepted_inputs_of_any_size_stay_finite(
        exponents in prop::array::uniform3(-45.0f32..30.0),
        u in 0.0f32..1.0,
    ) {
        let rgb = exponents.map(|e| 10.0f32.powf(e).min(1e30));
        let emission = SpectralCurve::rgb_emission(rgb).unwrap();
        let values = emission.evaluate(&Wavelengths::<4>::sample(u)).0;
        prop_assert!(values.iter().all(|v| v.is_finite() && *v >= 0.0), "{emission:?}");
        let reflectance = SpectralCurve::rgb_reflectance(rgb.map(|v| v.min(1.0))).unwrap();
        let values = reflectance.evaluate(&Wavelengths::<4>::sample(u)).0;
        prop_assert!(values.iter().all(|v| (0.0..=1.0).contains(v)), "{reflectance:?}");
    }
}

/// A factor leaves the form of the spectrum as it is; a colour that is as bright from the start has another.
#[test]
fn a_multiple_of_a_colour_has_its_spectrum() {
    let rgb = [0.9, 0.1, 0.2];
    let once = SpectralCurve::rgb_unbounded(rgb).unwrap();
    let multiple = SpectralCurve::rgb_unbounded_times(rgb, 0.5).unwrap();
    assert_eq!(multiple.rgb(), [0.45, 0.05, 0.1]);
    let at = Wavelengths::at([420.0, 500.0, 580.0, 660.0]);
    let (once, multiple) = (once.evaluate(&at), multiple.evaluate(&at));
    for (once, multiple) in once.0.into_iter().zip(multiple.0) {
        assert!((0.5 * once - multiple).abs() < 1e-6, "{once} {multiple}");
    }
    let grey = SpectralCurve::rgb_unbounded_times([0.25; 3], 2.0).unwrap();
    assert!(grey.is_constant() && grey.rgb() == [0.5; 3]);
    assert!(SpectralCurve::rgb_unbounded_times([-1.0; 3], -1.0).is_err());
    assert!(SpectralCurve::rgb_unbounded_times(rgb, -1.0).is_err());
}
