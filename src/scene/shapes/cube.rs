//! `cube`: the cube [-1, 1]^3, facing outwards before `to_world`.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `flip_normals` | boolean | let it face inwards | false |
//! | `to_world` | transform | any affine transform | identity |

use crate::scene::mesh::MeshData;

/// The cube in its own space, with four vertices of its own for each side so that every side has its own coordinates.
pub(crate) fn cube() -> MeshData {
    let mut mesh = MeshData::default();
    let mut uvs = Vec::new();
    for axis in 0..3 {
        for side in [-1.0_f32, 1.0] {
            let first = mesh.positions.len() as u32;
            for [a, b] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
                // Mirroring the first coordinate on the negative sides keeps every side counter-clockwise from outside.
                let mut position = [0.0; 3];
                position[axis] = side;
                position[(axis + 1) % 3] = a * side;
                position[(axis + 2) % 3] = b;
                mesh.positions.push(position);
                uvs.push([0.5 * (a + 1.0), 0.5 * (b + 1.0)]);
            }
            mesh.triangles.push([first, first + 1, first + 2]);
            mesh.triangles.push([first + 2, first + 3, first]);
        }
    }
    mesh.uvs = Some(uvs);
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn every_side_faces_outwards() {
        let mesh = cube();
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|i| Vec3::from(mesh.positions[i as usize]));
            let normal = (b - a).cross(c - a);
            assert!(normal.dot(a + b + c) > 0.0);
        }
        assert_eq!(mesh.triangles.len(), 12);
    }
}
