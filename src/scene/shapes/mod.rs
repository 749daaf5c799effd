//! Shapes: what rays can hit, in world space, or in the space of the group that they belong to.
//!
//! Triangle meshes are intersected by Embree itself; spheres, disks and cylinders are exact and bring their own
//! intersection. Every shape can also be sampled by area (or better), so that every shape can be a light.

mod cube;
mod cylinder;
mod disk;
mod drawn;
mod extent;
mod faces;
mod instance;
mod lanes;
mod mesh_file;
mod mesh_sampling;
mod parameters;
mod placed_mesh;
mod planes;
mod rectangle;
mod shape_group;
mod sphere;
mod triangles;

pub use cylinder::{Cylinder, CylinderHit};
pub use disk::{Disk, DiskHit};
pub use faces::Faces;
pub use instance::Instance;
pub(crate) use lanes::{CornerLanes, SurfaceLanes};
pub(crate) use mesh_sampling::Parallelogram;
pub use parameters::{AttributesAt, SurfaceParameters};
use planes::Plane;
pub(crate) use planes::{PlaneLanes, Planes};
pub use shape_group::ShapeGroup;
pub use sphere::Sphere;
pub use triangles::{TextureCoordinates, TriangleAttributes, Triangles};

use std::collections::HashMap;

use glam::{DMat3, DMat4, Vec3};

use self::extent::FARTHEST;
use super::error::SceneError;
use super::load::Loader;
use super::xml::Object;
use super::{EmitterId, MaterialId};
use crate::embree::VertexBuffer;
use crate::sampling::SolidAnglePdf;

const SUPPORTED: [&str; 10] = [
    "obj",
    "ply",
    "serialized",
    "rectangle",
    "cube",
    "sphere",
    "disk",
    "cylinder",
    "shapegroup",
    "instance",
];

/// The form of a shape of a scene file.
pub(super) fn load(object: &Object, loader: &mut Loader) -> Result<Geometry, SceneError> {
    let to_world = object.transform("to_world")?.unwrap_or(DMat4::IDENTITY);
    let flip_normals = object.boolean_or("flip_normals", false)?;
    let placement = Placement {
        to_world,
        flip_normals,
    };
    placement.check(object)?;
    let geometry = match object.plugin.as_str() {
        "obj" | "ply" | "serialized" => mesh_file::load(object, &placement, loader),
        "rectangle" => placement.flat_sided(rectangle::rectangle(), object),
        "cube" => placement.flat_sided(cube::cube(), object),
        "sphere" => Sphere::load(object, &placement).map(Geometry::Sphere),
        "disk" => Ok(Geometry::Disk(Disk::load(&placement))),
        "cylinder" => Cylinder::load(object, &placement).map(Geometry::Cylinder),
        _ => Err(object.unsupported(&SUPPORTED)),
    }?;
    if geometry.is_within_reach() {
        return Ok(geometry);
    }
    Err(object.error(format!(
        "this `{}` is too large, too small or too far away: coordinates must be at most {FARTHEST:e} and areas representable in 32 bits",
        object.plugin
    )))
}

/// How a shape is put into the world.
pub(super) struct Placement {
    pub to_world: DMat4,
    pub flip_normals: bool,
}

impl Placement {
    fn check(&self, object: &Object) -> Result<(), SceneError> {
        let determinant = self.to_world.determinant();
        if determinant != 0.0 && self.to_world.is_finite() && determinant.is_finite() {
            return Ok(());
        }
        Err(object.parameter_error(
            "to_world",
            "`to_world` flattens the shape: the transform has no inverse",
        ))
    }

    /// The transform of normals.
    fn normals(&self) -> DMat3 {
        DMat3::from_mat4(self.to_world).inverse().transpose()
    }

    /// The factor of a transform that scales all lengths alike; an error for shapes that would not stay themselves.
    fn uniform_scale(&self, object: &Object) -> Result<f64, SceneError> {
        let axes = DMat3::from_mat4(self.to_world);
        let scale = axes.determinant().abs().cbrt();
        let identity = (axes.transpose() * axes) * (1.0 / (scale * scale));
        let deviation = (identity - DMat3::IDENTITY)
            .to_cols_array()
            .into_iter()
            .fold(0.0, |a: f64, b| a.max(b.abs()));
        if deviation < 1e-4 {
            return Ok(scale);
        }
        let message = format!(
            "a `{}` stays one under uniform scaling only; `to_world` scales or shears it otherwise",
            object.plugin
        );
        Err(object.parameter_error("to_world", message))
    }
}

/// A shape with what it is made of.
#[derive(Debug)]
pub struct Shape {
    /// Its form.
    pub geometry: Geometry,
    /// How it scatters light.
    pub material: MaterialId,
    /// The area light that it is, if it emits.
    pub emitter: Option<EmitterId>,
}

/// The form of a shape, in world space, or in the space of the group that it belongs to.
#[derive(Debug)]
pub enum Geometry {
    /// A triangle mesh (also rectangles and cubes, which triangles represent exactly).
    Triangles(Triangles),
    /// An exact sphere.
    Sphere(Sphere),
    /// An exact disk or ellipse.
    Disk(Disk),
    /// An exact cylinder mantle without caps.
    Cylinder(Cylinder),
}

