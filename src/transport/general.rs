//! The variant for all scenes: every vertex has a bsdf of any kind, in a frame of its own.

use glam::Vec3;

use super::variant::{Arrival, Arrivals, Guiding, Scattering, Variant};
use crate::lanes::{CHUNK, KeptLanes, VectorLanes};
use crate::sampling::{Frame, Sampler};
use crate::scene::{
    Bsdf, BsdfSamples, BsdfValues, Model, Refraction, SeenPoint, SurfaceParameters,
};
use crate::spectrum::{Colour, SpectrumArithmetic};

/// See the module.
pub(super) struct General;

impl Variant for General {
    type Scattering<S: SpectrumArithmetic> = Local<S>;
    const CHOOSES_LOBES: bool = true;
    const REFRACTS: bool = true;
    const INSTANCES: bool = true;
}

/// The shininess of lobes as narrow as what is told apart where light is learned.
const NARROW: f32 = 8.0;

/// A bsdf where a path has met it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Local<S> {
    /// The shading frame of the side that was hit.
    frame: Frame,
    /// Unit direction to where the path comes from, in that frame.
    outgoing: Vec3,
    bsdf: Bsdf<S>,
    /// See [`Material::scatters_below`](crate::scene::Material::scatters_below).
    scatters_below: bool,
    /// What refraction has done to the path.
    refraction: Refraction,
}

impl<S: SpectrumArithmetic> Local<S> {
    /// What is left of `spectrum` on a path that wavelengths leave in different directions.
    #[inline]
    fn dispersed(&self, spectrum: S, is_dispersive: bool) -> S {
        if is_dispersive && !self.refraction.is_single {
            spectrum.only_hero()
        } else {
            spectrum
        }
    }

    /// That of the surface at which a path arrives; `None` where it is black.
    #[inline]
    fn at<C: Colour<Spectrum = S>>(arrival: &Arrival<C>, sampler: &mut Sampler) -> Option<Self> {
        let (material, point) = (arrival.material, arrival.point());
        let facing = arrival.side.facing(point.shading_normal);
        let (frame, front, parameters) = if material.needs_parameters() {
            let parameters = arrival.parameters();
            let front = parameters.shading_frame(point.shading_normal);
            let frame = Frame {
                normal: facing,
                ..front
            };
            (frame, front, parameters)
        } else {
            let frame = Frame::about(facing);
            (frame, frame, SurfaceParameters::default())
        };
        let choice = if material.is_mixed() {
            sampler.material_choice(arrival.sequence(), arrival.depth())
        } else {
            0.0
        };
        let seen = SeenPoint {
            side: arrival.side,
            frame: front,
            outgoing: frame.to_local(-arrival.direction()),
            parameters,
            choice,
        };
        Some(Self {
            frame,
            outgoing: seen.outgoing,
            bsdf: material.bsdf::<C>(&seen, arrival.wavelengths())?,
            scatters_below: material.scatters_below(),
            refraction: arrival.refraction(),
        })
    }
}

impl<S: SpectrumArithmetic> Scattering<S> for Local<S> {
    #[inline(always)]
    fn arrive<C: Colour<Spectrum = S>>(
        arrivals: &Arrivals<C>,
        sampler: &mut Sampler,
        vertices: &mut Vec<Self>,
    ) -> KeptLanes {
        let mut kept = KeptLanes::none();
        for (lane, arrival) in arrivals.at_surfaces() {
            if let Some(local) = Self::at(&arrival, sampler) {
                vertices.push(local);
                kept.add_if(lane, true);
            }
        }
        kept
    }

    #[inline]
    fn albedo(&self) -> S {
        self.bsdf.albedo(self.outgoing)
    }

    #[inline]
    fn refraction(&self) -> Refraction {
        self.refraction
    }

    #[inline]
    fn shininess(&self) -> f32 {
        self.bsdf.shininess(self.outgoing)
    }

    #[inline]
    fn lobe(&self) -> Option<Vec3> {
        let Vec3 { x, y, z } = self.outgoing;
        let mirrored = Vec3::new(-x, -y, z);
        (self.shininess() > 0.0).then(|| self.frame.to_world(mirrored))
    }

    #[inline]
    fn has_smooth_lobe(&self) -> bool {
        self.bsdf.has_smooth_lobe()
    }

    #[inline]
    fn scatters_below(&self) -> bool {
        self.scatters_below
    }

    #[inline]
    fn guiding(&self) -> Guiding {
        if !self.has_smooth_lobe() {
            return Guiding::None;
        }
        match self.bsdf {
            Bsdf::Plain(Model::Diffuse(_)) => Guiding::Alone,
            // What arrives within a narrow lobe is not learned.
            _ => Guiding::Mixed(1.0 / (1.0 + self.shininess() * (1.0 / NARROW))),
        }
    }

    #[inline]
    fn frame(&self, _normal: Vec3) -> Frame {
        self.frame
    }

    #[inline]
    fn look(&self, lane: usize, _normal: Vec3, local: Vec3, samples: &mut BsdfSamples<S>) {
        let value = self.bsdf.evaluate(self.outgoing, local);
        samples.direction.put(lane, self.frame.to_world(local));
        samples.weight[lane] = self.dispersed(value.value, value.is_dispersive);
        samples.pdf[lane] = value.pdf.0;
        samples.refraction[lane] = self.refraction.then(1.0, value.is_dispersive);
    }

    #[inline]
    fn evaluate(
        vertices: &[Self],
        _normals: &VectorLanes<CHUNK>,
        directions: &VectorLanes<CHUNK>,
        values: &mut BsdfValues<S>,
    ) {
        for (lane, vertex) in vertices.iter().enumerate() {
            let incident = vertex.frame.to_local(directions.get(lane));
            let value = vertex.bsdf.evaluate(vertex.outgoing, incident);
            values.value[lane] = vertex.dispersed(value.value, value.is_dispersive);
            values.pdf[lane] = value.pdf.0;
        }
    }

    #[inline]
    fn sample<'a>(
        vertices: impl Iterator<Item = &'a Self>,
        _normals: &VectorLanes<CHUNK>,
        [u, v, w]: &[[f32; CHUNK]; 3],
        samples: &mut BsdfSamples<S>,
    ) {
        for (lane, vertex) in vertices.enumerate() {
            let numbers = [u[lane], v[lane], w[lane]];
            let sample = vertex.bsdf.sample(vertex.outgoing, numbers);
            let direction = vertex.frame.to_world(sample.incident);
            samples.direction.put(lane, direction);
            samples.weight[lane] = vertex.dispersed(sample.weight, sample.is_dispersive);
            samples.pdf[lane] = sample.pdf.0;
            samples.refraction[lane] = vertex.refraction.then(sample.eta, sample.is_dispersive);
        }
    }
}
