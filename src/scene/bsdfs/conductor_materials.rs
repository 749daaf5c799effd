//! The optical constants of conductors: the `material` of `conductor` and `roughconductor`, or `eta` and `k`.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `material` | string | a name of `conductor_materials.txt`, which says where each comes from, or `none`: a perfect mirror | `none` |
//! | `eta` | spectrum or texture | instead of `material`: real part of the index of refraction | 0 |
//! | `k` | spectrum or texture | instead of `material`: imaginary part (absorption) | 1 |

use crate::scene::error::{SceneError, list};
use crate::scene::textures::{SpectrumTexture, TextureLoader};
use crate::scene::xml::Object;
use crate::spectrum::{CurveError, SpectralCurve};

const TABLES: &str = include_str!("conductor_materials.txt");

/// The complex index of refraction of a conductor in vacuum.
#[derive(Clone, Debug)]
pub struct ConductorIndex {
    /// The real part.
    pub eta: SpectrumTexture,
    /// The imaginary part.
    pub k: SpectrumTexture,
}

impl ConductorIndex {
    pub(super) fn load(object: &Object, textures: &mut TextureLoader) -> Result<Self, SceneError> {
        let material = object.string_or("material", "none")?;
        if material == "none" {
            return Ok(Self {
                eta: textures.index(object, "eta", 0.0)?,
                k: textures.index(object, "k", 1.0)?,
            });
        }
        if object.has("eta") || object.has("k") {
            return Err(object.parameter_error(
                "material",
                "give either `material` or `eta` and `k`, not both",
            ));
        }
        let entries = entries_of(material).ok_or_else(|| {
            let message = format!(
                "the material `{material}` is not known; known are: none, {}",
                list(names())
            );
            object.parameter_error("material", message)
        })?;
        Self::from_entries(&entries)
            .map_err(|error| object.parameter_error("material", format!("`{material}`: {error}")))
    }

    fn from_entries(entries: &[[f32; 3]]) -> Result<Self, CurveError> {
        let column = |index: usize| {
            let column: Vec<(f32, f32)> = entries.iter().map(|row| (row[0], row[index])).collect();
            SpectralCurve::material_index(&column).map(SpectrumTexture::Uniform)
        };
        Ok(Self {
            eta: column(1)?,
            k: column(2)?,
        })
    }

    /// Whether it differs from point to point.
    pub(super) fn varies(&self) -> bool {
        self.eta.varies() || self.k.varies()
    }

    /// Makes it the mean of its textures.
    pub(super) fn make_uniform(&mut self) {
        self.eta.make_uniform();
        self.k.make_uniform();
    }
}

/// The name in a line of the tables that begins a material.
fn name(line: &'static str) -> Option<&'static str> {
    let named = line.split_once(" # ").map(|(name, _source)| name);
    named.filter(|_| !line.starts_with('#'))
}

/// The other name in a line of the tables that states one.
fn other_name(line: &'static str) -> Option<&'static str> {
    line.strip_prefix("= ")
}

fn names() -> impl Iterator<Item = &'static str> {
    TABLES
        .lines()
        .filter_map(|line| name(line).or(other_name(line)))
}

/// Wavelength in nm, eta and k of a material, if it is known.
fn entries_of(material: &str) -> Option<Vec<[f32; 3]>> {
    let mut found = false;
    let mut entries = Vec::new();
    for line in TABLES.lines() {
        if let Some(name) = name(line) {
            if found {
                break;
            }
            found = name == material;
            entries.clear();
        } else if let Some(other) = other_name(line) {
            found |= other == material;
        } else {
            let mut numbers = line.split(' ').map(str::parse);
            if let (Some(Ok(nm)), Some(Ok(eta)), Some(Ok(k))) =
                (numbers.next(), numbers.next(), numbers.next())
            {
                entries.push([nm, eta, k]);
            }
        }
    }
    found.then_some(entries)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::shapes::SurfaceParameters;

    #[test]
    fn every_material_is_there_under_all_of_its_names() {
        assert_eq!(names().count(), 71);
        for name in names() {
            let entries = entries_of(name).unwrap();
            assert!(entries.len() >= 5, "{name}");
            ConductorIndex::from_entries(&entries).unwrap();
        }
        assert_eq!(entries_of("AlAs"), entries_of("AlAs_palik"));
        assert_ne!(entries_of("Cu"), entries_of("Cu_palik"));
        assert_eq!(entries_of("Xx"), None);
    }

    #[test]
    fn gold_has_mitsubas_channels() {
        // print(mi.load_dict({'type': 'conductor', 'material': 'Au'})), scalar_rgb
        let gold = ConductorIndex::from_entries(&entries_of("Au").unwrap()).unwrap();
        let mitsuba = [[0.143036, 0.375307, 1.44205], [3.983, 2.38556, 1.60336]];
        let point = SurfaceParameters::default();
        let ours = [gold.eta.rgb(&point), gold.k.rgb(&point)];
        for (ours, mitsuba) in ours.into_iter().zip(mitsuba) {
            for (a, b) in ours.into_iter().zip(mitsuba) {
                assert!((a - b).abs() < 1e-5, "{ours:?} instead of {mitsuba:?}");
            }
        }
    }
}
