//! What is rendered: scene files, shapes, materials, lights and cameras.

mod bsdfs;
mod effects;
mod emitters;
mod error;
mod image_file;
mod integrators;
mod light_choice;
mod load;
pub mod mesh;
mod plain;
mod sensors;
mod shapes;
mod source;
mod spectra;
mod textures;
pub mod xml;

pub use bsdfs::{
    Bsdf, BsdfSample, BsdfValue, CoatedBase, CommonParameters, Conductor, ConductorIndex,
    ConductorMaterial, Dielectric, DielectricMaterial, Diffuse, DiffuseMaterial, DirectionNumbers,
    Distribution, Indices, Lobes, Material, Model, Null, Perturbed, Plastic, PlasticMaterial,
    Principled, PrincipledMaterial, PrincipledThin, PrincipledThinMaterial, Refraction,
    RoughConductor, RoughConductorMaterial, RoughDielectric, RoughDielectricMaterial, RoughPlastic,
    RoughPlasticMaterial, Roughness, SeenPoint, Side, ThinDielectric,
};
pub(crate) use bsdfs::{BsdfSamples, BsdfValues, SlopeLanes};
pub use effects::{Effect, Effects};
pub use emitters::{
    AreaLight, ConstantLight, DirectionalLight, Emitter, EnvironmentMap, LightSample, PointLight,
    Projector, SpotLight,
};
pub use error::{Location, SceneError};
pub use image_file::{Channels, Encoding, ImageFile, ImageFileError};
pub use integrators::{PathIntegrator, SurfaceSamples};
pub use light_choice::{
    ChosenGroup, ChosenLight, Cone, GROUPS, GroupWeights, LightBounds, LightChoice, LightQuestion,
    Receiver,
};
pub use load::LoadOptions;
pub(crate) use sensors::CameraRayLanes;
pub use sensors::{
    Camera, CameraError, CameraRay, CameraView, CropWindow, FieldOfView, FilmDescription,
    FilmError, FovAxis, ImageSize, Orthographic, OrthographicView, Perspective, PinholeView,
    PixelFormat, ReconstructionFilter, ThinLens, ThinLensView,
};
pub use shapes::{
    AttributesAt, Cylinder, CylinderHit, Disk, DiskHit, Faces, Geometry, HitCoordinates, Instance,
    Shape, ShapeGroup, ShapeSample, Sphere, SurfaceParameters, SurfacePoint, TextureCoordinates,
    TriangleAttributes, Triangles,
};
pub(crate) use shapes::{CornerLanes, Parallelogram, PlaneLanes, Planes, SurfaceLanes};
pub use source::{Source, Sources};
pub use textures::{
    AttributeTexture, Bitmap, Checkerboard, FloatTexture, Pattern, SpectrumTexture,
};

/// A shape of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShapeId(pub(crate) u32);

/// A group of shapes of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShapeGroupId(pub(crate) u32);

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
index_of!(ShapeId, ShapeGroupId, MaterialId, EmitterId);

/// Everything that a scene file states.
#[derive(Debug)]
pub struct Scene {
    /// What the scene is called: its file, or the name of a built-in scene.
    pub name: String,
    /// All shapes: first those that stand in the world themselves, then those of the groups.
    pub shapes: Vec<Shape>,
    /// The planes of those that stand in the world and are shaded flat.
    pub(crate) planes: Planes,
    /// The groups of shapes that instances show.
    pub groups: Vec<ShapeGroup>,
    /// Where the groups stand in the world.
    pub instances: Vec<Instance>,
    /// All materials.
    pub materials: Vec<Material>,
    /// All emitters.
    pub emitters: Vec<Emitter>,
    /// The camera.
    pub camera: Camera,
    /// The film.
    pub film: FilmDescription,
    /// How deep paths go and which are shown.
    pub integrator: PathIntegrator,
    /// How many samples are taken.
    pub sampler: IndependentSampler,
    /// Which objects of the file all this comes from.
    pub sources: Sources,
}

impl Scene {
    /// The shapes that stand in the world themselves.
    pub fn shapes_in_world(&self) -> &[Shape] {
        let end = self.groups.first().map(|group| group.shapes.start);
        &self.shapes[..end.unwrap_or(self.shapes.len())]
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
