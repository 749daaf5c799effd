//! Wavefront OBJ files.
//!
//! All objects and groups of a file become one mesh, and corners with the same indices one vertex, as in Mitsuba 3,
//! so that recomputed normals are smooth across the borders of groups and not across seams of the texture. (The crate
//! `tobj` splits a file into one mesh per group and forgets which corners were the same; its errors name no line.)

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::Path;

use super::{MeshData, MeshError, MeshProblem, check};

/// Reads an OBJ file: the lines `v`, `vt`, `vn` and `f`; everything else is skipped.
///
/// A polygon becomes a fan around its first corner. Negative indices count from the last vertex so far. With
/// `flip_tex_coords`, which is Mitsuba's default, v becomes 1 - v.
///
/// # Errors
/// When the file cannot be read, a line is not understood, a face names a vertex that does not exist, only some faces
/// have normals or texture coordinates, there is no triangle, or a number is not finite.
pub fn read(path: &Path, flip_tex_coords: bool) -> Result<MeshData, MeshError> {
    let read = || parse(&std::fs::read(path)?, flip_tex_coords);
    read().map_err(|problem| MeshError::new(path, problem))
}

/// Reads the contents of an OBJ file.
pub(super) fn parse(bytes: &[u8], flip_tex_coords: bool) -> Result<MeshData, MeshProblem> {
    let mut reader = Reader {
        flip_tex_coords,
        ..Reader::default()
    };
    for (index, line) in bytes.split(|&byte| byte == b'\n').enumerate() {
        reader
            .line(&String::from_utf8_lossy(line))
            .map_err(|message| MeshProblem::Format(format!("line {}: {message}", index + 1)))?;
    }
    check::counts(
        reader.positions.len() as u64,
        reader.mesh.triangles.len() as u64,
    )?;
    check::finished(reader.mesh)
}

/// What has been read so far.
#[derive(Default)]
struct Reader {
    flip_tex_coords: bool,
    positions: Vec<[f32; 3]>,
    uvs: Vec<[f32; 2]>,
    normals: Vec<[f32; 3]>,
    /// The vertex of the mesh that a corner became.
    vertices: HashMap<Corner, u32>,
    mesh: MeshData,
}

/// A corner of a face: positions in the lists of the file.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Corner {
    position: usize,
    uv: Option<usize>,
    normal: Option<usize>,
}

impl Reader {
    fn line(&mut self, line: &str) -> Result<(), String> {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => self.positions.push(numbers(words)?),
            Some("vn") => self.normals.push(numbers(words)?),
            Some("vt") => {
                let [u, v] = numbers(words)?;
                let v = if self.flip_tex_coords { 1.0 - v } else { v };
                self.uvs.push([u, v]);
            }
            Some("f") => self.face(words)?,
            _ => {}
        }
        Ok(())
    }

    fn face<'a>(&mut self, words: impl Iterator<Item = &'a str>) -> Result<(), String> {
        let corners: Result<Vec<u32>, String> = words.map(|word| self.vertex(word)).collect();
        match corners?[..] {
            [first, ref rest @ ..] if rest.len() >= 2 => {
                let fan = rest.windows(2).map(|pair| [first, pair[0], pair[1]]);
                self.mesh.triangles.extend(fan);
                Ok(())
            }
            ref corners => Err(format!(
                "the face has {} corners; it needs at least 3",
                corners.len()
            )),
        }
    }

    /// The vertex of the mesh for a corner such as `7`, `7/2`, `7//3` or `7/2/3`.
    fn vertex(&mut self, word: &str) -> Result<u32, String> {
        let mut parts = word.split('/');
        let position = parts.next().unwrap_or_default();
        let mut optional = |what, count| match parts.next() {
            None | Some("") => Ok(None),
            Some(index) => resolve(index, count, what).map(Some),
        };
        let corner = Corner {
            uv: optional("texture coordinate", self.uvs.len())?,
            normal: optional("normal", self.normals.len())?,
            position: resolve(position, self.positions.len(), "vertex")?,
        };
        if parts.next().is_some() {
            return Err(format!("`{word}` has to be vertex/texture/normal"));
        }
        let next = u32::try_from(self.vertices.len()).map_err(|_| "too many vertices")?;
        match self.vertices.entry(corner) {
            Entry::Occupied(entry) => return Ok(*entry.get()),
            Entry::Vacant(entry) => entry.insert(next),
        };
        self.mesh.positions.push(self.positions[corner.position]);
        let uv = corner.uv.map(|index| self.uvs[index]);
        push(&mut self.mesh.uvs, uv, next, "texture coordinates")?;
        let normal = corner.normal.map(|index| self.normals[index]);
        push(&mut self.mesh.normals, normal, next, "normals")?;
        Ok(next)
    }
}

/// Adds the attribute of vertex number `index`, which all vertices have or none.
fn push<T>(
    attribute: &mut Option<Vec<T>>,
    value: Option<T>,
    index: u32,
    name: &str,
) -> Result<(), String> {
    match (attribute, value) {
        (Some(values), Some(value)) => values.push(value),
        (None, None) => {}
        (attribute @ None, Some(value)) if index == 0 => *attribute = Some(vec![value]),
        _ => return Err(format!("only some of the corners have {name}")),
    }
    Ok(())
}

/// The first numbers of a line; what follows (a weight, a colour) is skipped.
fn numbers<'a, const N: usize>(
    mut words: impl Iterator<Item = &'a str>,
) -> Result<[f32; N], String> {
    let mut numbers = [0.0; N];
    for number in &mut numbers {
        let word = words
            .next()
            .ok_or_else(|| format!("{N} numbers are needed"))?;
        *number = word
            .parse()
            .map_err(|_| format!("`{word}` is not a number"))?;
    }
    Ok(numbers)
}

/// The place in a list of `count` that `index`, from 1 or from -1 backwards, stands for.
fn resolve(index: &str, count: usize, what: &str) -> Result<usize, String> {
    let number: i64 = index
        .parse()
        .map_err(|_| format!("`{index}` is not the number of a {what}"))?;
    let place = match number {
        1.. => Some(number - 1),
        0 => None,
        _ => number.checked_add_unsigned(count as u64),
    };
    place
        .and_then(|place| usize::try_from(place).ok())
        .filter(|&place| place < count)
        .ok_or_else(|| {
            format!("the face refers to {what} {number}, but there are {count} up to here, counted from 1")
        })
}

#[cfg(test)]
mod tests;
