//! From a scene file to a [`Scene`]: every object of the file is handed to the plugin that it names.

mod shapes;

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use super::bsdfs::{self, Material};
use super::emitters::{self, Emitter};
use super::error::SceneError;
use super::integrators::{self, PathIntegrator};
use super::shapes::{Planes, Shape, ShapeGroup};
use super::source::{Source, Sources};
use super::textures::TextureLoader;
use super::xml::{self, Class, Document, Object, SceneSource};
use super::{EmitterId, IndependentSampler, MaterialId, Scene, ShapeGroupId, sensors};

/// What can be told about loading a scene.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// Values for the scene's `$name`s; each must be used by the scene.
    pub definitions: Vec<(String, String)>,
    /// Where the models lie: the value of `$models` in scenes that use it, unless `definitions` has one.
    pub models: Option<PathBuf>,
}

impl Scene {
    /// Loads a scene file in Mitsuba 3's XML format, with all meshes that it names.
    ///
    /// # Errors
    /// Whatever is wrong with the file or with what it names, with file, line and column. A plugin or a parameter that
    /// is not supported is an error, never another image.
    pub fn load(path: impl Into<PathBuf>, options: &LoadOptions) -> Result<Self, SceneError> {
        let path = path.into();
        let name = path.display().to_string();
        Self::load_from(&SceneSource::File(path), name, options)
    }

    /// The scene that is part of the program: the Cornell box with a knot, `scenes/cornell-knot.xml`.
    ///
    /// # Errors
    /// `options.definitions` that the scene does not use.
    pub fn built_in(options: &LoadOptions) -> Result<Self, SceneError> {
        const NAME: &str = "cornell-knot.xml";
        let text = include_str!("../../scenes/cornell-knot.xml");
        let source = SceneSource::Text { name: NAME, text };
        Self::load_from(&source, format!("built-in {NAME}"), options)
    }

    /// Loads a scene from the text of a scene file. The files that it names are looked for in the working directory.
    ///
    /// # Errors
    /// As [`Self::load`]; messages call the text `<scene>`.
    pub fn from_xml(text: &str, options: &LoadOptions) -> Result<Self, SceneError> {
        const NAME: &str = "scene";
        let source = SceneSource::Text { name: NAME, text };
        Self::load_from(&source, NAME.to_owned(), options)
    }

    fn load_from(
        source: &SceneSource,
        name: String,
        options: &LoadOptions,
    ) -> Result<Self, SceneError> {
        let models = options
            .models
            .as_ref()
            .map(|path| ("models".to_owned(), path.display().to_string()));
        let document = xml::parse(source, &options.definitions, models.as_slice())?;
        Loader::new(&document).scene(name)
    }
}

/// What is built up while the objects of a file are loaded.
pub(super) struct Loader<'d> {
    pub document: &'d Document,
    pub textures: TextureLoader<'d>,
    shapes: Vec<Shape>,
    planes: Planes,
    groups: Vec<ShapeGroup>,
    materials: Vec<Material>,
    emitters: Vec<Emitter>,
    /// Where the groups come from, and the emitters.
    group_sources: Vec<Source>,
    emitter_sources: Vec<Source>,
    /// Materials by their object in the file, so that a bsdf that many shapes refer to is loaded once, or where it asks for attributes
    /// that are the same everywhere on some meshes, once for those.
    known_materials: HashMap<*const Object, Vec<MaterialId>>,
    /// Groups by their object in the file.
    known_groups: HashMap<*const Object, ShapeGroupId>,
    /// What shapes without a bsdf are made of: those that do not emit, and those that do.
    default_materials: [Option<MaterialId>; 2],
}

impl<'d> Loader<'d> {
    fn new(document: &'d Document) -> Self {
        Self {
            document,
            textures: TextureLoader::new(document),
            shapes: Vec::new(),
            planes: Planes::of(&[]),
            groups: Vec::new(),
            materials: Vec::new(),
            emitters: Vec::new(),
            group_sources: Vec::new(),
            emitter_sources: Vec::new(),
            known_materials: HashMap::new(),
            known_groups: HashMap::new(),
            default_materials: [None; 2],
        }
    }

