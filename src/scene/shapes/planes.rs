//! Planes of triangles: all that shading a flat triangle needs, where the ray is known that hit it.

use glam::Vec3;

use super::lanes::SurfaceLanes;
use super::{Geometry, Shape};
use crate::embree;
use crate::lanes::VectorLanes;

/// The plane of a triangle, in a quarter of a cache line: the points p with p · normal = distance.
///
/// Its normal and its distance fit each other to the last place, so a point of the plane is as precise across the surface
/// as one interpolated between the vertices; and nobody has to fetch those, or their indices.
#[repr(C, align(16))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plane {
    /// Unit geometric normal on the outer side, in world space; zero for a triangle without area.
    normal: [f32; 3],
    /// From the origin of world space along the normal, in scene units.
    distance: f32,
}

impl Plane {
    /// The plane of a triangle with these corners in world space. Its outer side is the one from which they lie counterclockwise,
    /// or the other if `flipped`.
    pub fn of(corners: [Vec3; 3], flipped: bool) -> Self {
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        let outward = (b - a).cross(c - a).normalize_or_zero();
        let normal = if flipped { -outward } else { outward }.as_vec3();
        // Of the normal as it was rounded: in the middle it matters least that it was.
        let distance = normal.as_dvec3().dot((a + b + c) / 3.0) as f32;
        Self {
            normal: normal.into(),
            distance,
        }
    }
}

/// The planes of all flat triangles that stand in the world.
#[derive(Debug)]
pub(crate) struct Planes {
    /// Those of a mesh side by side.
    all: Vec<Plane>,
    /// By shape: the number of the first of its planes, [`Planes::NONE`] where it has none.
    first: Vec<u32>,
}

impl Planes {
    /// The number of no plane.
    pub const NONE: u32 = u32::MAX;

    /// The planes of `shapes`, which stand in the world.
    pub fn of(shapes: &[Shape]) -> Self {
        let mut all = Vec::new();
        let first = shapes.iter().map(|shape| {
            let Geometry::Triangles(mesh) = &shape.geometry else {
                return Self::NONE;
            };
            let first = all.len();
            // Beyond that there are no numbers; the triangles are found by their corners.
            if first + mesh.faces().len() >= Self::NONE as usize {
                return Self::NONE;
            }
            match mesh.planes() {
                None => Self::NONE,
                Some(planes) => {
                    all.reserve_exact(planes.len());
                    all.extend(planes);
                    first as u32
                }
            }
        });
        Self {
            first: first.collect(),
            all,
        }
    }

    /// The number of the plane of the first triangle of shape number `shape`; those of its others follow. [`Self::NONE`] where it has
    /// none.
    pub fn first(&self, shape: usize) -> u32 {
        self.first.get(shape).copied().unwrap_or(Self::NONE)
    }

    /// A plane by its number; `None` of [`Self::NONE`].
    #[inline(always)]
    pub fn get(&self, number: u32) -> Option<Plane> {
        self.all.get(number as usize).copied()
    }

    /// Says that a plane will be asked for soon.
    #[inline(always)]
    pub fn prefetch(&self, number: u32) {
        embree::prefetch(&self.all, number);
    }
}

/// The planes of up to `N` triangles.
#[derive(Clone, Debug)]
pub(crate) struct PlaneLanes<const N: usize> {
    normal: VectorLanes<N>,
    distance: [f32; N],
}

impl<const N: usize> Default for PlaneLanes<N> {
    fn default() -> Self {
        Self {
            normal: VectorLanes::default(),
            distance: [0.0; N],
        }
    }
}

impl<const N: usize> PlaneLanes<N> {
    /// Puts a plane into its lane.
    #[inline(always)]
    pub fn put(&mut self, lane: usize, plane: Plane) {
        self.normal.put(lane, plane.normal.into());
        self.distance[lane] = plane.distance;
    }

    /// Sets the points of all lanes; those of lanes without a plane mean nothing. Each is where the ray from `origins` in `directions` is at `t`, moved onto the
    /// plane. All in world space.
    ///
    /// The error of a point on a ray grows with the distance (Wächter and Binder 2019, "A Fast and Robust Method for Avoiding
    /// Self-Intersection"). What of it would matter, for it would lift the point off the surface, is undone here.
    #[inline(always)]
    pub fn find_points(
        &self,
        origins: &VectorLanes<N>,
        directions: &VectorLanes<N>,
        t: &[f32; N],
        points: &mut SurfaceLanes<N>,
    ) {
        for (i, &t) in t.iter().enumerate() {
            let normal = self.normal.get(i);
            let along = origins.get(i) + t * directions.get(i);
            let position = along - (normal.dot(along) - self.distance[i]) * normal;
            points.position.put(i, position);
            points.geometric_normal.put(i, normal);
            points.shading_normal.put(i, normal);
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::scene::shapes::lanes::CornerLanes;

    fn vector(extent: f32) -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(-extent..extent).prop_map(Vec3::from)
    }

    proptest! {
        /// Even of rays from afar, whose own points are a thousandth off.
        #[test]
        fn points_lie_on_the_surface_as_precisely_as_interpolated_ones(
            corners in prop::array::uniform3(vector(1.0)),
            place in vector(10.0),
            (u, v) in (0.0..0.5_f32, 0.0..0.5_f32),
            from in vector(1e4),
            flipped in any::<bool>(),
        ) {
            let corners = corners.map(|corner| corner + place);
            let [a, b, c] = corners.map(Vec3::as_dvec3);
            let normal = (b - a).cross(c - a);
            prop_assume!(normal.length() > 1e-3);
            let normal = normal.normalize();
            let target = a + (b - a) * f64::from(u) + (c - a) * f64::from(v);
            let offset = target.as_vec3() - from;
            let (t, direction) = (offset.length(), offset.normalize());
            prop_assume!(direction.as_dvec3().dot(normal).abs() > 0.1);

            let mut planes = PlaneLanes::<2>::default();
            planes.put(0, Plane::of(corners, flipped));
            let (mut origins, mut directions) = (VectorLanes::default(), VectorLanes::default());
            origins.put(0, from);
            directions.put(0, direction);
            let mut points = SurfaceLanes::<2>::default();
            let mut lanes = CornerLanes::<2>::default();
            lanes.set(0, corners, flipped);
            lanes.interpolate(&[u; 2], &[v; 2], &mut points);
            let interpolated = points.get(0);
            planes.find_points(&origins, &directions, &[t; 2], &mut points);

            let found = points.get(0);
            let height = |point: Vec3| (point.as_dvec3() - a).dot(normal).abs();
            prop_assert!(height(found.position) < 8e-6, "{}", height(found.position));
            prop_assert!((found.position.as_dvec3() - target).length() < 0.1);
            prop_assert!((found.geometric_normal - interpolated.geometric_normal).length() < 1e-3);
            prop_assert_eq!(found.shading_normal, found.geometric_normal);
        }
    }
}
