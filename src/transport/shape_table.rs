//! What every path asks of the shape that it meets, in a few bytes of each: shapes and materials themselves are large, and
//! hits lie scattered over them.

use super::colour_table::ColourTable;
use crate::scene::{Planes, Scene, Shape, Side};

/// A path of a bright scene meets about as many surfaces.
const MOST_REFLECTANCES: usize = 4;

/// All shapes of a scene as arriving paths see them first.
pub(super) struct ShapeTable {
    entries: Vec<ShapeEntry>,
    /// What a miss is seen as.
    miss: ShapeEntry,
    /// The reflectances of matte surfaces.
    pub reflectances: ColourTable,
}

/// A shape as arriving paths see it first.
#[derive(Clone, Copy)]
pub(super) struct ShapeEntry {
    /// The number of the plane of its first triangle; [`Planes::NONE`] where it has none.
    first_plane: u32,
    /// The emitter that it is, or [`Self::NONE`].
    emitter: u32,
    /// By side, front and back: the number of its reflectance, or [`Self::NONE`] where it reflects nothing, or not the same at every
    /// point in all directions.
    reflectances: [u32; 2],
}

impl ShapeEntry {
    const NONE: u32 = u32::MAX;

    /// The number of the plane of a triangle, [`Planes::NONE`] where it has none.
    #[inline(always)]
    pub fn plane(&self, triangle: u32) -> u32 {
        self.first_plane.saturating_add(triangle)
    }

    /// The emitter that a path finds here; the surroundings where it misses all shapes.
    #[inline(always)]
    pub fn emitter(&self) -> Option<usize> {
        (self.emitter != Self::NONE).then_some(self.emitter as usize)
    }

    /// The number of the diffuse reflectance of the side that is seen with this cosine, where it has one.
    #[inline(always)]
    pub fn reflectance(&self, cosine: f32) -> Option<usize> {
        let [front, back] = self.reflectances;
        let other = if cosine < 0.0 { back } else { Self::NONE };
        let number = if cosine > 0.0 { front } else { other };
        (number != Self::NONE).then_some(number as usize)
    }
}

impl ShapeTable {
    /// The table of a scene in which what leaves it finds the emitter `surroundings`.
    pub fn new(scene: &Scene, surroundings: Option<usize>) -> Self {
        let mut reflectances = ColourTable::new(MOST_REFLECTANCES);
        let mut number_of = |reflectance| reflectances.number_of(reflectance) as u32;
        // Many shapes may share a material.
        let materials = scene.materials.iter().map(|material| {
            [Side::Front, Side::Back].map(|side| {
                let reflectance = material.matte(side);
                let bright = reflectance.filter(|reflectance| !reflectance.is_black());
                bright.map_or(ShapeEntry::NONE, &mut number_of)
            })
        });
        let of_materials: Vec<[u32; 2]> = materials.collect();
        let entry = |(index, shape): (usize, &Shape)| ShapeEntry {
            first_plane: scene.planes.first(index),
            emitter: shape.emitter.map_or(ShapeEntry::NONE, |emitter| emitter.0),
            reflectances: of_materials[shape.material.index()],
        };
        Self {
            entries: scene.shapes.iter().enumerate().map(entry).collect(),
            miss: ShapeEntry {
                first_plane: Planes::NONE,
                emitter: surroundings.map_or(ShapeEntry::NONE, |emitter| emitter as u32),
                reflectances: [ShapeEntry::NONE; 2],
            },
            reflectances,
        }
    }

    /// The shape that a hit's geometry number names, or a miss.
    #[inline(always)]
    pub fn entry(&self, geometry: u32) -> &ShapeEntry {
        self.entries.get(geometry as usize).unwrap_or(&self.miss)
    }
}
