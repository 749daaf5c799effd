//! Stage, only in renders that learn: finds what was learned where the vertices are.

use multiversion::multiversion;

use super::batch::Vertices;
use super::variant::{Scattering, Variant};
use crate::lanes::{CHUNK, VectorLanes};
use crate::learning::{Knowledge, LobeClass};
use crate::room::make_room;
use crate::spectrum::Colour;

/// Fills the columns of `vertices` that say where observations go, and what is known there; and, if it `tells_lobes`, where the lobes of surfaces point.
#[multiversion(targets(
    "x86_64+avx512f+avx512bw+avx512dq+avx512vl+avx2+fma+bmi1+bmi2",
    "x86_64+avx2+fma+bmi1+bmi2"
))]
pub(super) fn remember<C: Colour, V: Variant>(
    knowledge: &Knowledge,
    tells_lobes: bool,
    vertices: &mut Vertices<C, V>,
) {
    let count = vertices.len();
    make_room(&mut vertices.address, count);
    make_room(&mut vertices.insight, count);
    let mut positions = VectorLanes::default();
    let mut normals = VectorLanes::default();
    for start in (0..count).step_by(CHUNK) {
        let chunk = start..count.min(start + CHUNK);
        positions.load(vertices.position.slices(chunk.clone()));
        normals.load(vertices.normal.slices(chunk.clone()));
        let addresses = knowledge.addresses(&positions, &normals, chunk.len());
        let addresses = &addresses[..chunk.len()];
        vertices.address.extend_from_slice(addresses);
        let insights = addresses
            .iter()
            .map(|&address| knowledge.insight_number(address));
        vertices.insight.extend(insights);
    }
    if V::CHOOSES_LOBES && tells_lobes {
        make_room(&mut vertices.lobe, count);
        let lobes = vertices.bsdf.iter().map(Scattering::lobe);
        let classes = lobes.map(|lobe| lobe.map(LobeClass::of));
        vertices.lobe.extend(classes);
    }
}
