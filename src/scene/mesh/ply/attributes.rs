//! Attributes in PLY files, by Mitsuba's rules: the properties `NAME_x` or `NAME_x`, `NAME_y`, `NAME_z` are the attribute NAME, `NAME_r` or `NAME_r`,
//! `NAME_g`, `NAME_b` are `NAME_color`, and `r`, `g`, `b` or `red`, `green`, `blue` are `color`.

use super::header::{Element, Kind};
use crate::scene::mesh::{AttributeValues, MeshAttribute, MeshProblem};
use crate::spectrum::Reflectances;

/// An attribute that is being read.
pub(super) struct Column {
    name: String,
    is_of_faces: bool,
    /// The property numbers of its parts: one or three.
    parts: Vec<usize>,
    numbers: Vec<f32>,
}

/// The attributes of an element, vertices or faces, among properties that nothing else takes.
pub(super) fn columns(element: &Element, is_of_faces: bool) -> Vec<Column> {
    let prefix = if is_of_faces { "face_" } else { "vertex_" };
    let column = |name: String, parts: Vec<usize>| Column {
        name: format!("{prefix}{name}"),
        is_of_faces,
        parts,
        numbers: Vec::new(),
    };
    let mut columns = Vec::new();
    for names in [["r", "g", "b"], ["red", "green", "blue"]] {
        if let Some(parts) = super::parts(element, names) {
            columns.push(column("color".to_owned(), parts.to_vec()));
            break;
        }
    }
    for (position, property) in element.properties.iter().enumerate() {
        for (first, others, suffix) in [("_x", ["_y", "_z"], ""), ("_r", ["_g", "_b"], "_color")] {
            let Some(name) = property.name.strip_suffix(first) else {
                continue;
            };
            let find = |ending: &str| element.position(&format!("{name}{ending}"));
            let parts = match others.map(find) {
                [None, None] => vec![position],
                [Some(second), Some(third)] => vec![position, second, third],
                _ => continue,
            };
            let is_scalar =
                |&part: &usize| matches!(element.properties[part].kind, Kind::Scalar(_));
            if parts.iter().all(is_scalar) {
                columns.push(column(format!("{name}{suffix}"), parts));
            }
        }
    }
    columns
}

impl Column {
    /// Takes its parts of the properties `values` of the next vertex, or of a face that became `times` triangles.
    pub fn push(&mut self, values: &[f32], times: usize) -> Result<(), MeshProblem> {
        for _ in 0..times {
            for &part in &self.parts {
                if !values[part].is_finite() {
                    let message = format!("the attribute {} is not finite everywhere", self.name);
                    return Err(MeshProblem::Format(message));
                }
                self.numbers.push(values[part]);
            }
        }
        Ok(())
    }

    /// The attribute, read to its end.
    pub fn finish(self) -> MeshAttribute {
        let values = if self.parts.len() == 1 {
            AttributeValues::Numbers(self.numbers)
        } else {
            let colours = self
                .numbers
                .chunks_exact(3)
                .map(|rgb| [rgb[0], rgb[1], rgb[2]]);
            AttributeValues::Colours(Reflectances::new(colours.collect()))
        };
        MeshAttribute {
            name: self.name,
            is_of_faces: self.is_of_faces,
            values,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::mesh::ply::parse;

    /// `mi.traverse(mi.load_dict({'type': 'ply', …}))` of Mitsuba 3.9.1 has the same attributes.
    #[test]
    fn attributes_have_mitsubas_names() {
        let file = |properties: &str, faces: &str| {
            format!(
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n{properties}\
                 element face 1\nproperty list uchar int vertex_indices\n{faces}end_header\n"
            )
        };
        let vertices = |numbers: usize| {
            let line = |vertex: usize| {
                let numbers = (0..numbers).map(|i| format!(" 0.{}", vertex * numbers + i));
                format!(
                    "{} {} 0{}\n",
                    vertex % 2,
                    vertex / 2,
                    numbers.collect::<String>()
                )
            };
            (0..3).map(line).collect::<String>()
        };
        let colour = "property float r\nproperty float g\nproperty float b\n";
        let words = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
        let vector = "property float foo_x\nproperty float foo_y\nproperty float foo_z\n";
        let pair = "property float foo_x\nproperty float foo_y\n";
        let numbers = "property float foo_x\nproperty float bar_r\n";
        for (properties, count, names) in [
            (colour, 3, vec!["vertex_color"]),
            (vector, 3, vec!["vertex_foo"]),
            (pair, 2, vec![]),
            (numbers, 2, vec!["vertex_foo", "vertex_bar_color"]),
            ("property float quality\n", 1, vec![]),
        ] {
            let text = file(properties, "") + &vertices(count) + "3 0 1 2\n";
            let mesh = parse(text.as_bytes()).unwrap();
            let found: Vec<&str> = mesh.attributes.iter().map(|a| a.name.as_str()).collect();
            assert_eq!(found, names, "{properties}");
        }
        let text = file("", words) + &vertices(0) + "3 0 1 2 1 0 1\n";
        let mesh = parse(text.as_bytes()).unwrap();
        let [face] = &mesh.attributes[..] else {
            panic!("{:?}", mesh.attributes);
        };
        assert!(face.is_of_faces && face.name == "face_color");
        let AttributeValues::Colours(colours) = &face.values else {
            panic!("{face:?}");
        };
        assert_eq!(colours.all_rgb(), [[1.0, 0.0, 1.0]]);
    }

    /// A polygon's attribute is that of all of its triangles.
    #[test]
    fn polygons_share_theirs_among_triangles() {
        let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
                    property list uchar int vertex_indices\nproperty float id_x\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 0.5\n";
        let mesh = parse(text.as_bytes()).unwrap();
        let values = AttributeValues::Numbers(vec![0.5; 2]);
        assert_eq!(
            (mesh.triangles.len(), &mesh.attributes[0].values),
            (2, &values)
        );
    }
}
