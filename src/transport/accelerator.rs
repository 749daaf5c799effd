//! The scene's shapes in the intersection layer.

use std::num::NonZeroUsize;
use std::slice::from_mut;
use std::sync::Arc;

use glam::Vec3;

use super::triangle_names::TriangleNames;
use crate::embree::{
    self, Affine, Bounds, BuildOptions, BuildQuality, Coherence, Device, EmbreeError, Hits,
    INVALID_GEOMETRY, OnPrimitives, QuadMesh, RayHit1, Rays, Scene as EmbreeScene, SceneBuilder,
    UserGeometry, UserHit, UserRay,
};
use crate::scene::{Cylinder, Disk, Geometry, Instance, Scene, Shape, Sphere};

/// How the acceleration structure is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AcceleratorOptions {
    /// Threads that build it; the intersection layer starts no others.
    pub threads: NonZeroUsize,
    /// Speed of the build against speed of the rays.
    pub quality: BuildQuality,
    /// Watertight intersection, at some cost in ray rate.
    pub robust: bool,
}

/// All shapes of a scene, ready to be intersected.
///
/// The shapes that stand in the world are the first geometries of the intersection layer's scene, and instances of groups are those
/// that follow. A group is a scene of its own, in which geometries are numbered from 0 on; meshes are quads. Hits that leave this room
/// name the shape and the triangle.
pub struct Accelerator {
    scene: EmbreeScene,
    /// How many shapes stand in the world: the number of the first instance.
    first_instance: u32,
    /// By instance: the first shape of its group.
    first_shapes: Vec<u32>,
    triangles: TriangleNames,
}

impl Accelerator {
    /// Builds the structure for `scene`.
    ///
    /// # Errors
    /// What the intersection layer refuses, above all for want of memory.
    pub fn new(scene: &Scene, options: AcceleratorOptions) -> Result<Self, EmbreeError> {
        let device = Device::new(options.threads)?;
        let build = BuildOptions {
            quality: options.quality,
            robust: options.robust,
            compact: false,
        };
        let in_scene = |shapes: &[Shape]| {
            let mut builder = SceneBuilder::new(&device, build);
            for shape in shapes {
                add(&mut builder, shape)?;
            }
            Ok(builder)
        };
        let groups = scene.groups.iter().map(|group| {
            let shapes = in_scene(&scene.shapes[group.shapes.clone()])?;
            Ok(Arc::new(shapes.build()?))
        });
        let groups: Vec<Arc<EmbreeScene>> = groups.collect::<Result<_, EmbreeError>>()?;
        let in_world = scene.shapes_in_world();
        let mut builder = in_scene(in_world)?;
        let mut first_shapes = Vec::with_capacity(scene.instances.len());
        for instance in &scene.instances {
            let group = instance.group.index();
            let to_world = Affine {
                axes: instance.axes().map(Vec3::into),
                origin: instance.origin().into(),
            };
            builder.add_instance(embree::Instance::new(groups[group].clone(), to_world)?);
            first_shapes.push(scene.groups[group].shapes.start as u32);
        }
        Ok(Self {
            scene: builder.build()?,
            first_instance: in_world.len() as u32,
            first_shapes,
            triangles: TriangleNames::of(&scene.shapes),
        })
    }

    /// Finds the nearest hits of a stream of rays in world space, which have no names before [`Self::name`].
    pub fn nearest(&self, rays: &mut Rays, hits: &mut Hits, coherence: Coherence) {
        self.scene.intersect_stream(rays, hits, coherence);
    }

    /// Lets hits name the shapes and triangles that [`Self::nearest`] found.
    pub fn name(&self, hits: &mut Hits) {
        if self.scene.has_instances() {
            hits.renumber_instanced(|instance, geometry| self.shape_number(instance, geometry));
        }
        self.triangles.name(&mut hits.on_primitives());
    }

    /// Finds the nearest hit of one ray in world space, and names it.
    pub fn nearest1(&self, ray: &mut RayHit1, coherence: Coherence) {
        self.scene.intersect1(ray, coherence);
        let hit = &mut ray.hit;
        if hit.is_hit() && hit.instance_id != INVALID_GEOMETRY {
            hit.geometry_id = self.shape_number(hit.instance_id, hit.geometry_id);
        }
        self.triangles.name(&mut OnPrimitives {
            geometry_id: &[hit.geometry_id],
            primitive_id: from_mut(&mut hit.primitive_id),
            u: from_mut(&mut hit.u),
            v: from_mut(&mut hit.v),
        });
    }

