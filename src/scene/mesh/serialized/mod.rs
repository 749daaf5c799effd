//! Mitsuba's `serialized` files: meshes one after the other, each compressed, versions 3 and 4.
//!
//! A mesh is the bytes `1c 04`, the version (16 bits), and a zlib stream: flags (32 bits), in version 4 a name that ends
//! with a zero, the numbers of vertices and triangles (64 bits each), and the arrays of positions, normals, texture
//! coordinates and colours as far as the flags say, then the corners of the triangles (32 bits each). At the end of the file
//! stand the places where the meshes start (64 bits each, in version 3 only 32) and their number (32 bits). Everything is
//! little-endian.

use std::io::{BufReader, ErrorKind, Read};
use std::path::Path;

use flate2::read::ZlibDecoder;

use super::{MeshData, MeshError, MeshProblem, check};

const MAGIC: u16 = 0x041c;

mod flags {
    pub const NORMALS: u32 = 0x0001;
    pub const TEXTURE_COORDINATES: u32 = 0x0002;
    pub const COLOURS: u32 = 0x0008;
    pub const DOUBLE_PRECISION: u32 = 0x2000;
}

/// Reads mesh number `shape_index` (from 0) of a file. Vertex colours are skipped, and so is the flag for flat shading (0x10),
/// as in Mitsuba.
///
/// # Errors
/// When the file cannot be read, is of another format, is damaged or truncated, has no such mesh, or the mesh holds no
/// triangle, names a vertex that does not exist or has a number that is not finite.
pub fn read(path: &Path, shape_index: u32) -> Result<MeshData, MeshError> {
    let read = || parse(&std::fs::read(path)?, shape_index);
    read().map_err(|problem| MeshError::new(path, problem))
}

/// Reads a mesh from the contents of a file.
fn parse(file: &[u8], shape_index: u32) -> Result<MeshData, MeshProblem> {
    let version = version(file)?;
    let start = match shape_index {
        0 => 0,
        index => start_of(file, version, index)?,
    };
    let mesh = file.get(start..).unwrap_or_default();
    let own_version = self::version(mesh)?;
    Stream(BufReader::new(ZlibDecoder::new(&mesh[4..]))).mesh(own_version)
}

/// The version that the header at the start of `bytes` states.
fn version(bytes: &[u8]) -> Result<u16, MeshProblem> {
    let refuse = |message: String| Err(MeshProblem::Format(message));
    let Some(&[magic_low, magic_high, low, high]) = bytes.first_chunk() else {
        return refuse("there is no mesh: the file ends before its header".to_owned());
    };
    if u16::from_le_bytes([magic_low, magic_high]) != MAGIC {
        return refuse("this is not a serialized mesh: it does not start with 1c 04".to_owned());
    }
    match u16::from_le_bytes([low, high]) {
        version @ (3 | 4) => Ok(version),
        version => refuse(format!(
            "version {version} of the format is not supported; supported are 3 and 4"
        )),
    }
}

/// Where mesh `index`, which is not the first, starts.
fn start_of(file: &[u8], version: u16, index: u32) -> Result<usize, MeshProblem> {
    let damaged = || MeshProblem::Format("the list of meshes at its end is damaged".to_owned());
    let (rest, count) = file.split_last_chunk().ok_or_else(damaged)?;
    let count = u32::from_le_bytes(*count);
    if index >= count {
        return Err(MeshProblem::Format(format!(
            "there is no mesh {index}: the file has {count}, counted from 0"
        )));
    }
    let width = if version == 4 { 8 } else { 4 };
    let from_end = width * (count - index) as usize;
    let entry = rest.len().checked_sub(from_end).ok_or_else(damaged)?;
    let mut start = [0; 8];
    start[..width].copy_from_slice(&rest[entry..][..width]);
    usize::try_from(u64::from_le_bytes(start))
        .ok()
        .filter(|&start| start < entry)
        .ok_or_else(damaged)
}

/// The decompressed bytes of a mesh.
struct Stream<R>(R);

impl<R: Read> Stream<R> {
    fn mesh(mut self, version: u16) -> Result<MeshData, MeshProblem> {
        let flags = u32::from_le_bytes(self.header()?);
        if version == 4 {
            while self.header()? != [0] {}
        }
        let vertices = u64::from_le_bytes(self.header()?);
        let faces = u64::from_le_bytes(self.header()?);
        check::counts(vertices, faces)?;
        let has = |flag| flags & flag != 0;
        let is_double = has(flags::DOUBLE_PRECISION);
        let mut mesh = MeshData {
            attributes: Vec::new(),
            positions: self.array("position", vertices, is_double)?,
            ..MeshData::default()
        };
        if has(flags::NORMALS) {
            mesh.normals = Some(self.array("normal", vertices, is_double)?);
        }
        if has(flags::TEXTURE_COORDINATES) {
            mesh.uvs = Some(self.array("texture coordinate", vertices, is_double)?);
        }
        if has(flags::COLOURS) {
            self.array::<3>("colour", vertices, is_double)?;
        }
        for face in 0..faces {
            let corners: [[u8; 4]; 3] = [
                self.bytes("face", face, faces)?,
                self.bytes("face", face, faces)?,
                self.bytes("face", face, faces)?,
            ];
            let corners = corners.map(u32::from_le_bytes);
            if let Some(&index) = corners.iter().find(|&&index| u64::from(index) >= vertices) {
                return Err(MeshProblem::IndexOutOfRange {
                    face,
                    index: index.into(),
                    vertices,
                });
            }
            mesh.triangles.push(corners);
        }
        check::finished(mesh)
    }

    fn header<const N: usize>(&mut self) -> Result<[u8; N], MeshProblem> {
        self.bytes("header", 0, 1)
    }

    /// `count` vectors of the kind `element`. Memory grows with what is there, not with what is promised.
    fn array<const N: usize>(
        &mut self,
        element: &str,
        count: u64,
        is_double: bool,
    ) -> Result<Vec<[f32; N]>, MeshProblem> {
        let mut vectors = Vec::new();
        for index in 0..count {
            let mut vector = [0.0; N];
            for number in &mut vector {
                *number = if is_double {
                    f64::from_le_bytes(self.bytes(element, index, count)?) as f32
                } else {
                    f32::from_le_bytes(self.bytes(element, index, count)?)
                };
            }
            vectors.push(vector);
        }
        Ok(vectors)
    }

    /// The next bytes, which are part of number `index` of `count` of the kind `element`.
    fn bytes<const N: usize>(
        &mut self,
        element: &str,
        index: u64,
        count: u64,
    ) -> Result<[u8; N], MeshProblem> {
        let mut bytes = [0; N];
        self.0
            .read_exact(&mut bytes)
            .map_err(|error| match error.kind() {
                ErrorKind::UnexpectedEof => MeshProblem::Truncated {
                    element: element.to_owned(),
                    index,
                    count,
                },
                _ => MeshProblem::Format(format!("its compressed data are damaged: {error}")),
            })?;
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests;
