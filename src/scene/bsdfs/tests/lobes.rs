//! What bsdfs say of their lobes.

use super::{direction, materials, seen_in_rgb};
use crate::scene::bsdfs::{DirectionNumbers, Side};

/// As many choices as a probability is measured with.
const CHOICES: usize = 10_000;

/// Diffuse lobes take the direction that is there for them, as often as is said.
#[test]
fn diffuse_lobes_are_drawn_from_as_often_as_they_say() {
    let mut seen = 0;
    for (case, material) in materials() {
        for side in [Side::Front, Side::Back] {
            let outgoing = direction(0.55, 2.0);
            let Some(bsdf) = seen_in_rgb(material, side, outgoing) else {
                continue;
            };
            let diffuse = direction(0.7, 1.0);
            let takes_it = |choice: usize| {
                let choice = (choice as f32 + 0.5) / CHOICES as f32;
                let numbers = DirectionNumbers::new([0.3, 0.6, choice]).with_diffuse(diffuse);
                bsdf.sample(outgoing, &numbers).incident == diffuse
            };
            let taken = (0..CHOICES).filter(|&choice| takes_it(choice)).count();
            let lobes = bsdf.lobes(outgoing);
            let expected = lobes.diffuse * CHOICES as f32;
            assert!(
                (taken as f32 - expected).abs() < 2.0,
                "{} {side:?}: {taken} of {expected}",
                case.name
            );
            if lobes.diffuse < 1.0 {
                seen += usize::from(taken > 0);
            }
            let is_smooth = lobes.diffuse > 0.0 || lobes.has_glossy;
            assert_eq!(is_smooth, bsdf.has_smooth_lobe(), "{}", case.name);
        }
    }
    assert!(seen > 5, "only {seen} have a diffuse lobe beside others");
}
