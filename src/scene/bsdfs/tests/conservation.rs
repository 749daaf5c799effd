//! Energy is conserved, and light may go both ways.

use std::sync::LazyLock;

use glam::Vec3;
use proptest::prelude::*;

use super::{direction, material, materials, numbers, seen_in_rgb};
use crate::scene::bsdfs::{Bsdf, DirectionNumbers, Material, Side};
use crate::spectrum::{Spectrum, SpectrumArithmetic};

/// What a white furnace shows: the mean of the weights, without the scaling of refracted radiance.
fn furnace(bsdf: &Bsdf<Spectrum<3>>, outgoing: Vec3, draws: usize) -> Spectrum<3> {
    let mut numbers = numbers();
    let mut sum = Spectrum::ZERO;
    for _ in 0..draws {
        let sample = bsdf.sample(outgoing, &DirectionNumbers::new(numbers()));
        assert!(sample.weight.is_finite() && sample.weight.components().iter().all(|&w| w >= 0.0));
        sum += sample.weight * (sample.eta * sample.eta);
    }
    sum / draws as f32
}

/// The most that a bsdf may scatter, and how far that may be from its albedo.
fn limits(name: &str) -> (f32, f32) {
    let is = |prefix: &str| name.starts_with(prefix);
    if is("principled") {
        // Nothing keeps its lobes together from sending out more than arrives.
        (1.4, 0.5)
    } else if is("normalmap") || is("bumpmap") {
        // Tilted frames lose what would go through the surface, and win.
        (1.4, 1.0)
    } else if is("plastic") {
        // What the base sends out is taken as the average over all directions.
        (1.01, 0.06)
    } else if [
        "diffuse",
        "conductor",
        "dielectric",
        "thindielectric",
        "null",
    ]
    .into_iter()
    .any(is)
    {
        (1.01, 0.01)
    } else {
        // Facets hide each other.
        (1.01, 0.3)
    }
}

/// Models lose what they absorb, and say how much.
#[test]
fn models_scatter_about_their_albedo() {
    for (case, material) in materials() {
        for side in [Side::Front, Side::Back] {
            for cos in [0.95, 0.5, 0.1] {
                let outgoing = direction(cos, 1.0);
                let Some(bsdf) = seen_in_rgb(material, side, outgoing) else {
                    continue;
                };
                let found = furnace(&bsdf, outgoing, 40_000);
                let albedo = bsdf.albedo(outgoing);
                let (most, tolerance) = limits(case.name);
                for (&found, &albedo) in found.components().iter().zip(albedo.components()) {
                    assert!(found < most, "{} {side:?} {cos}: {found}", case.name);
                    assert!((0.0..=1.0).contains(&albedo), "{} {albedo}", case.name);
                    assert!(
                        (found - albedo).abs() < tolerance,
                        "{} {side:?} {cos}: albedo {albedo}, scattered {found}",
                        case.name
                    );
                }
            }
        }
    }
}