    /// The number of the shape that is number `geometry` of the group that the instance number `instance` shows.
    #[inline]
    fn shape_number(&self, instance: u32, geometry: u32) -> u32 {
        self.first_shapes[(instance - self.first_instance) as usize] + geometry
    }

    /// The intersection layer's scene.
    #[inline]
    pub fn scene(&self) -> &EmbreeScene {
        &self.scene
    }

    /// The shape that a hit's geometry number names; `None` for a miss.
    #[inline]
    pub fn shape<'s>(&self, scene: &'s Scene, geometry: u32) -> Option<&'s Shape> {
        scene.shapes.get(geometry as usize)
    }

    /// The instance that a hit's instance number names; `None` for a hit outside of instances.
    #[inline]
    pub fn instance<'s>(&self, scene: &'s Scene, instance: u32) -> Option<&'s Instance> {
        let index = instance.checked_sub(self.first_instance)?;
        scene.instances.get(index as usize)
    }
}

fn add(builder: &mut SceneBuilder, shape: &Shape) -> Result<(), EmbreeError> {
    match &shape.geometry {
        Geometry::Triangles(mesh) => {
            let mesh = QuadMesh::new(mesh.vertices().clone(), mesh.faces().quads().clone())?;
            builder.add_quads(mesh)
        }
        Geometry::Sphere(sphere) => builder.add_user(*sphere),
        Geometry::Disk(disk) => builder.add_user(*disk),
        Geometry::Cylinder(cylinder) => builder.add_user(*cylinder),
    };
    Ok(())
}

fn bounds_about(center: Vec3, half_extent: Vec3) -> Bounds {
    // Rounding must not cut the shape.
    let slack = (center.abs() + half_extent) * (4.0 * f32::EPSILON);
    let half = half_extent + slack;
    Bounds {
        min: (center - half).into(),
        max: (center + half).into(),
    }
}

impl UserGeometry for Sphere {
    fn count(&self) -> u32 {
        1
    }

    fn bounds(&self, _primitive: u32) -> Bounds {
        bounds_about(self.center, Vec3::splat(self.radius))
    }

    fn intersect(&self, _primitive: u32, ray: &UserRay) -> Option<UserHit> {
        let (origin, direction) = (Vec3::from(ray.origin), Vec3::from(ray.direction));
        let t = Sphere::intersect(self, origin, direction, ray.tnear, ray.tfar)?;
        let point = origin.as_dvec3() + direction.as_dvec3() * f64::from(t);
        let normal = (point - self.center.as_dvec3()).as_vec3();
        Some(UserHit {
            t,
            u: 0.0,
            v: 0.0,
            normal: normal.into(),
        })
    }
}

impl UserGeometry for Disk {
    fn count(&self) -> u32 {
        1
    }

    fn bounds(&self, _primitive: u32) -> Bounds {
        bounds_about(self.center, self.half_extent())
    }

    fn intersect(&self, _primitive: u32, ray: &UserRay) -> Option<UserHit> {
        let (origin, direction) = (ray.origin.into(), ray.direction.into());
        let hit = Disk::intersect(self, origin, direction, ray.tnear, ray.tfar)?;
        Some(UserHit {
            t: hit.t,
            u: hit.u,
            v: hit.v,
            normal: self.normal().into(),
        })
    }
}

impl UserGeometry for Cylinder {
    fn count(&self) -> u32 {
        1
    }

    fn bounds(&self, _primitive: u32) -> Bounds {
        let middle = self.start + 0.5 * self.axis;
        bounds_about(middle, 0.5 * self.axis.abs() + Vec3::splat(self.radius))
    }

    fn intersect(&self, _primitive: u32, ray: &UserRay) -> Option<UserHit> {
        let (origin, direction) = (ray.origin.into(), ray.direction.into());
        let hit = Cylinder::intersect(self, origin, direction, ray.tnear, ray.tfar)?;
        Some(UserHit {
            t: hit.t,
            u: hit.along,
            v: 0.0,
            normal: hit.radial.into(),
        })
    }
}

#[cfg(test)]
mod tests;
