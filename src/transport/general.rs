//! The variant for all scenes: a vertex has a bsdf of any kind.
//!
//! Most surfaces of most scenes are matte all the same. What has to do with the directions of those is done for a whole chunk in one loop, as in the
//! [variant](super::matte) for scenes that have no others; then come the others, one by one.

use glam::Vec3;

use super::batch::CameraPaths;
use super::engine::Engine;
use super::framed::Framed;
use super::variant::{Arrivals, Guiding, Scattering, Variant};
use crate::lanes::{CHUNK, KeptLanes, VectorLanes};
use crate::sampling::Sampler;
use crate::scene::{BsdfSamples, BsdfValues, Diffuse, DirectionNumbers, Refraction, SlopeLanes};
use crate::spectrum::{Colour, SpectrumArithmetic};

/// See the module.
pub(super) struct General;

impl Variant for General {
    type Scattering<S: SpectrumArithmetic> = Local<S>;
    const CHOOSES_LOBES: bool = true;
    const REFRACTS: bool = true;
    const INSTANCES: bool = true;
}

/// A bsdf where a path has met it.
#[derive(Clone, Copy, Debug)]
pub(super) enum Local<S> {
    /// Diffuse: all frames about the normal are the same to it.
    Matte {
        bsdf: Diffuse<S>,
        /// What refraction has done to the path.
        refraction: Refraction,
    },
    /// Any other.
    Framed(Framed<S>),
}

impl<S: SpectrumArithmetic> Scattering<S> for Local<S> {
    #[inline(always)]
    fn prepare<C: Colour<Spectrum = S>>(engine: &Engine, paths: &mut CameraPaths<C>) {
        Diffuse::prepare(engine, paths);
    }

    #[inline(always)]
    fn arrive<C: Colour<Spectrum = S>>(
        arrivals: &Arrivals<C>,
        sampler: &mut Sampler,
        vertices: &mut Vec<Self>,
    ) -> KeptLanes {
        let mut kept = KeptLanes::none();
        for lane in 0..arrivals.chunk.len() {
            if let Some(reflectance) = arrivals.reflectance(lane) {
                vertices.push(Self::Matte {
                    bsdf: Diffuse { reflectance },
                    refraction: arrivals.refraction(lane),
                });
                kept.add_if(lane, true);
            } else if let Some(arrival) = arrivals.at_surface(lane)
                && let Some(framed) = Framed::at(&arrival, sampler)
            {
                vertices.push(match framed.matte() {
                    Some(&bsdf) => Self::Matte {
                        bsdf,
                        refraction: framed.refraction,
                    },
                    None => Self::Framed(framed),
                });
                kept.add_if(lane, true);
            }
        }
        kept
    }

    #[inline]
    fn albedo(&self) -> S {
        match self {
            Self::Matte { bsdf, .. } => bsdf.reflectance,
            Self::Framed(framed) => framed.albedo(),
        }
    }

    #[inline]
    fn refraction(&self) -> Refraction {
        match self {
            Self::Matte { refraction, .. } => *refraction,
            Self::Framed(framed) => framed.refraction,
        }
    }

    #[inline]
    fn shininess(&self) -> f32 {
        match self {
            Self::Matte { .. } => 0.0,
            Self::Framed(framed) => framed.shininess(),
        }
    }

    #[inline]
    fn lobe(&self) -> Option<Vec3> {
        match self {
            Self::Matte { .. } => None,
            Self::Framed(framed) => framed.lobe(),
        }
    }

    #[inline]
    fn has_smooth_lobe(&self) -> bool {
        match self {
            Self::Matte { .. } => true,
            Self::Framed(framed) => framed.has_smooth_lobe(),
        }
    }

    #[inline]
    fn scatters_below(&self) -> bool {
        match self {
            Self::Matte { .. } => false,
            Self::Framed(framed) => framed.scatters_below,
        }
    }

    #[inline]
    fn guiding(&self) -> Guiding {
        match self {
            Self::Matte { .. } => Guiding::MATTE,
            Self::Framed(framed) => framed.guiding(),
        }
    }

    #[inline]
    fn look(&self, lane: usize, direction: Vec3, normal: Vec3, samples: &mut BsdfSamples<S>) {
        match self {
            Self::Matte { bsdf, refraction } => {
                bsdf.look(lane, direction, normal, samples);
                samples.refraction[lane] = *refraction;
            }
            Self::Framed(framed) => {
                let value = framed.evaluate(direction);
                samples.direction.put(lane, direction);
                samples.weight[lane] = value.value;
                samples.pdf[lane] = value.pdf.0;
                samples.refraction[lane] = framed.refraction.then(1.0, value.is_dispersive);
            }
        }
    }

    #[inline(always)]
    fn evaluate(
        vertices: &[Self],
        normals: &VectorLanes<CHUNK>,
        directions: &VectorLanes<CHUNK>,
        values: &mut BsdfValues<S>,
    ) {
        values.find_cosine_pdfs(normals, directions);
        for (lane, vertex) in vertices.iter().enumerate() {
            match vertex {
                Self::Matte { bsdf, .. } => values.put_diffuse(lane, bsdf),
                Self::Framed(framed) => {
                    let value = framed.evaluate(directions.get(lane));
                    values.value[lane] = value.value;
                    values.pdf[lane] = value.pdf.0;
                }
            }
        }
    }

    #[inline(always)]
    fn sample<'a>(
        vertices: impl Iterator<Item = &'a Self> + Clone,
        normals: &VectorLanes<CHUNK>,
        [u, v, w]: &[[f32; CHUNK]; 3],
        diffuse: &[[f32; CHUNK]; 2],
        samples: &mut BsdfSamples<S>,
    ) {
        let [diffuse_u, diffuse_v] = diffuse;
        samples.draw_by_cosine(normals, diffuse_u, diffuse_v);
        let mut slopes = SlopeLanes::new();
        for (lane, vertex) in vertices.clone().enumerate() {
            if let Self::Framed(framed) = vertex
                && let Some(view) = framed.slope_view()
            {
                slopes.ask(lane, view, [u[lane], v[lane]]);
            }
        }
        slopes.find();
        for (lane, vertex) in vertices.enumerate() {
            match vertex {
                Self::Matte { bsdf, refraction } => {
                    samples.weight[lane] = bsdf.reflectance;
                    samples.refraction[lane] = *refraction;
                }
                Self::Framed(framed) => {
                    let numbers = DirectionNumbers::new([u[lane], v[lane], w[lane]]);
                    let numbers = numbers.with_slope(slopes.get(lane));
                    let sample = framed.sample(&numbers, samples.direction.get(lane));
                    samples.direction.put(lane, sample.incident);
                    samples.weight[lane] = sample.weight;
                    samples.pdf[lane] = sample.pdf.0;
                    let refraction = framed.refraction.then(sample.eta, sample.is_dispersive);
                    samples.refraction[lane] = refraction;
                }
            }
        }
    }
}
