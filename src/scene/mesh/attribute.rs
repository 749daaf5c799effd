//! What a mesh says of its vertices or faces beside the form, such as a colour.

use std::ops::RangeInclusive;

use crate::spectrum::Reflectances;

/// Something that a mesh says of all vertices or of all faces.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshAttribute {
    /// `vertex_` or `face_` and what the file calls it.
    pub name: String,
    /// Whether it belongs to faces; otherwise it belongs to vertices.
    pub is_of_faces: bool,
    /// Its values, in the order of the vertices or of the triangles.
    pub values: AttributeValues,
}

/// The values of an attribute.
#[derive(Clone, Debug, PartialEq)]
pub enum AttributeValues {
    /// One number each.
    Numbers(Vec<f32>),
    /// A colour each, linear sRGB.
    Colours(Reflectances),
}

impl MeshAttribute {
    /// The value at all points, if there is one; a number has it in all channels.
    pub fn constant(&self) -> Option<[f32; 3]> {
        match &self.values {
            AttributeValues::Numbers(numbers) => only(numbers).map(|number| [number; 3]),
            AttributeValues::Colours(colours) => only(colours.all_rgb()),
        }
    }

    /// The same with the values in another order: number `order[i]` in place i.
    pub fn reordered(&self, order: impl Iterator<Item = usize>) -> Self {
        let values = match &self.values {
            AttributeValues::Numbers(numbers) => {
                AttributeValues::Numbers(order.map(|i| numbers[i]).collect())
            }
            AttributeValues::Colours(colours) => {
                let colours = order.map(|i| colours.rgb(i)).collect();
                AttributeValues::Colours(Reflectances::new(colours))
            }
        };
        Self {
            name: self.name.clone(),
            is_of_faces: self.is_of_faces,
            values,
        }
    }

    /// The first colour component that is not in `range`.
    pub fn colour_outside(&self, range: RangeInclusive<f32>) -> Option<f32> {
        match &self.values {
            AttributeValues::Numbers(_) => None,
            AttributeValues::Colours(colours) => {
                let mut components = colours.all_rgb().iter().flatten().copied();
                components.find(|component| !range.contains(component))
            }
        }
    }
}

/// What all `values` are, if they are the same.
fn only<T: Copy + PartialEq>(values: &[T]) -> Option<T> {
    let (&first, rest) = values.split_first()?;
    rest.iter().all(|&value| value == first).then_some(first)
}
