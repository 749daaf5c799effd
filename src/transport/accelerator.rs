//! The scene's shapes in the intersection layer.

use std::num::NonZeroUsize;

use glam::Vec3;

use crate::embree::{
    Bounds, BuildOptions, BuildQuality, Device, EmbreeError, Scene as EmbreeScene, SceneBuilder,
    TriangleMesh, UserGeometry, UserHit, UserRay,
};
use crate::scene::{Cylinder, Disk, Geometry, Scene, Shape, Sphere};

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
pub struct Accelerator {
    scene: EmbreeScene,
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
        let mut builder = SceneBuilder::new(&device, build);
        // Geometries are numbered in the order of adding: their numbers are the shapes' own.
        for shape in &scene.shapes {
            match &shape.geometry {
                Geometry::Triangles(mesh) => {
                    let mesh = TriangleMesh::new(mesh.vertices().clone(), mesh.indices().clone())?;
                    builder.add_triangles(mesh)
                }
                Geometry::Sphere(sphere) => builder.add_user(*sphere),
                Geometry::Disk(disk) => builder.add_user(*disk),
                Geometry::Cylinder(cylinder) => builder.add_user(*cylinder),
            };
        }
        Ok(Self {
            scene: builder.build()?,
        })
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
        // The extent of an ellipse along an axis is the length of its two half axes' components there.
        let squares = self.axis_u * self.axis_u + self.axis_v * self.axis_v;
        bounds_about(self.center, squares.map(f32::sqrt))
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
