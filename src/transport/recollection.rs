//! What was learned of the particles that a strategy decides about.

use super::batch::{CameraPaths, Vertices};
use super::variant::Variant;
use crate::learning::Knowledge;
use crate::room::resize;
use crate::spectrum::Colour;
use crate::walk::Learned;

/// One entry per particle in every column; see [`Learned`].
#[derive(Default)]
pub(super) struct Recollection {
    mean: Vec<f32>,
    square: Vec<f32>,
    cost: Vec<f32>,
    brightness: Vec<f32>,
}

impl Recollection {
    /// Asks for what is known of every vertex, whose throughput times albedo is `reflected`; `None` before the first lesson.
    pub fn recall<'a, C: Colour, V: Variant>(
        &'a mut self,
        knowledge: &Knowledge,
        paths: &CameraPaths<C>,
        vertices: &Vertices<C, V>,
        reflected: &'a [f32],
    ) -> Option<Learned<'a>> {
        if knowledge.lessons() == 0 {
            return None;
        }
        let Self {
            mean,
            square,
            cost,
            brightness,
        } = self;
        for column in [&mut *mean, square, cost, brightness] {
            resize(column, vertices.len());
        }
        let moments = mean.iter_mut().zip(&mut *square).zip(&mut *cost);
        let places = vertices.insight.iter().enumerate();
        for (((mean, square), cost), (i, &number)) in moments.zip(places) {
            let known = knowledge.moments(number, vertices.lobe(i));
            [*mean, *square, *cost] = [known.mean, known.square, known.cost];
        }
        for (brightness, path) in brightness.iter_mut().zip(&vertices.path) {
            *brightness = paths.brightness[paths.pixel(*path) as usize];
        }
        Some(Learned {
            mean,
            square,
            cost,
            reflected,
            brightness,
            relative_factor: knowledge.pixels().relative_factor(),
            absolute_factor: knowledge.pixels().absolute_factor(),
        })
    }
}
