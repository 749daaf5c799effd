//! Stage: rays find the nearest surfaces.

use std::time::Instant;

use super::accelerator::Accelerator;
use super::batch::{Segments, ShadowRays};
use super::statistics::TraceStatistics;
use crate::embree::Coherence;
use crate::spectrum::Colour;

/// Traces all segments of the batch to the nearest surface.
pub(super) fn nearest<C: Colour>(
    accelerator: &Accelerator,
    coherence: Coherence,
    segments: &mut Segments<C>,
    statistics: &mut TraceStatistics,
) {
    let start = Instant::now();
    accelerator.nearest(&mut segments.rays, &mut segments.hits, coherence);
    statistics.intersection_time += start.elapsed();
    accelerator.name(&mut segments.hits);
    statistics.rays += segments.len() as u64;
}

/// Asks for every shadow ray whether something is in its way.
pub(super) fn occluded<C: Colour>(
    accelerator: &Accelerator,
    shadow: &mut ShadowRays<C>,
    statistics: &mut TraceStatistics,
) {
    let start = Instant::now();
    accelerator
        .scene()
        .occluded_stream(&mut shadow.rays, Coherence::Incoherent);
    statistics.intersection_time += start.elapsed();
    statistics.shadow_rays += shadow.path.len() as u64;
}
