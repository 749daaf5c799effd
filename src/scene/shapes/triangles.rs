//! Triangle meshes in world space, as rays and lights need them.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{Vec2, Vec3};

use super::faces::Faces;
use super::lanes::{CornerLanes, SurfaceLanes};
use super::mesh_sampling::{MeshSampling, Parallelogram};
use super::{AttributesAt, HitCoordinates, Plane, ShapeSample, SurfaceParameters, SurfacePoint};
use crate::embree::VertexBuffer;
use crate::sampling::Frame;
use crate::scene::mesh::MeshAttribute;
use crate::scene::mesh::pairing::{self, Corner};

/// A triangle mesh in world space. Its buffers are shared with the intersection layer, not copied.
#[derive(Debug)]
pub struct Triangles {
    vertices: Arc<VertexBuffer>,
    faces: Faces,
    attributes: TriangleAttributes,
    area: f32,
    /// Made only for meshes that emit.
    sampling: Option<MeshSampling>,
}

/// What a mesh is beside vertices and indices.
#[derive(Clone, Debug)]
pub struct TriangleAttributes {
    /// Where textures lie.
    pub coordinates: TextureCoordinates,
    /// What else is said of vertices and triangles.
    pub named: Vec<MeshAttribute>,
    /// Whether the clockwise side of the triangles is the outer one.
    pub flip_normals: bool,
}

/// Where a texture lies on a mesh.
#[derive(Clone, Debug)]
pub enum TextureCoordinates {
    /// The mesh says so of its vertices.
    OfVertices(Vec<[f32; 2]>),
    /// The mesh says nothing: the vertices of each triangle, as the mesh was written, are at (0, 0), (1, 0) and (0, 1), as in Mitsuba.
    /// By triangle: which of these, 0, 1 or 2, its first corner is now.
    OfTriangles(Vec<u8>),
}

impl TextureCoordinates {
    /// Those of a mesh that has none of its own, whose triangles begin at these corners of theirs.
    pub(super) fn of_triangles(beginnings: &[Corner]) -> Self {
        let turned = beginnings.iter().map(|&corner| pairing::place(corner));
        Self::OfTriangles(turned.collect())
    }

    /// Those of the corners of a triangle.
    fn at(&self, triangle: u32, corners: [u32; 3]) -> [Vec2; 3] {
        match self {
            Self::OfVertices(all) => corners.map(|vertex| all[vertex as usize].into()),
            Self::OfTriangles(turned) => {
                let mut written = [Vec2::ZERO, Vec2::X, Vec2::Y];
                written.rotate_left(turned[triangle as usize].into());
                written
            }
        }
    }
}

impl Triangles {
    /// Triangles in world space that say these things of themselves.
    pub(super) fn new(
        vertices: VertexBuffer,
        faces: Faces,
        attributes: TriangleAttributes,
    ) -> Self {
        let areas = triangle_areas(&vertices, &faces).map(f64::from);
        let area = areas.sum::<f64>() as f32;
        Self {
            vertices: Arc::new(vertices),
            faces,
            attributes,
            area,
            sampling: None,
        }
    }

    /// The planes of the triangles, if the mesh is shaded flat.
    pub(super) fn planes(&self) -> Option<impl ExactSizeIterator<Item = Plane>> {
        let VertexBuffer::Flat(vertices) = &*self.vertices else {
            return None;
        };
        let flipped = self.attributes.flip_normals;
        Some(self.faces.iter().map(move |triangle| {
            let corners = triangle.map(|corner| vertices[corner as usize].position.into());
            Plane::of(corners, flipped)
        }))
    }

    /// Makes the mesh ready for `sample`. Returns whether it can be: its area must be positive and finite.
    pub fn prepare_sampling(&mut self) -> bool {
        self.sampling = MeshSampling::new(self);
        self.sampling.is_some()
    }

    /// The parallelogram that it is, if it is one and was made ready for sampling.
    pub(super) fn parallelogram(&self) -> Option<Parallelogram> {
        match &self.sampling {
            Some(MeshSampling::Parallelogram(parallelogram)) => Some(*parallelogram),
            Some(MeshSampling::ByTriangle(_)) | None => None,
        }
    }

    /// The vertices, in world space.
    pub fn vertices(&self) -> &Arc<VertexBuffer> {
        &self.vertices
    }

    /// The triangles.
    pub fn faces(&self) -> &Faces {
        &self.faces
    }

