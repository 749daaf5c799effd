//! Wavefront OBJ files, read by the crate `tobj`.
//!
//! All objects and groups of a file become one mesh, and corners with the same indices one vertex, as in Mitsuba 3,
//! so that recomputed normals are smooth across the borders of groups and not across seams of the texture. `tobj` makes
//! a mesh of each group, names no line in its errors and trusts indices: so it is handed the statements of the geometry
//! alone, without groups, after they were checked.

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
    let mut geometry = Geometry::default();
    for (index, line) in bytes.split(|&byte| byte == b'\n').enumerate() {
        geometry
            .line(&String::from_utf8_lossy(line))
            .map_err(|message| MeshProblem::Format(format!("line {}: {message}", index + 1)))?;
    }
    check::counts(geometry.positions as u64, geometry.faces as u64)?;
    let options = tobj::LoadOptions {
        single_index: true,
        triangulate: true,
        ..tobj::LoadOptions::default()
    };
    let no_materials = |_: &Path| Ok(Default::default());
    let (models, _) =
        tobj::load_obj_buf(&mut geometry.statements.as_bytes(), &options, no_materials)
            .map_err(|error| MeshProblem::Format(error.to_string()))?;
    let mesh = models.into_iter().next().ok_or(MeshProblem::NoTriangles)?;
    check::finished(mesh_data(mesh.mesh, flip_tex_coords))
}

fn mesh_data(mesh: tobj::Mesh, flip_tex_coords: bool) -> MeshData {
    let mut uvs = grouped::<2, _>(&mesh.texcoords);
    if flip_tex_coords {
        uvs.iter_mut().for_each(|[_, v]| *v = 1.0 - *v);
    }
    let normals = grouped(&mesh.normals);
    MeshData {
        attributes: Vec::new(),
        positions: grouped(&mesh.positions),
        triangles: grouped(&mesh.indices),
        normals: (!normals.is_empty()).then_some(normals),
        uvs: (!uvs.is_empty()).then_some(uvs),
    }
}

/// The elements of a list that has `N` numbers for each.
fn grouped<const N: usize, T: Copy>(flat: &[T]) -> Vec<[T; N]> {
    flat.as_chunks().0.to_vec()
}

/// The statements of a file that say what its geometry is, all of them sound.
#[derive(Default)]
struct Geometry {
    /// The lines `v`, `vt`, `vn` and `f`, without what may follow the numbers that count.
    statements: String,
    positions: usize,
    uvs: usize,
    normals: usize,
    faces: usize,
    /// What the corners so far have.
    attributes: Option<Attributes>,
}

/// What a corner has beside a position.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Attributes {
    uv: bool,
    normal: bool,
}

impl Geometry {
    fn line(&mut self, line: &str) -> Result<(), String> {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => self.numbers::<3>("v", words, |geometry| &mut geometry.positions),
            Some("vn") => self.numbers::<3>("vn", words, |geometry| &mut geometry.normals),
            Some("vt") => self.numbers::<2>("vt", words, |geometry| &mut geometry.uvs),
            Some("f") => self.face(words),
            _ => Ok(()),
        }
    }

    /// Takes the first `N` words as numbers; what follows (a weight, a colour) is skipped.
    fn numbers<'a, const N: usize>(
        &mut self,
        keyword: &str,
        mut words: impl Iterator<Item = &'a str>,
        count: impl Fn(&mut Self) -> &mut usize,
    ) -> Result<(), String> {
        self.statements.push_str(keyword);
        for _ in 0..N {
            let word = words
                .next()
                .ok_or_else(|| format!("{N} numbers are needed"))?;
            word.parse::<f32>()
                .map_err(|_| format!("`{word}` is not a number"))?;
            self.push(word);
        }
        self.statements.push('\n');
        *count(self) += 1;
        Ok(())
    }

    fn face<'a>(&mut self, words: impl Iterator<Item = &'a str>) -> Result<(), String> {
        self.statements.push('f');
        let mut corners = 0;
        for word in words {
            let attributes = self.corner(word)?;
            let expected = *self.attributes.get_or_insert(attributes);
            for (name, has, should) in [
                ("texture coordinates", attributes.uv, expected.uv),
                ("normals", attributes.normal, expected.normal),
            ] {
                if has != should {
                    return Err(format!("only some of the corners have {name}"));
                }
            }
            self.push(word);
            corners += 1;
        }
        if corners < 3 {
            return Err(format!(
                "the face has {corners} corners; it needs at least 3"
            ));
        }
        self.statements.push('\n');
        self.faces += 1;
        Ok(())
    }

    /// Checks a corner such as `7`, `7/2`, `7//3` or `7/2/3`.
    fn corner(&self, word: &str) -> Result<Attributes, String> {
        let mut parts = word.split('/');
        let position = parts.next().unwrap_or_default();
        let mut optional = |what, count| match parts.next() {
            None | Some("") => Ok(false),
            Some(index) => exists(index, count, what).map(|()| true),
        };
        let attributes = Attributes {
            uv: optional("texture coordinate", self.uvs)?,
            normal: optional("normal", self.normals)?,
        };
        exists(position, self.positions, "vertex")?;
        match parts.next() {
            None => Ok(attributes),
            Some(_) => Err(format!("`{word}` has to be vertex/texture/normal")),
        }
    }

    fn push(&mut self, word: &str) {
        self.statements.push(' ');
        self.statements.push_str(word);
    }
}

/// Checks that `index`, from 1 or from -1 backwards, stands for one of the `count` so far.
fn exists(index: &str, count: usize, what: &str) -> Result<(), String> {
    let number: i64 = index
        .parse()
        .map_err(|_| format!("`{index}` is not the number of a {what}"))?;
    if number == 0 || number.unsigned_abs() > count as u64 {
        return Err(format!(
            "the face refers to {what} {number}, but there are {count} up to here, counted from 1"
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests;
