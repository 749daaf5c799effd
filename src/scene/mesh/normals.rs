//! Smooth vertex normals for meshes that have none.

use glam::Vec3;

/// One unit normal for each of `positions`: the mean of the normals of its triangles, weighted by their angles there
/// (Thürmer and Wüthrich, "Computing Vertex Normals from Polygonal Facets", Journal of Graphics Tools 3(1), 1998).
///
/// This is what Mitsuba 3 computes, on positions in *world* space and also in single precision: triangles without
/// area have no part, and where nothing is left the normal is (1, 0, 0).
pub fn smooth_normals(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Vec<[f32; 3]> {
    let mut sums = vec![Vec3::ZERO; positions.len()];
    for triangle in triangles {
        let corners = triangle.map(|index| Vec3::from_array(positions[index as usize]));
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let squared_length = normal.length_squared();
        if squared_length <= 0.0 {
            continue;
        }
        let normal = normal / squared_length.sqrt();
        for i in 0..3 {
            let to_next = (corners[(i + 1) % 3] - corners[i]).normalize();
            let to_previous = (corners[(i + 2) % 3] - corners[i]).normalize();
            sums[triangle[i] as usize] += normal * angle_between(to_next, to_previous);
        }
    }
    let unit = |sum: Vec3| match sum.length() {
        length if length > 0.0 => (sum / length).to_array(),
        _ => [1.0, 0.0, 0.0],
    };
    sums.into_iter().map(unit).collect()
}

/// The angle between two unit vectors, in radians, exact also where the arc cosine is not
/// (Kahan, "How Futile are Mindless Assessments of Roundoff in Floating-Point Computation?", 2006, section 12).
fn angle_between(a: Vec3, b: Vec3) -> f32 {
    if a.dot(b) < 0.0 {
        std::f32::consts::PI - 2.0 * (0.5 * (a + b).length()).min(1.0).asin()
    } else {
        2.0 * (0.5 * (a - b).length()).min(1.0).asin()
    }
}
