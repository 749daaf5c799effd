//! From a scene file to a [`Scene`]: every object of the file is handed to the plugin that it names.

use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Arc;

use super::bsdfs::{self, Material};
use super::emitters::{self, Emitter};
use super::error::SceneError;
use super::integrators::{self, PathIntegrator};
use super::shapes::{self, Geometry, Shape};
use super::source::{Source, Sources};
use super::textures::TextureLoader;
use super::xml::{self, Class, Document, Object, SceneSource};
use super::{EmitterId, IndependentSampler, MaterialId, Scene, ShapeId, sensors};
use crate::spectrum::MAX_EMISSION;

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
    materials: Vec<Material>,
    emitters: Vec<Emitter>,
    /// Where the materials come from, and the emitters.
    material_sources: Vec<Option<Source>>,
    emitter_sources: Vec<Source>,
    /// Materials by their object in the file, so that a bsdf that many shapes refer to is loaded once.
    known_materials: HashMap<*const Object, MaterialId>,
    /// What shapes without a bsdf are made of: those that do not emit, and those that do.
    default_materials: [Option<MaterialId>; 2],
}

impl<'d> Loader<'d> {
    fn new(document: &'d Document) -> Self {
        Self {
            document,
            textures: TextureLoader::new(document),
            shapes: Vec::new(),
            materials: Vec::new(),
            emitters: Vec::new(),
            material_sources: Vec::new(),
            emitter_sources: Vec::new(),
            known_materials: HashMap::new(),
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
        for child in root.children(Class::Shape) {
            self.shape(&child.object)?;
        }
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
            materials: self.materials,
            emitters: self.emitters,
            camera,
            film,
            integrator,
            sampler,
            sources: Sources {
                materials: self.material_sources,
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

    fn material(&mut self, object: &Arc<Object>) -> Result<MaterialId, SceneError> {
        if let Some(&known) = self.known_materials.get(&Arc::as_ptr(object)) {
            return Ok(known);
        }
        let material = bsdfs::load(object, &mut self.textures)?;
        let id = self.add_material(material, Some(Source::of(object)));
        self.known_materials.insert(Arc::as_ptr(object), id);
        Ok(id)
    }

    fn add_material(&mut self, material: Material, source: Option<Source>) -> MaterialId {
        self.materials.push(material);
        self.material_sources.push(source);
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
            let id = self.add_material(material, None);
            self.default_materials[usize::from(is_light)] = Some(id);
            id
        })
    }

    fn shape(&mut self, object: &Object) -> Result<(), SceneError> {
        let mut geometry = shapes::load(object, self)?;
        let light = object.child(Class::Emitter)?;
        let material = match object.child(Class::Bsdf)? {
            Some(child) => self.material(&child.object)?,
            None => self.default_material(light.is_some()),
        };
        let id = ShapeId(self.shapes.len() as u32);
        let light = match light {
            Some(child) => Some((emitters::load_area(&child.object, id, self)?, child)),
            None => None,
        };
        let material_attributes = self.materials[material.index()].attributes();
        let light_attributes = match &light {
            Some((light, _)) => light.attributes(),
            None => &[],
        };
        keep_attributes(
            object,
            &mut geometry,
            &material_attributes,
            light_attributes,
        )?;
        let emitter = match light {
            Some((light, child)) => {
                if let Geometry::Triangles(mesh) = &mut geometry
                    && !mesh.prepare_sampling()
                {
                    return Err(object.error("this shape cannot be a light: it has no area"));
                }
                Some(self.add_emitter(&child.object, Emitter::Area(light)))
            }
            None => None,
        };
        object.finish()?;
        self.shapes.push(Shape {
            geometry,
            material,
            emitter,
        });
        Ok(())
    }
}

/// Keeps of what a shape's mesh says what its material and its light ask for; it is an error if that is not there.
fn keep_attributes(
    object: &Object,
    geometry: &mut Geometry,
    of_material: &[&str],
    of_light: &[String],
) -> Result<(), SceneError> {
    let names = of_light.iter().map(String::as_str);
    let names: Vec<&str> = of_material.iter().copied().chain(names).collect();
    let missing = match geometry {
        Geometry::Triangles(mesh) => mesh.keep_attributes(&names).err(),
        _ => names.first().copied(),
    };
    if let Some(missing) = missing {
        let who = if of_material.contains(&missing) {
            "bsdf"
        } else {
            "light"
        };
        return Err(object.error(format!(
            "the {who} asks for the mesh attribute `{missing}`, which this {object} does not have"
        )));
    }
    let Geometry::Triangles(mesh) = geometry else {
        return Ok(());
    };
    for attribute in mesh.named_attributes() {
        let (greatest, range) = if of_material.contains(&attribute.name.as_str()) {
            (1.0, "colours are linear sRGB from 0 to 1")
        } else {
            (
                MAX_EMISSION,
                "colours of lights are linear sRGB from 0 to 1e30",
            )
        };
        if let Some(number) = attribute.colour_outside(0.0..=greatest) {
            return Err(object.error(format!(
                "the mesh attribute `{}` has {number}; {range}",
                attribute.name
            )));
        }
    }
    Ok(())
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