    fn scene(mut self, name: String) -> Result<Scene, SceneError> {
        let root = &self.document.root;
        let integrator = match root.child(Class::Integrator)? {
            Some(child) => integrators::load(&child.object)?,
            None => PathIntegrator::default(),
        };
        let Some(sensor) = root.child(Class::Sensor)? else {
            return Err(root.error(
                "the scene has no sensor; it needs one, such as <sensor type=\"perspective\">",
            ));
        };
        let sensors::Sensor {
            camera,
            film,
            sampler,
        } = sensors::load(&sensor.object)?;
        let instances = self.shapes_and_instances(&root.children(Class::Shape))?;
        self.textures.lie_on(HashMap::new());
        for child in root.children(Class::Bsdf) {
            self.check_material(&child.object)?;
        }
        for child in root.children(Class::Emitter) {
            // An area light outside of a shape is there to be referred to from shapes.
            if child.object.plugin != "area" {
                let emitter = emitters::load(&child.object, &mut self)?;
                self.add_surrounding(&child.object, emitter)?;
            }
        }
        root.finish()?;
        Ok(Scene {
            name,
            shapes: self.shapes,
            planes: self.planes,
            groups: self.groups,
            instances,
            materials: self.materials,
            emitters: self.emitters,
            camera,
            film,
            integrator,
            sampler,
            sources: Sources {
                groups: self.group_sources,
                emitters: self.emitter_sources,
                sensor: Source::of(&sensor.object),
            },
        })
    }

    fn add_surrounding(&mut self, object: &Object, emitter: Emitter) -> Result<(), SceneError> {
        if emitter.surrounds() && self.emitters.iter().any(Emitter::surrounds) {
            return Err(
                object.error("the scene already has an emitter that surrounds it; it can have one")
            );
        }
        self.add_emitter(object, emitter);
        Ok(())
    }

    fn add_emitter(&mut self, object: &Object, emitter: Emitter) -> EmitterId {
        self.emitters.push(emitter);
        self.emitter_sources.push(Source::of(object));
        EmitterId(self.emitters.len() as u32 - 1)
    }

    /// Refuses a bsdf that is wrong, though no shape uses it and so it is not kept.
    fn check_material(&mut self, object: &Arc<Object>) -> Result<(), SceneError> {
        if !self.known_materials.contains_key(&Arc::as_ptr(object)) {
            bsdfs::load(object, &mut self.textures)?;
        }
        Ok(())
    }

    /// The material that the bsdf `object` is on the shape on which [textures lie](TextureLoader::lie_on) now.
    fn material(&mut self, object: &Arc<Object>) -> Result<MaterialId, SceneError> {
        let key = Arc::as_ptr(object);
        let fits = |id: &&MaterialId| {
            let mut asked = self.materials[id.index()].attributes().iter();
            asked.all(|asked| self.textures.still_says(asked))
        };
        let mut known = self.known_materials.get(&key).into_iter().flatten();
        if let Some(&known) = known.find(fits) {
            return Ok(known);
        }
        let material = bsdfs::load(object, &mut self.textures)?;
        let id = self.add_material(material);
        self.known_materials.entry(key).or_default().push(id);
        Ok(id)
    }

    fn add_material(&mut self, material: Material) -> MaterialId {
        self.materials.push(material);
        MaterialId(self.materials.len() as u32 - 1)
    }

    /// What a shape without a bsdf is made of, as in Mitsuba: a lamp reflects nothing, and any other shape is diffuse
    /// with the default reflectance.
    fn default_material(&mut self, is_light: bool) -> MaterialId {
        let known = self.default_materials[usize::from(is_light)];
        known.unwrap_or_else(|| {
            let material = if is_light {
                Material::black()
            } else {
                Material::default()
            };
            let id = self.add_material(material);
            self.default_materials[usize::from(is_light)] = Some(id);
            id
        })
    }
}

impl IndependentSampler {
    pub(super) fn load(object: &Object) -> Result<Self, SceneError> {
        if object.plugin != "independent" {
            return Err(object.unsupported(&["independent"]));
        }
        let default = Self::default();
        let count = object.integer_or("sample_count", i64::from(default.sample_count))?;
        let sample_count = u32::try_from(count)
            .ok()
            .filter(|&count| count > 0)
            .ok_or_else(|| {
                object.parameter_error(
                    "sample_count",
                    format!(
                        "`sample_count` is {count}; it must be from 1 to {}",
                        u32::MAX
                    ),
                )
            })?;
        let seed = object.integer_or("seed", 0)? as u64;
        object.finish()?;
        Ok(Self { sample_count, seed })
    }
}
