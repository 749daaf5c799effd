//! Stand-in for the mesh readers and writers of `scene::mesh`, for triangles only.

use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::Path;

use crate::scene::mesh::MeshData;

pub(super) fn read(path: &Path) -> io::Result<MeshData> {
    let mut file = BufReader::new(std::fs::File::open(path)?);
    let (mut counts, mut big, mut line) = (vec![], false, String::new());
    while line.trim() != "end_header" {
        line.clear();
        if file.read_line(&mut line)? == 0 {
            return Err(io::Error::other("no end_header"));
        }
        let words: Vec<_> = line.split_whitespace().collect();
        match words[..] {
            ["format", format, ..] => big = format == "binary_big_endian",
            ["element", _, count] => counts.push(count.parse().map_err(io::Error::other)?),
            _ => {}
        }
    }
    let word = |file: &mut BufReader<_>| -> io::Result<u32> {
        let mut bytes = [0; 4];
        Read::read_exact(file, &mut bytes)?;
        Ok(if big {
            u32::from_be_bytes(bytes)
        } else {
            u32::from_le_bytes(bytes)
        })
    };
    let mut mesh = MeshData::default();
    for _ in 0..counts[0] {
        let mut position = || word(&mut file).map(f32::from_bits);
        mesh.positions.push([position()?, position()?, position()?]);
    }
    for _ in 0..counts[1] {
        file.read_exact(&mut [0])?;
        let mut index = || word(&mut file);
        mesh.triangles.push([index()?, index()?, index()?]);
    }
    Ok(mesh)
}

pub(super) fn write_ply_to(writer: &mut impl Write, mesh: &MeshData) -> io::Result<()> {
    writeln!(writer, "ply\nformat binary_little_endian 1.0")?;
    writeln!(writer, "element vertex {}", mesh.positions.len())?;
    writeln!(
        writer,
        "property float x\nproperty float y\nproperty float z"
    )?;
    writeln!(writer, "element face {}", mesh.triangles.len())?;
    writeln!(writer, "property list uchar int vertex_indices\nend_header")?;
    for number in mesh.positions.as_flattened() {
        writer.write_all(&number.to_le_bytes())?;
    }
    for triangle in &mesh.triangles {
        writer.write_all(&[3])?;
        for index in triangle {
            writer.write_all(&index.to_le_bytes())?;
        }
    }
    Ok(())
}
