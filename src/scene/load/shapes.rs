//! The shapes of a scene file: those that stand in the world, and groups with their instances.

use std::sync::Arc;

use super::Loader;
use crate::scene::bsdfs;
use crate::scene::emitters::{self, Emitter};
use crate::scene::error::SceneError;
use crate::scene::shapes::{self, Geometry, Instance, Planes, Shape, ShapeGroup};
use crate::scene::source::Source;
use crate::scene::textures::AskedAttribute;
use crate::scene::xml::{Child, Class, Object};
use crate::scene::{ShapeGroupId, ShapeId};
use crate::spectrum::MAX_EMISSION;

impl Loader<'_> {
    /// Loads the shapes of the scene: those that stand in the world, then the groups that instances show. Returns the instances.
    pub(super) fn shapes_and_instances(
        &mut self,
        children: &[&Child],
    ) -> Result<Vec<Instance>, SceneError> {
        let objects = || children.iter().map(|child| &child.object);
        let of_plugin = |plugin| objects().filter(move |object| object.plugin == plugin);
        let is_placed =
            |object: &&Arc<Object>| object.plugin != "instance" && object.plugin != "shapegroup";
        for object in objects().filter(is_placed) {
            self.shape(object)?;
        }
        self.planes = Planes::of(&self.shapes);
        let instances = of_plugin("instance").map(|object| Instance::load(object, self));
        let instances = instances.collect::<Result<_, _>>()?;
        for object in of_plugin("shapegroup") {
            if !self.known_groups.contains_key(&Arc::as_ptr(object)) {
                ShapeGroup::check(object, self)?;
            }
        }
        Ok(instances)
    }

    /// The group that `object` states. All shapes that stand in the world must have been loaded.
    pub fn group(&mut self, object: &Arc<Object>) -> Result<ShapeGroupId, SceneError> {
        if let Some(&known) = self.known_groups.get(&Arc::as_ptr(object)) {
            return Ok(known);
        }
        let group = ShapeGroup::load(object, self)?;
        let id = ShapeGroupId(self.groups.len() as u32);
        self.groups.push(group);
        self.group_sources.push(Source::of(object));
        self.known_groups.insert(Arc::as_ptr(object), id);
        Ok(id)
    }

    /// A group that was loaded.
    pub fn known_group(&self, id: ShapeGroupId) -> &ShapeGroup {
        &self.groups[id.index()]
    }

    /// The shapes that were loaded.
    pub fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// Refuses a shape that is wrong, though nobody sees it and so it is not kept.
    pub fn check_shape(&mut self, object: &Object) -> Result<(), SceneError> {
        let mut geometry = shapes::load(object, self)?;
        self.textures.lie_on(geometry.constant_attributes());
        if let Some(child) = object.child(Class::Bsdf)? {
            let material = bsdfs::load(&child.object, &mut self.textures)?;
            keep_attributes(object, &mut geometry, material.attributes(), &[])?;
        }
        object.finish()
    }

    /// Loads a shape.
    pub fn shape(&mut self, object: &Object) -> Result<(), SceneError> {
        let mut geometry = shapes::load(object, self)?;
        self.textures.lie_on(geometry.constant_attributes());
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
        keep_attributes(object, &mut geometry, material_attributes, light_attributes)?;
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
    of_material: &[AskedAttribute],
    of_light: &[AskedAttribute],
) -> Result<(), SceneError> {
    let asked = of_material.iter().chain(of_light);
    let names: Vec<&str> = asked.map(|asked| asked.name.as_str()).collect();
    let is_of_material = |name: &str| of_material.iter().any(|asked| asked.name == name);
    let missing = match geometry {
        Geometry::Triangles(mesh) => mesh.keep_attributes(&names).err(),
        _ => names.first().copied(),
    };
    if let Some(missing) = missing {
        let who = if is_of_material(missing) {
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
        let (greatest, range) = if is_of_material(&attribute.name) {
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