#[test]
fn what_absorbs_nothing_loses_nothing() {
    for (xml, loss) in [
        (r#"<bsdf type="conductor"/>"#, 1e-5),
        (r#"<bsdf type="dielectric"/>"#, 1e-5),
        (r#"<bsdf type="thindielectric"/>"#, 1e-5),
        (r#"<bsdf type="null"/>"#, 1e-5),
        (
            r#"<bsdf type="diffuse"><float name="reflectance" value="1"/></bsdf>"#,
            1e-5,
        ),
        (
            r#"<bsdf type="roughconductor"><float name="alpha" value="0.05"/></bsdf>"#,
            0.02,
        ),
        (
            r#"<bsdf type="roughdielectric"><float name="alpha" value="0.05"/></bsdf>"#,
            0.02,
        ),
        (
            r#"<bsdf type="plastic"><float name="diffuse_reflectance" value="1"/></bsdf>"#,
            0.02,
        ),
        (
            r#"<bsdf type="roughplastic"><float name="diffuse_reflectance" value="1"/><float name="alpha" value="0.05"/></bsdf>"#,
            0.03,
        ),
    ] {
        let material = material(xml);
        let outgoing = direction(0.7, 0.4);
        let bsdf = seen_in_rgb(&material, Side::Front, outgoing).unwrap();
        for &found in furnace(&bsdf, outgoing, 100_000).components() {
            assert!((1.0 - loss..1.005).contains(&found), "{xml}: {found}");
        }
    }
}

/// A map that tilts a surface so far that its back is seen from some directions, and scatters.
static TILTED: LazyLock<Material> = LazyLock::new(|| {
    material(
        r#"<bsdf type="normalmap"><rgb name="normalmap" value="0.1, 0.5, 0.7"/>
            <boolean name="flip_invalid_normals" value="false"/><bsdf type="twosided"><bsdf type="diffuse"/></bsdf></bsdf>"#,
    )
});

/// Nothing that is opaque and not tilted says that it scatters light from below.
#[test]
fn opaque_surfaces_scatter_nothing_from_below() {
    for (case, material) in materials() {
        let expected = material.is_transmissive() || case.name.contains("map");
        assert_eq!(material.scatters_below(), expected, "{}", case.name);
    }
}

fn any_direction() -> impl Strategy<Value = Vec3> {
    (0.02f32..1.0, 0.0f32..std::f32::consts::TAU).prop_map(|(cos, azimuth)| direction(cos, azimuth))
}

/// The index behind the surface over the one before it, as a refracted sample tells it.
fn eta(bsdf: &Bsdf<Spectrum<3>>, outgoing: Vec3) -> f32 {
    let mut numbers = numbers();
    let mut etas = (0..1000).map(|_| bsdf.sample(outgoing, &DirectionNumbers::new(numbers())).eta);
    etas.find(|&eta| eta != 1.0).unwrap_or(1.0)
}

proptest! {
    /// Helmholtz reciprocity; through an interface, that of Veach 1997, equation 5.14: f / eta^2 is symmetric.
    #[test]
    fn light_may_go_both_ways(a in any_direction(), b in any_direction(), behind: bool) {
        for (case, material) in materials() {
            // Tilted frames are not reciprocal.
            if case.name.contains("map") {
                continue;
            }
            let (there, back) = if behind { (Side::Front, Side::Back) } else { (Side::Front, Side::Front) };
            let down = |v: Vec3| if behind { Vec3::new(v.x, v.y, -v.z) } else { v };
            let (Some(one), Some(other)) = (seen_in_rgb(material, there, a), seen_in_rgb(material, back, b)) else {
                continue;
            };
            // Two surfaces back to back, and a sheet whose facets must turn their backs to where light comes from.
            if behind && ["twosided", "principledthin-all"].contains(&case.name) {
                continue;
            }
            let forth = one.evaluate(a, down(b)).value / b.z;
            let return_way = other.evaluate(b, down(a)).value / a.z;
            let compression = if behind { eta(&one, direction(0.99, 0.0)).powi(2) } else { 1.0 };
            for (&f, &r) in (forth * compression).components().iter().zip(return_way.components()) {
                prop_assert!((f - r).abs() <= 3e-3 * f.max(r) + 1e-5, "{}: {f} {r}", case.name);
            }
        }
    }

    /// Light that arrives below the surface comes out above it only through materials that say so.
    #[test]
    fn light_from_below_is_scattered_where_that_is_said(outgoing in any_direction(), incident in any_direction(), back: bool) {
        let of_cases = materials().iter().map(|(case, material)| (case.name, material));
        for (name, material) in of_cases.chain([("tilted", &*TILTED)]) {
            let side = if back { Side::Back } else { Side::Front };
            let Some(bsdf) = seen_in_rgb(material, side, outgoing) else { continue };
            let value = bsdf.evaluate(outgoing, -incident);
            prop_assert!(value.value.is_black() || material.scatters_below(), "{name}: {value:?}");
        }
    }

    /// What a sample says of itself is what evaluation says of it; nothing is negative or not a number.
    #[test]
    fn samples_agree_with_evaluation(outgoing in any_direction(), u in prop::array::uniform3(0.0f32..1.0), back: bool) {
        for (case, material) in materials() {
            let side = if back { Side::Back } else { Side::Front };
            let Some(bsdf) = seen_in_rgb(material, side, outgoing) else { continue };
            let sample = bsdf.sample(outgoing, &DirectionNumbers::new(u));
            prop_assert!(sample.weight.is_finite(), "{}", case.name);
            if sample.weight.is_black() {
                continue;
            }
            prop_assert!((sample.incident.length() - 1.0).abs() < 1e-3, "{}: {:?}", case.name, sample);
            let value = bsdf.evaluate(outgoing, sample.incident);
            if sample.pdf.0.is_infinite() {
                continue;
            }
            prop_assert!(bsdf.has_smooth_lobe());
            prop_assert!((value.pdf.0 / sample.pdf.0 - 1.0).abs() < 1e-3, "{}", case.name);
            let weight = value.value / value.pdf.0;
            for (&w, &s) in weight.components().iter().zip(sample.weight.components()) {
                prop_assert!((w - s).abs() < 2e-3 * (1.0 + w), "{}: {w} {s}", case.name);
            }
        }
    }
}
