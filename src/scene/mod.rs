//! What is rendered: scene files, shapes, materials, lights and cameras.

mod bsdfs;
mod emitters;
mod error;
mod load;
pub mod mesh;
mod sensors;
mod shapes;
mod spectra;
mod textures;
pub mod xml;

pub use bsdfs::{
    Bsdf, BsdfSample, BsdfValue, CoatedBase, Conductor, ConductorIndex, ConductorMaterial,
    Dielectric, DielectricMaterial, Diffuse, DiffuseMaterial, Distribution, Indices, Material,
    Model, Null, Perturbed, Plastic, PlasticMaterial, Principled, PrincipledMaterial,
    PrincipledThin, PrincipledThinMaterial, RoughConductor, RoughConductorMaterial,
    RoughDielectric, RoughDielectricMaterial, RoughPlastic, RoughPlasticMaterial, Roughness,
    SeenPoint, Side, ThinDielectric,
};
pub use emitters::{AreaLight, ConstantLight, Emitter, LightSample, PointLight};
pub use error::{Location, SceneError};
pub use load::LoadOptions;
pub use sensors::{
    CameraError, CameraRay, CropWindow, FieldOfView, FilmDescription, FilmError, FovAxis,
    ImageSize, Perspective, PixelFormat, Projection, ReconstructionFilter,
};
pub use shapes::{
    AttributesAt, Cylinder, CylinderHit, Disk, DiskHit, Geometry, HitCoordinates, Shape,
    ShapeSample, Sphere, SurfaceParameters, SurfacePoint, TriangleAttributes, Triangles,
};
pub(crate) use shapes::{CornerLanes, SurfaceLanes};
pub use textures::{
    AttributeTexture, Bitmap, Checkerboard, FloatTexture, Pattern, SpectrumTexture,
};

/// A shape of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShapeId(pub(crate) u32);

/// A material of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MaterialId(pub(crate) u32);

/// An emitter of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EmitterId(pub(crate) u32);

macro_rules! index_of {
    ($($id:ty),*) => {$(
        impl $id {
            /// Position in the scene's list.
            #[inline]
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    )*};
}
index_of!(ShapeId, MaterialId, EmitterId);

/// Everything that a scene file states.
#[derive(Debug)]
pub struct Scene {
    /// What the scene is called: its file, or the name of a built-in scene.
    pub name: String,
    /// All shapes.
    pub shapes: Vec<Shape>,
    /// All materials.
    pub materials: Vec<Material>,
    /// All emitters.
    pub emitters: Vec<Emitter>,
    /// The camera.
    pub camera: Perspective,
    /// The film.
    pub film: FilmDescription,
    /// How deep paths go and which are shown.
    pub integrator: PathIntegrator,
    /// How many samples are taken.
    pub sampler: IndependentSampler,
}

/// `path`: what the scene file says of the paths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathIntegrator {
    /// Most segments of a path, camera ray included; `None` for no limit. 1 shows emitters only, 2 adds direct light.
    pub max_depth: Option<u32>,
    /// From which number of segments on `throughput-roulette` may end a path.
    pub roulette_depth: u32,
    /// Whether area lights and surroundings are invisible to the camera.
    pub hide_emitters: bool,
}

impl Default for PathIntegrator {
    fn default() -> Self {
        Self {
            max_depth: None,
            roulette_depth: 5,
            hide_emitters: false,
        }
    }
}

/// `independent`: what the scene file says of the samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IndependentSampler {
    /// Camera paths per pixel, positive.
    pub sample_count: u32,
    /// Seed of the random streams.
    pub seed: u64,
}

impl Default for IndependentSampler {
    fn default() -> Self {
        Self {
            sample_count: 4,
            seed: 0,
        }
    }
}
