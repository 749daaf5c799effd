//! Drawing points of a mesh that glows.

use glam::Vec3;

use super::{HitCoordinates, SurfacePoint, Triangles};
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

    /// For a flat mesh `a b c`, `c d a` with a - b = d - c.
    fn parallelogram(mesh: &Triangles) -> Option<Self> {
        let [first, second] = mesh.indices()[..] else {
            return None;
        };
        let shares_diagonal = first[0] == second[2] && first[2] == second[0];
        if mesh.is_smooth() || !shares_diagonal {
            return None;
        }
        let [a, b, c, d] = [first[0], first[1], first[2], second[1]]
            .map(|i| Vec3::from(mesh.vertices().position(i)));
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
            // The triangles `a b c` and `c d a`.
            Self::Parallelogram(_) if u[1] <= u[0] => (0, [u[0] - u[1], u[1]]),
            Self::Parallelogram(_) => (1, [u[1] - u[0], 1.0 - u[1]]),
        };
        HitCoordinates {
            primitive,
            u,
            v,
            normal: Vec3::Z,
        }
    }
}
