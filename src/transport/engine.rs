//! What is traced, and how: everything that all threads share.

use std::sync::Arc;

use glam::Vec3;

use super::accelerator::Accelerator;
use super::batch::Segments;
use super::emission_table::EmissionTable;
use super::path_counts::PathCounts;
use super::settings::TransportSettings;
use super::shape_table::ShapeTable;
use crate::embree::Version;
use crate::film::FilterSampler;
use crate::learning::{Knowledge, Reliance};
use crate::sampling::{SamplerKind, StreamKey};
use crate::scene::{CameraView, Emitter, Instance, LightChoice, Parallelogram, Scene, Shape};
use crate::spectrum::Colour;
use crate::walk::{Scope, Strategy};

/// A scene ready to be traced, shared by all threads.
pub struct Engine {
    pub(super) scene: Arc<Scene>,
    pub(super) accelerator: Accelerator,
    pub(super) settings: TransportSettings,
    pub(super) strategy: Box<dyn Strategy>,
    pub(super) camera: CameraView,
    pub(super) filter: FilterSampler,
    /// How next-event estimation chooses among the emitters.
    pub(super) light_choice: LightChoice,
    /// What paths that arrive ask of shapes first.
    pub(super) shapes: ShapeTable,
    /// What the emitters emit.
    pub(super) emission: EmissionTable,
    /// The rectangle that an emitter is, by emitter, if it is one.
    lamps: Vec<Option<Parallelogram>>,
    /// Whether all surfaces are shaded as they are: no mesh has normals of its vertices.
    pub(super) shades_flat: bool,
    /// Whether all surfaces are matte, so that the variant for those can be used.
    pub(super) is_matte: bool,
}

/// One batch: some samples of every pixel of a tile.
#[derive(Clone, Copy, Debug)]
pub struct TileJob<'k> {
    /// The random numbers of the batch.
    pub key: StreamKey,
    /// How many camera paths each pixel gets.
    pub counts: PathCounts<'k>,
    /// What those of a pixel weigh together in it, however many they are; positive.
    pub weight: f64,
    /// What was learned before, of a render that learns.
    pub knowledge: Option<&'k Knowledge>,
    /// Whether what is traced is to be learned from.
    pub learns: bool,
    /// Which of the knowledge counts.
    pub reliance: Reliance,
}

impl<'k> TileJob<'k> {
    /// What is known, if the strategy is told.
    pub(super) fn knowledge_for_counts(&self, engine: &Engine) -> Option<&'k Knowledge> {
        let is_told = engine.strategy.learns() && self.reliance.counts;
        self.knowledge.filter(|_| is_told)
    }

    /// What is known, if directions are guided by it.
    pub(super) fn knowledge_for_guiding(&self, engine: &Engine) -> Option<&'k Knowledge> {
        let guides = engine.settings.guiding && self.reliance.guiding;
        self.knowledge.filter(|_| guides)
    }
}

impl Engine {
    /// An engine for `scene`, whose shapes `accelerator` holds.
    pub fn new(
        scene: Arc<Scene>,
        accelerator: Accelerator,
        settings: TransportSettings,
        strategy: Box<dyn Strategy>,
    ) -> Self {
        Self {
            camera: scene.camera.view(scene.film.size),
            filter: FilterSampler::new(&scene.film),
            is_matte: scene.is_matte(),
            shades_flat: !scene
                .shapes
                .iter()
                .any(|shape| shape.geometry.is_smoothed()),
            shapes: ShapeTable::new(&scene, scene.emitters.iter().position(Emitter::surrounds)),
            light_choice: LightChoice::new(&scene.emitters, &scene.shapes),
            emission: EmissionTable::new(&scene.emitters),
            lamps: scene
                .emitters
                .iter()
                .map(|emitter| emitter.parallelogram(&scene.shapes))
                .collect(),
            scene,
            accelerator,
            settings,
            strategy,
        }
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The strategy.
    pub fn strategy(&self) -> &dyn Strategy {
        &*self.strategy
    }

    /// The version of the intersection layer's library.
    pub fn embree_version(&self) -> Version {
        self.accelerator.scene().device().version()
    }

    /// The least and the greatest coordinates of all surfaces, in world space.
    pub fn bounds(&self) -> [Vec3; 2] {
        let bounds = self.accelerator.scene().bounds();
        [bounds.min.into(), bounds.max.into()]
    }

    /// Whether the particles of a pixel are sorted at every bounce. The offspring of one camera path, and tiles, stay together.
    pub(super) fn sorts(&self) -> bool {
        self.settings.sampler == SamplerKind::ArrayQmc
            && matches!(self.strategy.scope(), Scope::Particle | Scope::Pixel)
    }

    /// The shape that segment `i` met, if it met one.
    #[inline]
    pub(super) fn shape<C: Colour>(&self, segments: &Segments<C>, i: usize) -> Option<&Shape> {
        self.accelerator
            .shape(&self.scene, segments.hits.geometry_id(i))
    }

    /// The instance in which segment `i` met a surface, if it did in one.
    #[inline]
    pub(super) fn instance<C: Colour>(
        &self,
        segments: &Segments<C>,
        i: usize,
    ) -> Option<&Instance> {
        self.accelerator
            .instance(&self.scene, segments.hits.instance_id(i))
    }

    /// The rectangle that emitter number `emitter` is, if it is one.
    #[inline(always)]
    pub(super) fn lamp(&self, emitter: usize) -> Option<&Parallelogram> {
        self.lamps[emitter].as_ref()
    }
}
