//! A bsdf of any kind where a path has met it, in a frame of its own.

use glam::Vec3;

use super::variant::{Arrival, Guiding};
use crate::sampling::{Frame, Sampler};
use crate::scene::{
    Bsdf, BsdfSample, BsdfValue, Diffuse, DirectionNumbers, Model, Refraction, SeenPoint,
    SurfaceParameters,
};
use crate::spectrum::{Colour, SpectrumArithmetic};

/// The shininess of lobes as narrow as what is told apart where light is learned.
const NARROW: f32 = 8.0;

/// See the module. Directions are unit vectors in world space.
#[derive(Clone, Copy, Debug)]
pub(super) struct Framed<S> {
    /// The shading frame of the side that was hit.
    frame: Frame,
    /// Unit direction to where the path comes from, in that frame.
    outgoing: Vec3,
    bsdf: Bsdf<S>,
    /// See [`Material::scatters_below`](crate::scene::Material::scatters_below).
    pub scatters_below: bool,
    /// What refraction has done to the path.
    pub refraction: Refraction,
}

impl<S: SpectrumArithmetic> Framed<S> {
    /// That of the surface at which a path arrives; `None` where it is black.
    #[inline(always)]
    pub fn at<C: Colour<Spectrum = S>>(
        arrival: &Arrival<C>,
        sampler: &mut Sampler,
    ) -> Option<Self> {
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

    /// What it is where it reflects diffusely, and nothing else.
    #[inline(always)]
    pub fn matte(&self) -> Option<&Diffuse<S>> {
        match &self.bsdf {
            Bsdf::Plain(Model::Diffuse(diffuse)) => Some(diffuse),
            _ => None,
        }
    }

    #[inline]
    pub fn albedo(&self) -> S {
        self.bsdf.albedo(self.outgoing)
    }

    #[inline]
    pub fn shininess(&self) -> f32 {
        self.bsdf.shininess(self.outgoing)
    }

    #[inline]
    pub fn has_smooth_lobe(&self) -> bool {
        self.bsdf.has_smooth_lobe()
    }

    /// The direction in which a mirror would send on the path, if what the surface does with it depends on where it comes from.
    #[inline]
    pub fn lobe(&self) -> Option<Vec3> {
        let Vec3 { x, y, z } = self.outgoing;
        let mirrored = Vec3::new(-x, -y, z);
        (self.shininess() > 0.0).then(|| self.frame.to_world(mirrored))
    }

    /// What is made of what was learned when the directions of children are drawn.
    #[inline]
    pub fn guiding(&self) -> Guiding {
        let lobes = self.bsdf.lobes(self.outgoing);
        // What arrives within a narrow lobe is not learned.
        let reach = || 1.0 / (1.0 + self.shininess() * (1.0 / NARROW));
        Guiding {
            diffuse: lobes.diffuse,
            reach: if lobes.has_glossy { reach() } else { 0.0 },
        }
    }

    /// The smooth lobes for light that arrives from `direction`.
    #[inline]
    pub fn evaluate(&self, direction: Vec3) -> BsdfValue<S> {
        let incident = self.frame.to_local(direction);
        let value = self.bsdf.evaluate(self.outgoing, incident);
        BsdfValue {
            value: self.dispersed(value.value, value.is_dispersive),
            ..value
        }
    }

    /// See [`Bsdf::slope_view`].
    #[inline]
    pub fn slope_view(&self) -> Option<f32> {
        self.bsdf.slope_view(self.outgoing)
    }

    /// Draws an incident direction, which is in world space; diffuse lobes take the direction `diffuse`.
    #[inline]
    pub fn sample(&self, numbers: &DirectionNumbers, diffuse: Vec3) -> BsdfSample<S> {
        let numbers = numbers.with_diffuse(self.frame.to_local(diffuse));
        let sample = self.bsdf.sample(self.outgoing, &numbers);
        BsdfSample {
            incident: self.frame.to_world(sample.incident),
            weight: self.dispersed(sample.weight, sample.is_dispersive),
            ..sample
        }
    }

    /// What is left of `spectrum` on a path that wavelengths leave in different directions.
    #[inline]
    fn dispersed(&self, spectrum: S, is_dispersive: bool) -> S {
        if is_dispersive && !self.refraction.is_single {
            spectrum.only_hero()
        } else {
            spectrum
        }
    }
}