/// A point of a shape.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfacePoint {
    /// Position in world space, on the surface as precisely as `f32` can say it.
    pub position: Vec3,
    /// Unit normal of the true surface, in world space, on the outer side.
    pub geometric_normal: Vec3,
    /// Unit normal for shading (interpolated where the mesh has vertex normals), in world space, on the outer side.
    pub shading_normal: Vec3,
}

impl SurfacePoint {
    /// A point whose shading normal is the geometric one.
    pub(crate) fn flat(position: Vec3, normal: Vec3) -> Self {
        Self {
            position,
            geometric_normal: normal,
            shading_normal: normal,
        }
    }

    /// The same point with its outer side turned inside.
    pub(crate) fn flipped_if(mut self, flip: bool) -> Self {
        if flip {
            self.geometric_normal = -self.geometric_normal;
            self.shading_normal = -self.shading_normal;
        }
        self
    }
}

/// A point of a shape drawn as seen from a reference point.
#[derive(Clone, Copy, Debug)]
pub struct ShapeSample {
    /// The point drawn.
    pub point: SurfacePoint,
    /// Unit direction from the reference point to it, in world space.
    pub direction: Vec3,
    /// Distance from the reference point, in scene units.
    pub distance: f32,
    /// The density of `direction`.
    pub pdf: SolidAnglePdf,
}

impl ShapeSample {
    /// The sample for a point drawn uniformly by area from a surface of `area`.
    pub(crate) fn by_area(reference: Vec3, point: SurfacePoint, area: f32) -> Self {
        let offset = point.position - reference;
        let distance = offset.length();
        let direction = offset * (1.0 / distance);
        let cosine = direction.dot(point.geometric_normal).abs();
        let pdf = crate::sampling::AreaPdf(1.0 / area).to_solid_angle(distance, cosine);
        Self {
            point,
            direction,
            distance,
            pdf,
        }
    }
}

/// Where a ray met a shape, in the terms of the intersection layer.
#[derive(Clone, Copy, Debug)]
pub struct HitCoordinates {
    /// The triangle, or 0.
    pub primitive: u32,
    /// First surface coordinate (barycentric for triangles, the shape's own otherwise).
    pub u: f32,
    /// Second surface coordinate.
    pub v: f32,
    /// The geometric normal as the intersection reported it, any length, in the shape's space.
    pub normal: Vec3,
}

impl Geometry {
    /// Whether it is a mesh with normals of its vertices, so that shading normals may be others than geometric ones.
    pub fn is_smoothed(&self) -> bool {
        match self {
            Self::Triangles(mesh) => matches!(**mesh.vertices(), VertexBuffer::Smooth(_)),
            Self::Sphere(_) | Self::Disk(_) | Self::Cylinder(_) => false,
        }
    }

    /// The surface at a hit.
    #[inline]
    pub fn surface(&self, hit: &HitCoordinates) -> SurfacePoint {
        match self {
            Self::Triangles(shape) => shape.surface(hit),
            Self::Sphere(shape) => shape.surface(hit),
            Self::Disk(shape) => shape.surface(hit),
            Self::Cylinder(shape) => shape.surface(hit),
        }
    }

    /// Where the point `point` of a hit lies on the shape.
    pub fn parameters(&self, hit: &HitCoordinates, point: &SurfacePoint) -> SurfaceParameters<'_> {
        match self {
            Self::Triangles(shape) => shape.parameters(hit, point),
            Self::Sphere(shape) => shape.parameters(point),
            Self::Disk(shape) => shape.parameters(hit, point),
            Self::Cylinder(shape) => shape.parameters(hit, point),
        }
    }

    /// Draws a point of the shape as seen from `reference` (world space).
    #[inline(always)]
    pub fn sample(&self, reference: Vec3, u: [f32; 2]) -> ShapeSample {
        match self {
            Self::Triangles(shape) => shape.sample(reference, u),
            Self::Sphere(shape) => shape.sample(reference, u),
            Self::Disk(shape) => shape.sample(reference, u),
            Self::Cylinder(shape) => shape.sample(reference, u),
        }
    }

    /// What it says everywhere of its mesh attributes that are the same at all points, by name.
    pub(super) fn constant_attributes(&self) -> HashMap<String, [f32; 3]> {
        match self {
            Self::Triangles(mesh) => mesh.constant_attributes(),
            Self::Sphere(_) | Self::Disk(_) | Self::Cylinder(_) => HashMap::new(),
        }
    }

    /// The parallelogram that it is, if it is one that can be sampled.
    pub(crate) fn parallelogram(&self) -> Option<Parallelogram> {
        match self {
            Self::Triangles(mesh) => mesh.parallelogram(),
            Self::Sphere(_) | Self::Disk(_) | Self::Cylinder(_) => None,
        }
    }

    /// The density with which [`Self::sample`] draws the direction from `reference` to `point`.
    #[inline]
    pub fn pdf(&self, reference: Vec3, point: &SurfacePoint) -> SolidAnglePdf {
        match self {
            Self::Sphere(shape) => shape.pdf(reference, point),
            Self::Triangles(_) | Self::Disk(_) | Self::Cylinder(_) => {
                ShapeSample::by_area(reference, *point, self.area()).pdf
            }
        }
    }

    /// Surface area in squared scene units.
    pub fn area(&self) -> f32 {
        match self {
            Self::Triangles(shape) => shape.area(),
            Self::Sphere(shape) => shape.area(),
            Self::Disk(shape) => shape.area(),
            Self::Cylinder(shape) => shape.area(),
        }
    }
}
