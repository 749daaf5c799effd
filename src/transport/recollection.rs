//! What was learned of the particles that a strategy decides about.

use super::batch::{CameraPaths, Vertices};
use super::variant::{Scattering, Variant};
use crate::learning::Knowledge;
use crate::room::make_room;
use crate::spectrum::{Colour, SpectrumArithmetic};
use crate::walk::Learned;

/// One entry per particle in every column; see [`Learned`].
#[derive(Default)]
pub(super) struct Recollection {
    mean: Vec<f32>,
    square: Vec<f32>,
    cost: Vec<f32>,
    reflected: Vec<f32>,
    brightness: Vec<f32>,
}

impl Recollection {
    /// Asks for what is known of every vertex; `None` before the first lesson.
    pub fn recall<C: Colour, V: Variant>(
        &mut self,
        knowledge: &Knowledge,
        paths: &CameraPaths<C>,
        vertices: &Vertices<C, V>,
    ) -> Option<Learned<'_>> {
        if knowledge.lessons() == 0 {
            return None;
        }
        let count = vertices.len();
        for column in [
            &mut self.mean,
            &mut self.square,
            &mut self.cost,
            &mut self.reflected,
            &mut self.brightness,
        ] {
            make_room(column, count);
        }
        for &address in &vertices.address {
            let [mean, square, cost] = match knowledge.insight(address) {
                Some(insight) => [insight.mean, insight.square, insight.cost],
                None => [f32::NAN; 3],
            };
            self.mean.push(mean);
            self.square.push(square);
            self.cost.push(cost);
        }
        let numbers = vertices.throughput.iter().zip(&vertices.bsdf);
        let reflected = |(&throughput, bsdf): (&C::Spectrum, &V::Scattering<C::Spectrum>)| {
            let mut reflected = (throughput * bsdf.albedo()).mean();
            if V::REFRACTS {
                // Light is not less important for being compressed.
                reflected *= bsdf.refraction().squared_index;
            }
            reflected
        };
        self.reflected.extend(numbers.map(reflected));
        let brightness = |&path: &u32| paths.brightness[(path / paths.samples) as usize];
        self.brightness.extend(vertices.path.iter().map(brightness));
        Some(Learned {
            mean: &self.mean,
            square: &self.square,
            cost: &self.cost,
            reflected: &self.reflected,
            brightness: &self.brightness,
            relative_factor: knowledge.pixels().relative_factor(),
            absolute_factor: knowledge.pixels().absolute_factor(),
        })
    }
}