    /// Keeps of the named attributes those that are among `names`; the first of the names that there is nothing of is an error.
    pub(in crate::scene) fn keep_attributes<'n>(
        &mut self,
        names: &[&'n str],
    ) -> Result<(), &'n str> {
        let named = &mut self.attributes.named;
        named.retain(|attribute| names.contains(&attribute.name.as_str()));
        match names
            .iter()
            .find(|&&name| named.iter().all(|found| found.name != name))
        {
            Some(missing) => Err(missing),
            None => Ok(()),
        }
    }

    /// What it says everywhere of the named attributes that are the same at all points, by name.
    pub(super) fn constant_attributes(&self) -> HashMap<String, [f32; 3]> {
        let named = self.attributes.named.iter();
        let constant = named.filter_map(|attribute| Some((attribute, attribute.constant()?)));
        constant
            .map(|(attribute, constant)| (attribute.name.clone(), constant))
            .collect()
    }

    /// The named attributes.
    pub(in crate::scene) fn named_attributes(&self) -> &[MeshAttribute] {
        &self.attributes.named
    }

    /// Whether the mesh is shaded with vertex normals.
    pub fn is_smooth(&self) -> bool {
        matches!(*self.vertices, VertexBuffer::Smooth(_))
    }

    #[inline]
    pub(super) fn surface(&self, hit: &HitCoordinates) -> SurfacePoint {
        self.point(hit.primitive, hit.u, hit.v)
    }

    /// The point of a triangle at barycentric coordinates of its second and third vertex.
    #[inline]
    pub(super) fn point(&self, triangle: u32, u: f32, v: f32) -> SurfacePoint {
        let (mut corners, mut points) = (CornerLanes::<1>::default(), SurfaceLanes::<1>::default());
        self.fetch(self.corners(triangle), &mut corners, 0);
        corners.interpolate(&[u], &[v], &mut points);
        points.get(0)
    }

    /// Where a hit lies in the texture coordinates.
    pub(super) fn parameters(
        &self,
        hit: &HitCoordinates,
        point: &SurfacePoint,
    ) -> SurfaceParameters<'_> {
        let corners = self.corners(hit.primitive);
        let [a, b, c] = corners.map(|i| Vec3::from(self.vertices.position(i)));
        let (ab, ac) = (b - a, c - a);
        let geometric_normal = point.geometric_normal;
        let named = &self.attributes.named;
        let attributes = (!named.is_empty()).then(|| AttributesAt {
            attributes: named,
            triangle: hit.primitive,
            corners,
            barycentric: [hit.u, hit.v],
        });
        let [uv_a, uv_b, uv_c] = self.attributes.coordinates.at(hit.primitive, corners);
        let (uv_ab, uv_ac) = (uv_b - uv_a, uv_c - uv_a);
        let uv = uv_a + uv_ab * hit.u + uv_ac * hit.v;
        let determinant = uv_ab.perp_dot(uv_ac);
        let (dp_du, dp_dv) = if determinant == 0.0 {
            // The coordinates say nothing of directions.
            let frame = Frame::about(geometric_normal);
            (frame.tangent, frame.bitangent)
        } else {
            (
                (ab * uv_ac.y - ac * uv_ab.y) / determinant,
                (ac * uv_ab.x - ab * uv_ac.x) / determinant,
            )
        };
        SurfaceParameters {
            uv,
            dp_du,
            dp_dv,
            geometric_normal,
            attributes,
        }
    }

    /// The vertices of a triangle. Together with [`Self::fetch`] and [`CornerLanes::interpolate`] this is [`Self::point`]
    /// in three steps, so that a batch can take each step for many hits at once and does not wait for the memory of one
    /// after the other.
    #[inline]
    pub(crate) fn corners(&self, triangle: u32) -> [u32; 3] {
        self.faces.corners(triangle)
    }

    /// Says that [`Self::corners`] of a triangle will be asked for soon.
    #[inline(always)]
    pub(crate) fn prefetch_corners(&self, triangle: u32) {
        self.faces.prefetch(triangle);
    }

    /// Says that [`Self::fetch`] will be asked for soon.
    #[inline(always)]
    pub(crate) fn prefetch_vertices(&self, corners: [u32; 3]) {
        for corner in corners {
            self.vertices.prefetch(corner);
        }
    }

    /// Puts what is stored at the vertices of a triangle into a lane.
    #[inline(always)]
    pub(crate) fn fetch<const N: usize>(
        &self,
        corners: [u32; 3],
        lanes: &mut CornerLanes<N>,
        lane: usize,
    ) {
        let is_flipped = self.attributes.flip_normals;
        match &*self.vertices {
            VertexBuffer::Flat(vertices) => {
                let corners = corners.map(|corner| vertices[corner as usize].position.into());
                lanes.set(lane, corners, is_flipped);
            }
            VertexBuffer::Smooth(vertices) => {
                let corners = corners.map(|corner| &vertices[corner as usize]);
                let positions = corners.map(|corner| corner.position.into());
                lanes.set(lane, positions, is_flipped);
                lanes.set_normals(lane, corners.map(|corner| corner.normal.into()));
            }
        }
    }

    pub(super) fn area(&self) -> f32 {
        self.area
    }

    pub(super) fn triangle_areas(&self) -> impl Iterator<Item = f32> {
        triangle_areas(&self.vertices, &self.faces)
    }

    #[inline(always)]
    pub(super) fn sample(&self, reference: Vec3, u: [f32; 2]) -> ShapeSample {
        let point = match &self.sampling {
            Some(sampling) => sampling.sample(self, u),
            // A mesh that was never prepared is no light, and nobody samples it.
            None => self.point(0, u[0], u[1] * (1.0 - u[0])),
        };
        ShapeSample::by_area(reference, point, self.area)
    }

    /// Where a ray would hit the point that [`Self::sample`] draws from `u`.
    pub(super) fn hit_of_sample(&self, u: [f32; 2]) -> HitCoordinates {
        match &self.sampling {
            Some(sampling) => sampling.hit(u),
            None => HitCoordinates {
                primitive: 0,
                u: u[0],
                v: u[1] * (1.0 - u[0]),
                normal: Vec3::Z,
            },
        }
    }
}

fn triangle_areas(vertices: &VertexBuffer, faces: &Faces) -> impl Iterator<Item = f32> {
    faces.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|i| Vec3::from(vertices.position(i)));
        0.5 * (b - a).cross(c - a).length()
    })
}
