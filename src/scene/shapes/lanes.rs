//! Surface points of many hits at once, as structures of arrays: their arithmetic is one loop over lanes, which
//! compilers turn into vector instructions.

use glam::Vec3;

use super::SurfacePoint;
use crate::lanes::VectorLanes;

/// What is stored at the three vertices of `N` triangles, in world space.
#[derive(Clone, Debug)]
pub(crate) struct CornerLanes<const N: usize> {
    positions: [VectorLanes<N>; 3],
    /// Those of lanes that are not smooth mean nothing.
    normals: [VectorLanes<N>; 3],
    /// 1 where the mesh has vertex normals, otherwise 0.
    smoothness: [f32; N],
    /// Whether any mesh has.
    any_is_smooth: bool,
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
            smoothness: [0.0; N],
            any_is_smooth: false,
            orientation: [1.0; N],
        }
    }
}

impl<const N: usize> CornerLanes<N> {
    /// Puts a triangle without vertex normals into its lane: its positions, and whether its clockwise side is the outer one.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, positions: [Vec3; 3], flipped: bool) {
        for (lanes, position) in self.positions.iter_mut().zip(positions) {
            lanes.put(lane, position);
        }
        self.orientation[lane] = if flipped { -1.0 } else { 1.0 };
        self.smoothness[lane] = 0.0;
    }

    /// Gives the triangle in a lane unit vertex normals.
    #[inline(always)]
    pub fn set_normals(&mut self, lane: usize, normals: [Vec3; 3]) {
        for (lanes, normal) in self.normals.iter_mut().zip(normals) {
            lanes.put(lane, normal);
        }
        self.smoothness[lane] = 1.0;
        self.any_is_smooth = true;
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
            let geometric = orientation * unit_or(ab.cross(ac), Vec3::ZERO);
            points.position.put(i, a + u[i] * ab + v[i] * ac);
            points.geometric_normal.put(i, geometric);
            points.shading_normal.put(i, geometric);
        }
        if self.any_is_smooth {
            self.interpolate_normals(u, v, points);
        }
    }

    /// The same of the shading normals of smooth meshes.
    #[inline(always)]
    fn interpolate_normals(&self, u: &[f32; N], v: &[f32; N], points: &mut SurfaceLanes<N>) {
        for i in 0..N {
            let [na, nb, nc] = [0, 1, 2].map(|corner| self.normals[corner].get(i));
            let interpolated = na + u[i] * (nb - na) + v[i] * (nc - na);
            // Opposite normals can cancel out; then the true surface decides.
            let signed = self.smoothness[i] * self.orientation[i] * interpolated;
            let shading = unit_or(signed, points.geometric_normal.get(i));
            points.shading_normal.put(i, shading);
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
