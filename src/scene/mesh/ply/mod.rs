//! PLY files: ASCII and both binary orders, every scalar type, triangles and polygons.

mod attributes;
mod header;
mod numbers;

use std::path::Path;

use header::{Element, Encoding, Header, Kind, Scalar};
use numbers::{Ascii, Binary, NumberError, Numbers};

use super::{MeshData, MeshError, MeshProblem, check};

/// Reads a PLY file.
///
/// Taken are the positions x, y, z, the normals nx, ny, nz (normalised), the texture coordinates u, v or texture_u,
/// texture_v or s, t, and the faces of the list vertex_index or vertex_indices; a polygon becomes a fan around its
/// first vertex. Of the rest, `attributes.rs` says what becomes an attribute; everything else is skipped.
///
/// # Errors
/// When the file cannot be read, is not PLY, is truncated, holds no triangle, names a vertex that does not exist or
/// has a number that is not finite.
pub fn read(path: &Path) -> Result<MeshData, MeshError> {
    let read = || parse(&std::fs::read(path)?);
    read().map_err(|problem| MeshError::new(path, problem))
}

/// Reads the contents of a PLY file.
pub(super) fn parse(bytes: &[u8]) -> Result<MeshData, MeshProblem> {
    let (header, rest) = header::read(bytes)?;
    match header.encoding {
        Encoding::Ascii => read_body(&header, Ascii { rest }),
        Encoding::BinaryLittleEndian => read_body(&header, Binary::<false> { rest }),
        Encoding::BinaryBigEndian => read_body(&header, Binary::<true> { rest }),
    }
}

fn read_body(header: &Header, mut numbers: impl Numbers) -> Result<MeshData, MeshProblem> {
    let find = |name: &str| header.elements.iter().find(|element| element.name == name);
    let vertex_count = find("vertex").map_or(0, |element| element.count);
    check::counts(
        vertex_count,
        find("face").map_or(0, |element| element.count),
    )?;
    let mut mesh = MeshData::default();
    for element in &header.elements {
        let capacity = capacity(element, header.encoding, &numbers);
        match element.name.as_str() {
            "vertex" => read_vertices(element, capacity, &mut numbers, &mut mesh)?,
            "face" => read_faces(element, capacity, vertex_count, &mut numbers, &mut mesh)?,
            _ => skip(element, &mut numbers)?,
        }
    }
    if !numbers.is_at_end() {
        return Err(MeshProblem::Format(
            "there is more in the file than its header says".to_owned(),
        ));
    }
    check::finished(mesh)
}

/// How many of an element there can be: as many as it says and as there are bytes for.
fn capacity(element: &Element, encoding: Encoding, numbers: &impl Numbers) -> usize {
    let room = numbers.bytes_left() / element.smallest_size(encoding).max(1);
    usize::try_from(element.count).map_or(room, |count| count.min(room))
}

/// The property numbers of the parts of an attribute, if all of them are there.
fn parts<const N: usize>(element: &Element, names: [&str; N]) -> Option<[usize; N]> {
    let positions = names.map(|name| element.position(name));
    positions
        .iter()
        .all(Option::is_some)
        .then(|| positions.map(Option::unwrap_or_default))
}

fn read_vertices(
    element: &Element,
    capacity: usize,
    numbers: &mut impl Numbers,
    mesh: &mut MeshData,
) -> Result<(), MeshProblem> {
    let position = parts(element, ["x", "y", "z"])
        .ok_or_else(|| MeshProblem::Format("the vertices need x, y and z".to_owned()))?;
    let normal = parts(element, ["nx", "ny", "nz"]);
    let uv = parts(element, ["u", "v"])
        .or_else(|| parts(element, ["texture_u", "texture_v"]))
        .or_else(|| parts(element, ["s", "t"]));
    let mut normals = normal.map(|_| Vec::with_capacity(capacity));
    let mut uvs = uv.map(|_| Vec::with_capacity(capacity));
    let mut columns = attributes::columns(element, false);
    mesh.positions.reserve_exact(capacity);
    let mut values = vec![0.0_f32; element.properties.len()];
    for index in 0..element.count {
        for (property, value) in element.properties.iter().zip(&mut values) {
            let in_vertex = |error| failure(error, element, index);
            match property.kind {
                Kind::Scalar(scalar) => *value = numbers.next(scalar).map_err(in_vertex)? as f32,
                Kind::List { count, item } => {
                    skip_list(count, item, numbers).map_err(in_vertex)?;
                    *value = f32::NAN;
                }
            }
        }
        mesh.positions.push(position.map(|part| values[part]));
        if let (Some(normals), Some(parts)) = (&mut normals, normal) {
            normals.push(parts.map(|part| values[part]));
        }
        if let (Some(uvs), Some(parts)) = (&mut uvs, uv) {
            uvs.push(parts.map(|part| values[part]));
        }
        for column in &mut columns {
            column.push(&values, 1)?;
        }
    }
    mesh.attributes
        .extend(columns.into_iter().map(attributes::Column::finish));
    mesh.normals = normals;
    mesh.uvs = uvs;
    Ok(())
}

