//! Drawing points of a mesh that glows.

use glam::Vec3;

use super::{HitCoordinates, SurfacePoint, Triangles};
use crate::embree::Half;
use crate::sampling::{AliasTable, warp};

/// How points of a mesh are drawn uniformly by area.
#[derive(Clone, Debug)]
pub(super) enum MeshSampling {
    /// By triangle, then within the triangle.
    ByTriangle(AliasTable),
    /// The two triangles of a rectangle at once: fewer steps, and the square keeps its neighbourhoods.
    Parallelogram(Parallelogram),
}

/// A flat quadrangle with parallel sides, in world space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parallelogram {
    /// The corner at which both edges begin.
    pub corner: SurfacePoint,
    /// From the corner to one neighbour.
    pub first_edge: Vec3,
    /// From the corner to the other.
    pub second_edge: Vec3,
    /// In squared scene units, positive.
    pub area: f32,
}

impl MeshSampling {
    /// `None` for a mesh whose area is not positive and finite.
    pub fn new(mesh: &Triangles) -> Option<Self> {
        let areas: Vec<f32> = mesh.triangle_areas().collect();
        let by_triangle = AliasTable::new(&areas)?;
        Some(Self::parallelogram(mesh).unwrap_or(Self::ByTriangle(by_triangle)))
    }

    /// For a flat mesh of one pair `a b d`, `c d b` with b - a = c - d.
    fn parallelogram(mesh: &Triangles) -> Option<Self> {
        let [quad] = mesh.faces().quads()[..] else {
            return None;
        };
        if mesh.is_smooth() || mesh.faces().alone() > 0 {
            return None;
        }
        let [a, b, c, d] = quad.map(|i| Vec3::from(mesh.vertices().position(i)));
        let (first_edge, second_edge) = (b - a, d - a);
        let tolerance = 1e-6 * (first_edge.length() + second_edge.length());
        let closes = (first_edge + second_edge - (c - a)).length() <= tolerance;
        closes.then(|| {
            Self::Parallelogram(Parallelogram {
                corner: mesh.point(0, 0.0, 0.0),
                first_edge,
                second_edge,
                area: mesh.area(),
            })
        })
    }

    /// A uniform point of `mesh`, the one that this was made for, from uniform numbers in [0, 1).
    #[inline(always)]
    pub fn sample(&self, mesh: &Triangles, u: [f32; 2]) -> SurfacePoint {
        match *self {
            Self::ByTriangle(_) => mesh.surface(&self.hit(u)),
            Self::Parallelogram(Parallelogram {
                corner,
                first_edge,
                second_edge,
                ..
            }) => SurfacePoint {
                position: corner.position + u[0] * first_edge + u[1] * second_edge,
                ..corner
            },
        }
    }

    /// Where a ray would hit the point that [`Self::sample`] draws from `u`.
    #[inline(always)]
    pub fn hit(&self, u: [f32; 2]) -> HitCoordinates {
        let (primitive, [u, v]) = match self {
            Self::ByTriangle(table) => {
                let chosen = table.sample(u[0]);
                (
                    chosen.index as u32,
                    warp::triangle([chosen.remainder, u[1]]),
                )
            }
            Self::Parallelogram(_) => {
                let half = Half::of(u[0], u[1]);
                (u32::from(half.is_second), [half.u, half.v])
            }
        };
        HitCoordinates {
            primitive,
            u,
            v,
            normal: Vec3::Z,
        }
    }
}
