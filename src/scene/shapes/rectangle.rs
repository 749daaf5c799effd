//! `rectangle`: the square [-1, 1] x [-1, 1] in the plane z = 0, facing +z before `to_world`.
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `flip_normals` | boolean | let it face the other way | false |
//! | `to_world` | transform | any affine transform | identity |

use crate::scene::mesh::MeshData;

/// The rectangle in its own space. Its triangles meet where the first corner is not, so that a lamp's points are drawn from the square of its
/// texture coordinates.
pub(crate) fn rectangle() -> MeshData {
    MeshData {
        attributes: Vec::new(),
        positions: vec![
            [-1.0, -1.0, 0.0],
            [1.0, -1.0, 0.0],
            [1.0, 1.0, 0.0],
            [-1.0, 1.0, 0.0],
        ],
        normals: None,
        uvs: Some(vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]),
        triangles: vec![[0, 1, 3], [2, 3, 1]],
    }
}
