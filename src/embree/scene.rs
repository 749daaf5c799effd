//! Scenes: what is collected by the builder, and what can be traced.

use std::collections::HashSet;
use std::sync::Arc;

use super::device::Device;
use super::error::EmbreeError;
use super::geometry::{Bounds, GeometryId};
use super::instance::Instance;
use super::quad_mesh::QuadMesh;
use super::raw;
use super::user_geometry::{UserData, UserGeometry};

/// How much time goes into a tree that is faster to trace.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BuildQuality {
    /// Quick to build.
    Low,
    /// Embree's own default.
    #[default]
    Medium,
    /// Triangles are split where that helps; takes more time and memory.
    High,
}

/// How a scene is built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BuildOptions {
    /// Time to build against time to trace.
    pub quality: BuildQuality,
    /// No ray slips through an edge that two triangles share, at some cost in speed.
    pub robust: bool,
    /// Less memory, somewhat slower.
    pub compact: bool,
}

/// Collects geometry, then builds a [`Scene`].
pub struct SceneBuilder {
    device: Device,
    options: BuildOptions,
    geometries: Vec<Geometry>,
}

/// What a scene keeps alive, because Embree only points to it.
enum Geometry {
    Quads(QuadMesh),
    User(Arc<UserData>),
    Instance(Instance),
}

impl SceneBuilder {
    /// A builder without geometry.
    pub fn new(device: &Device, options: BuildOptions) -> Self {
        Self {
            device: device.clone(),
            options,
            geometries: Vec::new(),
        }
    }

    /// Adds a mesh and returns its number.
    pub fn add_quads(&mut self, mesh: QuadMesh) -> GeometryId {
        self.add(|_| Geometry::Quads(mesh))
    }

    /// Adds geometry with its own code and returns its number.
    pub fn add_user(&mut self, geometry: impl UserGeometry) -> GeometryId {
        self.add(|id| Geometry::User(UserData::new(geometry, id)))
    }

    /// Adds an instance of another scene of the same device and returns its number.
    pub fn add_instance(&mut self, instance: Instance) -> GeometryId {
        self.add(|_| Geometry::Instance(instance))
    }

    fn add(&mut self, geometry: impl FnOnce(GeometryId) -> Geometry) -> GeometryId {
        let id = GeometryId(self.geometries.len() as u32);
        self.geometries.push(geometry(id));
        id
    }

    /// Hands the geometry to Embree and builds the tree over it.
    ///
    /// # Errors
    /// [`EmbreeError::BadBounds`] of a user geometry, [`EmbreeError::OtherDevice`] of an instance, or [`EmbreeError::Library`], for example when
    /// the memory does not suffice.
    pub fn build(self) -> Result<Scene, EmbreeError> {
        let Self {
            device,
            options,
            geometries,
        } = self;
        // SAFETY: the device is alive.
        let raw = unsafe { raw::rtcNewScene(device.raw()) };
        device.check("make a scene")?;
        let scene = Scene {
            raw,
            device,
            options,
            instanced: distinct_scenes(&geometries),
            geometries,
        };
        let flags = [
            (options.robust, raw::RTCSceneFlags::ROBUST),
            (options.compact, raw::RTCSceneFlags::COMPACT),
        ]
        .into_iter()
        .filter(|(wanted, _)| *wanted)
        .fold(raw::RTCSceneFlags::NONE, |flags, (_, flag)| flags | flag);
        let quality = match options.quality {
            BuildQuality::Low => raw::RTCBuildQuality::LOW,
            BuildQuality::Medium => raw::RTCBuildQuality::MEDIUM,
            BuildQuality::High => raw::RTCBuildQuality::HIGH,
        };
        // SAFETY: the scene is alive.
        unsafe {
            raw::rtcSetSceneFlags(raw, flags);
            raw::rtcSetSceneBuildQuality(raw, quality);
        }
        for (id, geometry) in scene.geometries.iter().enumerate() {
            let handle = match geometry {
                Geometry::Quads(mesh) => mesh.to_embree(&scene.device)?,
                Geometry::User(data) => data.to_embree(&scene.device)?,
                Geometry::Instance(instance) => instance.to_embree(&scene.device)?,
            };
            // SAFETY: both are alive and committed; the scene keeps what the geometry points to, and
            // no other geometry has this number.
            unsafe { raw::rtcAttachGeometryByID(raw, handle.raw(), id as u32) };
            scene.device.check("add a geometry to a scene")?;
        }
        // SAFETY: the scene is alive and nobody else has it yet.
        unsafe { raw::rtcCommitScene(raw) };
        scene.device.check("build a scene")?;
        Ok(scene)
    }
}

