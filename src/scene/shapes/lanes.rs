//! Surface points of many hits at once, as structures of arrays: their arithmetic is one loop over lanes, which
//! compilers turn into vector instructions.

use glam::Vec3;

use super::SurfacePoint;
use crate::lanes::VectorLanes;

/// What is stored at the three vertices of `N` triangles, in world space.
#[derive(Clone, Debug)]
pub(crate) struct CornerLanes<const N: usize> {
    positions: [VectorLanes<N>; 3],
    /// Zero where the mesh has none.
    normals: [VectorLanes<N>; 3],
    /// 1 where the counterclockwise side of the triangle is the outer one, otherwise -1.
    orientation: [f32; N],
}

/// `N` points of surfaces; see [`SurfacePoint`].
#[derive(Clone, Debug)]
pub(crate) struct SurfaceLanes<const N: usize> {
    pub position: VectorLanes<N>,
    pub geometric_normal: VectorLanes<N>,
    pub shading_normal: VectorLanes<N>,
}

impl<const N: usize> Default for CornerLanes<N> {
    fn default() -> Self {
        Self {
            positions: [VectorLanes::default(); 3],
            normals: [VectorLanes::default(); 3],
            orientation: [1.0; N],
        }
    }
}

impl<const N: usize> CornerLanes<N> {
    /// Puts a triangle into its lane: positions, unit normals (zero without vertex normals), and whether its clockwise side is
    /// the outer one.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, positions: [Vec3; 3], normals: [Vec3; 3], flipped: bool) {
        for corner in 0..3 {
            self.positions[corner].put(lane, positions[corner]);
            self.normals[corner].put(lane, normals[corner]);
        }
        self.orientation[lane] = if flipped { -1.0 } else { 1.0 };
    }

    /// The points at barycentric coordinates `u` of the second and `v` of the third vertices. Lanes that were not set have
    /// meaningless points.
    ///
    /// Interpolating the corners is more precise than going along the ray, whose error grows with the distance
    /// (Wächter and Binder 2019, "A Fast and Robust Method for Avoiding Self-Intersection").
    #[inline(always)]
    pub fn interpolate(&self, u: &[f32; N], v: &[f32; N], points: &mut SurfaceLanes<N>) {
        for i in 0..N {
            let [a, b, c] = [0, 1, 2].map(|corner| self.positions[corner].get(i));
            let (ab, ac) = (b - a, c - a);
            let orientation = self.orientation[i];
            let geometric = unit_or(ab.cross(ac), Vec3::ZERO);
            let [na, nb, nc] = [0, 1, 2].map(|corner| self.normals[corner].get(i));
            // Opposite normals can cancel out; then the true surface decides.
            let shading = unit_or(na + u[i] * (nb - na) + v[i] * (nc - na), geometric);
            points.position.put(i, a + u[i] * ab + v[i] * ac);
            points.geometric_normal.put(i, orientation * geometric);
            points.shading_normal.put(i, orientation * shading);
        }
    }
}

impl<const N: usize> Default for SurfaceLanes<N> {
    fn default() -> Self {
        Self {
            position: VectorLanes::default(),
            geometric_normal: VectorLanes::default(),
            shading_normal: VectorLanes::default(),
        }
    }
}

impl<const N: usize> SurfaceLanes<N> {
    /// The point in a lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> SurfacePoint {
        SurfacePoint {
            position: self.position.get(lane),
            geometric_normal: self.geometric_normal.get(lane),
            shading_normal: self.shading_normal.get(lane),
        }
    }

    /// Puts a point into its lane.
    #[inline]
    pub fn set(&mut self, lane: usize, point: &SurfacePoint) {
        self.position.put(lane, point.position);
        self.geometric_normal.put(lane, point.geometric_normal);
        self.shading_normal.put(lane, point.shading_normal);
    }
}

/// `vector` with length 1, or `otherwise` where it has none: chosen without a branch.
#[inline(always)]
fn unit_or(vector: Vec3, otherwise: Vec3) -> Vec3 {
    let reciprocal = 1.0 / vector.length_squared().sqrt();
    let has_length = reciprocal.is_finite() & (reciprocal > 0.0);
    let choose = |one: f32, other: f32| if has_length { one } else { other };
    Vec3::new(
        choose(vector.x * reciprocal, otherwise.x),
        choose(vector.y * reciprocal, otherwise.y),
        choose(vector.z * reciprocal, otherwise.z),
    )
}
