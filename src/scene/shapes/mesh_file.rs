//! `obj`, `ply` and `serialized`: triangle meshes from files (polygons become fans of triangles).
//!
//! | parameter | type | meaning | default |
//! |---|---|---|---|
//! | `filename` | string | the mesh, beside the scene or in a `<path>` | required |
//! | `face_normals` | boolean | shade flat: ignore and do not make vertex normals | false |
//! | `flip_normals` | boolean | let the inner side be the outer one | false |
//! | `flip_tex_coords` | boolean | turn texture coordinates upside down; not of `serialized` | true for `obj`, false for `ply` |
//! | `shape_index` | integer | which of the meshes in the file, from 0; only of `serialized` | 0 |
//! | `to_world` | transform | any affine transform | identity |
//!
//! A mesh without vertex normals gets smooth ones, as in Mitsuba, unless `face_normals` is set. Where a file `knot.ply` is
//! named that does not exist, the program makes the mesh itself.

use std::path::Path;

use super::{Geometry, Placement};
use crate::scene::error::SceneError;
use crate::scene::load::Loader;
use crate::scene::mesh::{self, MeshData};
use crate::scene::xml::Object;

/// The mesh that the program can make itself.
const GENERATED: &str = "knot.ply";

pub(super) fn load(
    object: &Object,
    placement: &Placement,
    loader: &mut Loader,
) -> Result<Geometry, SceneError> {
    let filename = object
        .string("filename")?
        .ok_or_else(|| object.missing("filename"))?;
    let face_normals = object.boolean_or("face_normals", false)?;
    let mut mesh = match object.plugin.as_str() {
        "serialized" => read_serialized(object, filename, loader)?,
        _ => read(object, filename, loader)?,
    };
    if face_normals {
        mesh.normals = None;
    }
    let smooth = !face_normals && mesh.normals.is_none();
    placement.mesh(mesh, smooth, object)
}

fn read(object: &Object, filename: &str, loader: &mut Loader) -> Result<MeshData, SceneError> {
    let path = match loader.document.resolve(object, "filename", filename) {
        Ok(path) => path,
        Err(_)
            if Path::new(filename)
                .file_name()
                .is_some_and(|name| name == GENERATED) =>
        {
            return Ok(mesh::knot::knot(mesh::knot::DEFAULT_TRIANGLES));
        }
        Err(error) => return Err(error),
    };
    let flip_tex_coords = object.boolean_or("flip_tex_coords", object.plugin == "obj")?;
    let located = |error| SceneError::mesh(object.parameter_location("filename"), error);
    if object.plugin == "obj" {
        return mesh::obj::read(&path, flip_tex_coords).map_err(located);
    }
    let mut mesh = mesh::ply::read(&path).map_err(located)?;
    if flip_tex_coords {
        mesh.uvs
            .iter_mut()
            .flatten()
            .for_each(|uv| uv[1] = 1.0 - uv[1]);
    }
    Ok(mesh)
}

fn read_serialized(
    object: &Object,
    filename: &str,
    loader: &Loader,
) -> Result<MeshData, SceneError> {
    let index = object.integer_or("shape_index", 0)?;
    let index = u32::try_from(index).map_err(|_| {
        let message = format!("`shape_index` is {index}; it must be from 0 on");
        object.parameter_error("shape_index", message)
    })?;
    let path = loader.document.resolve(object, "filename", filename)?;
    mesh::serialized::read(&path, index)
        .map_err(|error| SceneError::mesh(object.parameter_location("filename"), error))
}
