//! `shapegroup`: shapes that are seen through instances only.
//!
//! | nested | type | meaning | default |
//! |---|---|---|---|
//! | | shape | one or more shapes; neither lights, nor instances, nor groups | required |
//!
//! The materials of what an [`instance`](super::instance) shows are those of the shapes here. A group that no instance shows is
//! checked and forgotten.

use std::ops::Range;

use glam::Vec3;

use crate::scene::error::SceneError;
use crate::scene::load::Loader;
use crate::scene::xml::{Class, Object};

/// Shapes with a space of their own, in which each of them is as it were in the world otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeGroup {
    /// Which of the scene's shapes belong to it.
    pub shapes: Range<usize>,
    /// The least and the greatest coordinates of those, in the group's space.
    pub bounds: [Vec3; 2],
}

impl ShapeGroup {
    /// The group that `object` states, its shapes the next ones of `loader`.
    pub(in crate::scene) fn load(object: &Object, loader: &mut Loader) -> Result<Self, SceneError> {
        let start = loader.shapes().len();
        for member in members(object)? {
            loader.shape(member)?;
        }
        object.finish()?;
        let shapes = start..loader.shapes().len();
        let geometries = loader.shapes()[shapes.clone()].iter();
        let bounds = geometries.map(|shape| shape.geometry.bounds()).fold(
            [Vec3::INFINITY, Vec3::NEG_INFINITY],
            |[min, max], [lower, upper]| [min.min(lower), max.max(upper)],
        );
        Ok(Self { shapes, bounds })
    }

    /// Refuses a group that is wrong, though no instance shows it and so it is not kept.
    pub(in crate::scene) fn check(object: &Object, loader: &mut Loader) -> Result<(), SceneError> {
        for member in members(object)? {
            loader.check_shape(member)?;
        }
        object.finish()
    }
}

/// The shapes in the group `object`.
fn members(object: &Object) -> Result<Vec<&Object>, SceneError> {
    let members = object.children(Class::Shape);
    if members.is_empty() {
        return Err(object.error("the `shapegroup` is empty; it needs at least one shape"));
    }
    for member in &members {
        let plugin = member.object.plugin.as_str();
        if plugin == "instance" || plugin == "shapegroup" {
            return Err(SceneError::at(
                &member.location,
                format!(
                    "a `shapegroup` cannot contain the shape `{plugin}`: instances do not nest"
                ),
            ));
        }
        if let Some(light) = member.object.child(Class::Emitter)? {
            return Err(SceneError::at(
                &light.location,
                format!(
                    "the shape `{plugin}` in a `shapegroup` cannot be a light: instances of lights are not supported; let it stand \
                     outside of the group"
                ),
            ));
        }
    }
    Ok(members.into_iter().map(|child| &*child.object).collect())
}
