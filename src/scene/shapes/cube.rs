//! `cube`: the cube [-1, 1]^3, facing outwards before `to_world`.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `flip_normals` | boolean | let it face inwards | false |
//! | `to_world` | transform | any affine transform | identity |

use crate::scene::mesh::MeshData;

/// The cube in its own space, with four vertices of its own for each side so that every side has its own coordinates.
pub(crate) fn cube() -> MeshData {
    // Four corners of every side, counter-clockwise from outside: Mitsuba's order, which texture coordinates follow.
    const SIDES: [[[f32; 3]; 4]; 6] = [
        [
            [1.0, -1.0, -1.0],
            [1.0, -1.0, 1.0],
            [-1.0, -1.0, 1.0],
            [-1.0, -1.0, -1.0],
        ],
        [
            [1.0, 1.0, -1.0],
            [-1.0, 1.0, -1.0],
            [-1.0, 1.0, 1.0],
            [1.0, 1.0, 1.0],
        ],
        [
            [1.0, -1.0, -1.0],
            [1.0, 1.0, -1.0],
            [1.0, 1.0, 1.0],
            [1.0, -1.0, 1.0],
        ],
        [
            [1.0, -1.0, 1.0],
            [1.0, 1.0, 1.0],
            [-1.0, 1.0, 1.0],
            [-1.0, -1.0, 1.0],
        ],
        [
            [-1.0, -1.0, 1.0],
            [-1.0, 1.0, 1.0],
            [-1.0, 1.0, -1.0],
            [-1.0, -1.0, -1.0],
        ],
        [
            [1.0, 1.0, -1.0],
            [1.0, -1.0, -1.0],
            [-1.0, -1.0, -1.0],
            [-1.0, 1.0, -1.0],
        ],
    ];
    const UVS: [[f32; 2]; 4] = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let firsts = (0..24).step_by(4);
    MeshData {
        attributes: Vec::new(),
        positions: SIDES.concat(),
        normals: None,
        uvs: Some(UVS.repeat(SIDES.len())),
        triangles: firsts
            .flat_map(|i| [[i, i + 1, i + 2], [i + 3, i, i + 2]])
            .collect(),
    }
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
