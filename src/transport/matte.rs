//! The variant for scenes whose surfaces are all diffuse, without textures: nothing but a reflectance is known of a vertex.

use glam::Vec3;

use super::batch::CameraPaths;
use super::engine::Engine;
use super::variant::{Arrivals, Guiding, Scattering, Variant};
use crate::lanes::{CHUNK, KeptLanes, VectorLanes};
use crate::sampling::{Sampler, warp};
use crate::scene::{BsdfSamples, BsdfValues, Diffuse, Refraction};
use crate::spectrum::{Colour, SpectrumArithmetic};

/// See the module.
pub(super) struct Matte;

impl Variant for Matte {
    type Scattering<S: SpectrumArithmetic> = Diffuse<S>;
    const CHOOSES_LOBES: bool = false;
    const REFRACTS: bool = false;
    const INSTANCES: bool = false;
}

impl<S: SpectrumArithmetic> Scattering<S> for Diffuse<S> {
    #[inline(always)]
    fn prepare<C: Colour<Spectrum = S>>(engine: &Engine, paths: &mut CameraPaths<C>) {
        let reflectances = &engine.shapes.reflectances;
        reflectances.prepare::<C>(&paths.wavelengths, &mut paths.reflectances);
    }

    #[inline(always)]
    fn arrive<C: Colour<Spectrum = S>>(
        arrivals: &Arrivals<C>,
        _sampler: &mut Sampler,
        vertices: &mut Vec<Self>,
    ) -> KeptLanes {
        let mut kept = KeptLanes::none();
        let mut numbers = [0; CHUNK];
        let seen = arrivals.surfaces.entries.iter().zip(arrivals.cosines);
        for (lane, (entry, &cosine)) in seen.take(arrivals.chunk.len()).enumerate() {
            let number = entry.reflectance(cosine);
            numbers[lane] = number.unwrap_or_default();
            kept.add_if(lane, number.is_some());
        }
        let (table, paths) = (&arrivals.engine.shapes.reflectances, arrivals.paths);
        if table.is_prepared::<C>() {
            vertices.extend(kept.iter().map(|lane| {
                let path = arrivals.path(lane);
                let reflectance = table.prepared(&paths.reflectances, path, numbers[lane]);
                Self { reflectance }
            }));
        } else {
            let colour = |lane| (table.curve(numbers[lane]), arrivals.wavelengths(lane));
            C::evaluate_each(kept.iter().map(colour), |reflectance| {
                vertices.push(Self { reflectance });
            });
        }
        kept
    }

    #[inline(always)]
    fn albedo(&self) -> S {
        self.reflectance
    }

    #[inline(always)]
    fn refraction(&self) -> Refraction {
        Refraction::NONE
    }

    #[inline(always)]
    fn shininess(&self) -> f32 {
        0.0
    }

    #[inline(always)]
    fn lobe(&self) -> Option<Vec3> {
        None
    }

    #[inline(always)]
    fn has_smooth_lobe(&self) -> bool {
        true
    }

    #[inline(always)]
    fn scatters_below(&self) -> bool {
        false
    }

    #[inline(always)]
    fn guiding(&self) -> Guiding {
        Guiding::MATTE
    }

    #[inline(always)]
    fn look(&self, lane: usize, direction: Vec3, normal: Vec3, samples: &mut BsdfSamples<S>) {
        let pdf = warp::cosine_hemisphere_pdf(direction.dot(normal)).0;
        samples.direction.put(lane, direction);
        samples.weight[lane] = self.reflectance * pdf;
        samples.pdf[lane] = pdf;
    }

    #[inline(always)]
    fn evaluate(
        vertices: &[Self],
        normals: &VectorLanes<CHUNK>,
        directions: &VectorLanes<CHUNK>,
        values: &mut BsdfValues<S>,
    ) {
        values.evaluate_diffuse(vertices, normals, directions);
    }

    #[inline(always)]
    fn sample<'a>(
        vertices: impl Iterator<Item = &'a Self> + Clone,
        normals: &VectorLanes<CHUNK>,
        _numbers: &[[f32; CHUNK]; 3],
        [u, v]: &[[f32; CHUNK]; 2],
        samples: &mut BsdfSamples<S>,
    ) {
        samples.sample_diffuse(vertices, normals, u, v);
    }
}
