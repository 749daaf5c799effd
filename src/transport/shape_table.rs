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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::LoadOptions;

    /// A red rectangle seen from its front alone, a lamp of no bsdf, and a two-sided one with a sphere of the same red; all in a
    /// constant light.
    const SCENE: &str = r#"<scene version="3.0.0">
        <sensor type="perspective"/>
        <bsdf type="diffuse" id="red"><rgb name="reflectance" value="0.5, 0.1, 0.1"/></bsdf>
        <shape type="rectangle"><ref id="red"/></shape>
        <shape type="rectangle"><emitter type="area"><rgb name="radiance" value="1"/></emitter></shape>
        <shape type="rectangle"><bsdf type="twosided">
            <bsdf type="diffuse"><rgb name="reflectance" value="0.25"/></bsdf>
            <ref id="red"/>
        </bsdf></shape>
        <shape type="sphere"><ref id="red"/></shape>
        <emitter type="constant"/>
    </scene>"#;

    #[test]
    fn every_side_has_its_reflectance_and_every_shape_its_emitter() {
        let scene = Scene::from_xml(SCENE, &LoadOptions::default()).unwrap();
        let table = ShapeTable::new(&scene, Some(1));
        let sides = |shape| [1.0, -1.0].map(|cosine| table.entry(shape).reflectance(cosine));
        assert_eq!(sides(0), [Some(0), None]);
        assert_eq!(sides(1), [None, None]);
        assert_eq!(sides(2), [Some(1), Some(0)]);
        assert_eq!(sides(3), [Some(0), None]);
        assert_eq!(sides(4), [None, None]);
        // Edge-on, and where directions are no numbers, there is no side.
        assert_eq!(table.entry(2).reflectance(0.0), None);
        assert_eq!(table.entry(2).reflectance(f32::NAN), None);
        assert_eq!(table.reflectances.curve(1).rgb(), [0.25; 3]);

        let emitters = [0, 1, 2, 3, u32::MAX].map(|shape| table.entry(shape).emitter());
        assert_eq!(emitters, [None, Some(0), None, None, Some(1)]);
    }

    #[test]
    fn triangles_of_all_meshes_have_planes_of_their_own() {
        let scene = Scene::from_xml(SCENE, &LoadOptions::default()).unwrap();
        let table = ShapeTable::new(&scene, None);
        let numbers =
            [0, 1, 2].map(|shape| [0, 1].map(|triangle| table.entry(shape).plane(triangle)));
        assert_eq!(numbers, [[0, 1], [2, 3], [4, 5]]);
        for without in [3, u32::MAX] {
            let plane = table.entry(without).plane(7);
            assert_eq!(plane, Planes::NONE);
            assert_eq!(scene.planes.get(plane), None);
        }
    }
}