fn read_faces(
    element: &Element,
    capacity: usize,
    vertex_count: u64,
    numbers: &mut impl Numbers,
    mesh: &mut MeshData,
) -> Result<(), MeshProblem> {
    let is_list = |property: &header::Property| matches!(property.kind, Kind::List { .. });
    let corners = ["vertex_index", "vertex_indices"]
        .into_iter()
        .find_map(|name| element.position(name))
        .filter(|&position| is_list(&element.properties[position]))
        .ok_or_else(|| {
            let message = "the faces need a list vertex_index or vertex_indices";
            MeshProblem::Format(message.to_owned())
        })?;
    mesh.triangles.reserve(capacity);
    let mut columns = attributes::columns(element, true);
    let mut values = vec![0.0_f32; element.properties.len()];
    let mut polygon = Vec::new();
    for face in 0..element.count {
        for (position, property) in element.properties.iter().enumerate() {
            let in_face = |error| failure(error, element, face);
            match property.kind {
                Kind::Scalar(scalar) => {
                    values[position] = numbers.next(scalar).map_err(in_face)? as f32;
                }
                Kind::List { count, item } if position == corners => {
                    polygon.clear();
                    for _ in 0..list_length(count, numbers).map_err(in_face)? {
                        polygon.push(numbers.next(item).map_err(in_face)?);
                    }
                }
                Kind::List { count, item } => skip_list(count, item, numbers).map_err(in_face)?,
            }
        }
        add_polygon(&polygon, face, vertex_count, &mut mesh.triangles)?;
        for column in &mut columns {
            column.push(&values, polygon.len().saturating_sub(2))?;
        }
    }
    mesh.attributes
        .extend(columns.into_iter().map(attributes::Column::finish));
    Ok(())
}

/// Adds a fan of triangles around the first corner.
fn add_polygon(
    polygon: &[f64],
    face: u64,
    vertex_count: u64,
    triangles: &mut Vec<[u32; 3]>,
) -> Result<(), MeshProblem> {
    if let Some(&index) = polygon
        .iter()
        .find(|&&index| !(index >= 0.0 && index < vertex_count as f64 && index.fract() == 0.0))
    {
        return Err(MeshProblem::IndexOutOfRange {
            face,
            index: index as i64,
            vertices: vertex_count,
        });
    }
    let [first, rest @ ..] = polygon else {
        return Err(check::too_few_corners(face, 0));
    };
    if rest.len() < 2 {
        return Err(check::too_few_corners(face, polygon.len()));
    }
    for pair in rest.windows(2) {
        triangles.push([*first as u32, pair[0] as u32, pair[1] as u32]);
    }
    Ok(())
}

/// Passes over the elements of a kind that is not used.
fn skip(element: &Element, numbers: &mut impl Numbers) -> Result<(), MeshProblem> {
    if element.properties.is_empty() {
        return Ok(());
    }
    for index in 0..element.count {
        for property in &element.properties {
            let in_element = |error| failure(error, element, index);
            match property.kind {
                Kind::Scalar(scalar) => {
                    numbers.next(scalar).map_err(in_element)?;
                }
                Kind::List { count, item } => {
                    skip_list(count, item, numbers).map_err(in_element)?;
                }
            }
        }
    }
    Ok(())
}

fn skip_list(count: Scalar, item: Scalar, numbers: &mut impl Numbers) -> Result<(), NumberError> {
    for _ in 0..list_length(count, numbers)? {
        numbers.next(item)?;
    }
    Ok(())
}

fn list_length(count: Scalar, numbers: &mut impl Numbers) -> Result<u64, NumberError> {
    match numbers.next(count)? {
        length if length < 0.0 => Err(NumberError::Malformed(format!(
            "a list cannot have the length {length}"
        ))),
        length => Ok(length as u64),
    }
}

fn failure(error: NumberError, element: &Element, index: u64) -> MeshProblem {
    match error {
        NumberError::End => MeshProblem::Truncated {
            element: element.name.clone(),
            index,
            count: element.count,
        },
        NumberError::Malformed(message) => {
            MeshProblem::Format(format!("{} {index}: {message}", element.name))
        }
    }
}

#[cfg(test)]
mod tests;