/// The scenes of which there are instances among `geometries`, each once.
fn distinct_scenes(geometries: &[Geometry]) -> Vec<Arc<Scene>> {
    let mut known = HashSet::new();
    let scenes = geometries.iter().filter_map(|geometry| match geometry {
        Geometry::Instance(instance) => Some(instance.scene()),
        Geometry::Quads(_) | Geometry::User(_) => None,
    });
    scenes
        .filter(|scene| known.insert(Arc::as_ptr(scene)))
        .cloned()
        .collect()
}

/// Geometry that rays can be traced through, from any number of threads. It does not change.
pub struct Scene {
    raw: raw::RTCScene,
    device: Device,
    options: BuildOptions,
    geometries: Vec<Geometry>,
    /// The scenes of which it has instances, each once.
    instanced: Vec<Arc<Scene>>,
}

// SAFETY: a committed scene may be traced and released by any thread; meshes are immutable and user
// geometry is `Send + Sync`.
unsafe impl Send for Scene {}
// SAFETY: as above.
unsafe impl Sync for Scene {}

impl Scene {
    /// The box around everything, in world space. Without geometry it is inside out.
    pub fn bounds(&self) -> Bounds {
        let mut bounds = raw::RTCBounds {
            lower_x: 0.0,
            lower_y: 0.0,
            lower_z: 0.0,
            align0: 0.0,
            upper_x: 0.0,
            upper_y: 0.0,
            upper_z: 0.0,
            align1: 0.0,
        };
        // SAFETY: the scene is committed, and the structure is Embree's own.
        unsafe { raw::rtcGetSceneBounds(self.raw, &mut bounds) };
        Bounds {
            min: [bounds.lower_x, bounds.lower_y, bounds.lower_z],
            max: [bounds.upper_x, bounds.upper_y, bounds.upper_z],
        }
    }

    /// The device the scene was built with; it knows how much memory it holds.
    pub fn device(&self) -> &Device {
        &self.device
    }

    /// How the scene was built.
    pub fn options(&self) -> BuildOptions {
        self.options
    }

    /// Whether it has instances of other scenes.
    pub fn has_instances(&self) -> bool {
        !self.instanced.is_empty()
    }

    /// Whether everything traced so far can be relied on. To be asked after a batch of calls, which
    /// do not check for themselves.
    ///
    /// # Errors
    /// [`EmbreeError::UserPanic`], the first of the scene's first geometry that ever panicked, or of an instanced scene's, or
    /// [`EmbreeError::Library`] when Embree has reported an error since the last look.
    pub fn check(&self) -> Result<(), EmbreeError> {
        self.check_geometries()?;
        for scene in &self.instanced {
            scene.check_geometries()?;
        }
        self.device.check("trace rays")
    }

    fn check_geometries(&self) -> Result<(), EmbreeError> {
        for geometry in &self.geometries {
            if let Geometry::User(data) = geometry {
                data.check()?;
            }
        }
        Ok(())
    }

    pub(super) fn raw(&self) -> raw::RTCScene {
        self.raw
    }
}

impl Drop for Scene {
    fn drop(&mut self) {
        // SAFETY: this is the one reference that `rtcNewScene` gave. The geometries, and then the
        // device, are dropped after it.
        unsafe { raw::rtcReleaseScene(self.raw) }
    }
}
