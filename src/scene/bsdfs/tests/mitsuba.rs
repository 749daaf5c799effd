//! Values and densities are Mitsuba's.

use glam::Vec3;

use super::{direction, materials, seen, seen_in_rgb};
use crate::scene::bsdfs::{BsdfValue, Material, Side};
use crate::spectrum::{Rgb, Spectrum, SpectrumArithmetic};

/// The values of Mitsuba; the file says how they were found.
const VALUES: &str = include_str!("mitsuba_values.txt");

/// A line of the file.
struct Line {
    name: &'static str,
    side: Side,
    outgoing: Vec3,
    incident: Vec3,
    value: [f32; 3],
    pdf: f32,
}

fn lines() -> impl Iterator<Item = Line> {
    let lines = VALUES.lines().filter(|line| !line.starts_with('#'));
    lines.map(|line| {
        let mut words = line.split(' ');
        let name = words.next().unwrap();
        let side = match words.next().unwrap() {
            "Front" => Side::Front,
            _ => Side::Back,
        };
        let mut number = || words.next().unwrap().parse().unwrap();
        Line {
            name,
            side,
            outgoing: direction(number(), number()),
            incident: direction(number(), number()),
            value: [number(), number(), number()],
            pdf: number(),
        }
    })
}

#[test]
fn values_and_densities_are_mitsubas() {
    let mut wrong = Vec::new();
    for line in lines() {
        let mut all = materials().iter();
        let (_, material) = all.find(|(case, _)| case.name == line.name).unwrap();
        let ours = mean_over_choices(material, line.side, line.outgoing, line.incident);
        let differs = |ours: f32, theirs: f32, tolerance: f32| {
            (ours - theirs).abs() > tolerance * theirs + 2e-7
        };
        let values = ours.value.components().iter().zip(line.value);
        // Mitsuba's density of Beckmann's visible normals has the fitted masking; ours is the one that is sampled.
        if values
            .clone()
            .any(|(&ours, theirs)| differs(ours, theirs, 2e-4))
            || differs(ours.pdf.0, line.pdf, 4e-3)
        {
            let Line {
                name,
                side,
                value,
                pdf,
                ..
            } = line;
            wrong.push(format!(
                "{name} {side:?}: {ours:?} instead of {value:?}, {pdf}"
            ));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Mitsuba evaluates mixtures as a whole; here one part is drawn, so that the mean is compared.
fn mean_over_choices(
    material: &Material,
    side: Side,
    outgoing: Vec3,
    incident: Vec3,
) -> BsdfValue<Spectrum<3>> {
    let choices = if material.is_mixed() { 1000 } else { 1 };
    let mut sum = BsdfValue::of(Spectrum::ZERO, 0.0);
    for i in 0..choices {
        let choice = (i as f32 + 0.5) / choices as f32;
        if let Some(bsdf) = seen::<Rgb>(material, side, outgoing, &(), choice) {
            let value = bsdf.evaluate(outgoing, incident);
            sum.value += value.value / choices as f32;
            sum.pdf.0 += value.pdf.0 / choices as f32;
        }
    }
    sum
}

/// No line was forgotten: every model with a smooth lobe has some.
#[test]
fn every_model_with_a_smooth_lobe_is_compared() {
    for (case, material) in materials() {
        let outgoing = direction(0.9, 0.3);
        let bsdf = seen_in_rgb(material, Side::Front, outgoing).unwrap();
        let lines = lines().filter(|line| line.name == case.name).count();
        assert!(lines >= 3 || !bsdf.has_smooth_lobe(), "{}", case.name);
    }
}
