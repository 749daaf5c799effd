//! Surface points of many hits at once, as structures of arrays: their arithmetic is one loop over lanes, which
//! compilers turn into vector instructions.

use glam::Vec3;

use super::SurfacePoint;

/// `N` vectors: all x, all y, all z.
pub(crate) type VectorLanes<const N: usize> = [[f32; N]; 3];

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
    position: VectorLanes<N>,
    geometric_normal: VectorLanes<N>,
    shading_normal: VectorLanes<N>,
}

impl<const N: usize> Default for CornerLanes<N> {
    fn default() -> Self {
        Self {
            positions: [[[0.0; N]; 3]; 3],
            normals: [[[0.0; N]; 3]; 3],
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
            put(&mut self.positions[corner], lane, positions[corner]);
            put(&mut self.normals[corner], lane, normals[corner]);
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
            let [a, b, c] = [0, 1, 2].map(|corner| get(&self.positions[corner], i));
            let (ab, ac) = (b - a, c - a);
            let orientation = self.orientation[i];
            let geometric = unit_or(ab.cross(ac), Vec3::ZERO);
            let [na, nb, nc] = [0, 1, 2].map(|corner| get(&self.normals[corner], i));
            // Opposite normals can cancel out; then the true surface decides.
            let shading = unit_or(na + u[i] * (nb - na) + v[i] * (nc - na), geometric);
            put(&mut points.position, i, a + u[i] * ab + v[i] * ac);
            put(&mut points.geometric_normal, i, orientation * geometric);
            put(&mut points.shading_normal, i, orientation * shading);
        }
    }
}

impl<const N: usize> Default for SurfaceLanes<N> {
    fn default() -> Self {
        Self {
            position: [[0.0; N]; 3],
            geometric_normal: [[0.0; N]; 3],
            shading_normal: [[0.0; N]; 3],
        }
    }
}

impl<const N: usize> SurfaceLanes<N> {
    /// The point in a lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> SurfacePoint {
        SurfacePoint {
            position: get(&self.position, lane),
            geometric_normal: get(&self.geometric_normal, lane),
            shading_normal: get(&self.shading_normal, lane),
        }
    }

    /// Puts a point into its lane.
    #[inline]
    pub fn set(&mut self, lane: usize, point: &SurfacePoint) {
        put(&mut self.position, lane, point.position);
        put(&mut self.geometric_normal, lane, point.geometric_normal);
        put(&mut self.shading_normal, lane, point.shading_normal);
    }
}

#[inline(always)]
fn get<const N: usize>(lanes: &VectorLanes<N>, lane: usize) -> Vec3 {
    Vec3::new(lanes[0][lane], lanes[1][lane], lanes[2][lane])
}

#[inline(always)]
fn put<const N: usize>(lanes: &mut VectorLanes<N>, lane: usize, vector: Vec3) {
    lanes[0][lane] = vector.x;
    lanes[1][lane] = vector.y;
    lanes[2][lane] = vector.z;
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
