use proptest::prelude::*;

use super::*;
use crate::scene::mesh::write_ply_to;

const TRIANGLE: &str = "ply\r\nformat ascii 1.0\ncomment a\nelement vertex 3\nproperty float x\nproperty float y\n\
    property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

fn triangle_with(old: &str, new: &str) -> Result<MeshData, MeshProblem> {
    assert!(TRIANGLE.contains(old));
    parse(TRIANGLE.replacen(old, new, 1).as_bytes())
}

#[track_caller]
fn check_error(old: &str, new: &str, expected: &str) {
    assert_eq!(triangle_with(old, new).unwrap_err().to_string(), expected);
}

/// A quad and a triangle with everything in unusual order, and things to skip before, between and behind.
fn unusual(encoding: Encoding) -> Vec<u8> {
    let format = match encoding {
        Encoding::Ascii => "ascii",
        Encoding::BinaryLittleEndian => "binary_little_endian",
        Encoding::BinaryBigEndian => "binary_big_endian",
    };
    let mut file = format!(
        "ply\nformat {format} 1.0\nobj_info x\nelement camera 1\nproperty list ushort double a\nproperty char b\n\
        element vertex 5\nproperty double z\nproperty uchar red\nproperty list int8 int16 extra\nproperty float x\n\
        property short y\nproperty float t\nproperty float nz\nproperty float ny\nproperty float nx\nproperty float s\n\
        element nothing 4000000000\nelement face 2\nproperty int flag\nproperty list uint32 ushort vertex_indices\n\
        property list uchar float more\nelement edge 1\nproperty uint a\nend_header\n"
    )
    .into_bytes();
    let mut put = |values: &[(Scalar, f64)]| {
        for &(scalar, value) in values {
            let mut bytes = match scalar {
                Scalar::I8 => (value as i8).to_le_bytes().to_vec(),
                Scalar::U8 => (value as u8).to_le_bytes().to_vec(),
                Scalar::I16 => (value as i16).to_le_bytes().to_vec(),
                Scalar::U16 => (value as u16).to_le_bytes().to_vec(),
                Scalar::I32 => (value as i32).to_le_bytes().to_vec(),
                Scalar::U32 => (value as u32).to_le_bytes().to_vec(),
                Scalar::F32 => (value as f32).to_le_bytes().to_vec(),
                Scalar::F64 => value.to_le_bytes().to_vec(),
            };
            match encoding {
                Encoding::Ascii => bytes = format!("{value} ").into_bytes(),
                Encoding::BinaryLittleEndian => {}
                Encoding::BinaryBigEndian => bytes.reverse(),
            }
            file.extend(bytes);
        }
    };
    use Scalar::*;
    put(&[(U16, 2.0), (F64, 0.5), (F64, 1e300), (I8, -3.0)]);
    for vertex in 0..5 {
        let v = vertex as f64;
        put(&[(F64, v + 0.125), (U8, 200.0), (I8, v)]);
        put(&vec![(I16, -7.0); vertex]);
        put(&[(F32, v * 2.5), (I16, -300.0 * v), (F32, 0.75)]);
        put(&[(F32, 2.0), (F32, 0.0), (F32, 0.0), (F32, 0.5)]);
    }
    put(&[
        (I32, -1.0),
        (U32, 4.0),
        (U16, 0.0),
        (U16, 1.0),
        (U16, 2.0),
        (U16, 3.0),
        (U8, 1.0),
        (F32, 9.0),
    ]);
    put(&[
        (I32, -1.0),
        (U32, 3.0),
        (U16, 2.0),
        (U16, 3.0),
        (U16, 4.0),
        (U8, 0.0),
    ]);
    put(&[(U32, 5.0)]);
    file
}

#[test]
fn every_encoding_order_and_type_is_read() {
    for encoding in [
        Encoding::Ascii,
        Encoding::BinaryLittleEndian,
        Encoding::BinaryBigEndian,
    ] {
        let mesh = parse(&unusual(encoding)).unwrap();
        assert_eq!(mesh.positions[2], [5.0, -600.0, 2.125]);
        assert_eq!(mesh.normals.unwrap(), [[0.0, 0.0, 1.0]; 5]);
        assert_eq!(mesh.uvs.unwrap(), [[0.5, 0.75]; 5]);
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [2, 3, 4]]);
    }
}

#[test]
fn every_truncation_is_an_error() {
    for encoding in [
        Encoding::Ascii,
        Encoding::BinaryLittleEndian,
        Encoding::BinaryBigEndian,
    ] {
        let file = unusual(encoding);
        // The text's last byte is a space.
        let end = file.len() - usize::from(encoding == Encoding::Ascii);
        for length in 0..end {
            assert!(
                parse(&file[..length]).is_err(),
                "{encoding:?} cut at {length}"
            );
        }
    }
    let file = unusual(Encoding::BinaryLittleEndian);
    let message = parse(&file[..file.len() - 6]).unwrap_err().to_string();
    assert_eq!(message, "the file is truncated: it ends in face 1 of 2");
}

#[test]
fn texture_coordinates_have_three_names() {
    for [u, v] in [["u", "v"], ["s", "t"], ["texture_u", "texture_v"]] {
        let file = TRIANGLE
            .replace(
                "float z\n",
                &format!("float z\nproperty float {v}\nproperty float {u}\n"),
            )
            .replace("0 0 0\n1 0 0\n0 1 0\n", "0 0 0 1 2\n1 0 0 3 4\n0 1 0 5 6\n");
        let uvs = parse(file.as_bytes()).unwrap().uvs.unwrap();
        assert_eq!(uvs, [[2.0, 1.0], [4.0, 3.0], [6.0, 5.0]]);
    }
}

#[test]
fn mistakes_are_named() {
    check_error(
        "3 0 1 2",
        "3 0 1 3",
        "face 0 refers to vertex 3, but there are 3 vertices, counted from 0",
    );
    check_error(
        "3 0 1 2",
        "3 0 1 -1",
        "face 0 refers to vertex -1, but there are 3 vertices, counted from 0",
    );
    check_error("1 0 0", "1 nan 0", "the position of vertex 1 is not finite");
    check_error(
        "1 0 0",
        "1 0 -inf",
        "the position of vertex 1 is not finite",
    );
    check_error(
        "1 0 0",
        "1 0 1e39",
        "the position of vertex 1 is not finite",
    );
    check_error(
        "vertex 3",
        "vertex 0",
        "the mesh is empty: it has no vertices",
    );
    check_error("face 1", "face 0", "the mesh is empty: it has no triangles");
    check_error(
        "element face 1\nproperty list uchar int vertex_index\n",
        "",
        "the mesh is empty: it has no triangles",
    );
    check_error(
        "3 0 1 2",
        "2 0 1",
        "face 0 has 2 corners; it needs at least 3",
    );
    check_error("3 0 1 2", "3 0 1 x", "face 0: `x` is not a whole number");
    check_error(
        "3 0 1 2",
        "300 0 1",
        "face 0: `300` is not within the type of the number",
    );
    check_error(
        "3 0 1 2",
        "3 0 1 2 7",
        "there is more in the file than its header says",
    );
    check_error("1 0 0", "1 zero 0", "vertex 1: `zero` is not a number");
    check_error("property float z\n", "", "the vertices need x, y and z");
    check_error(
        "vertex_index",
        "corners",
        "the faces need a list vertex_index or vertex_indices",
    );
    check_error(
        "ply",
        "plyx",
        "this is not a PLY file: the first line has to be `ply`",
    );
    check_error(
        "ascii",
        "binary",
        "line 2 of the PLY header: unknown format `binary`; known are ascii, binary_little_endian and binary_big_endian",
    );
    check_error(
        "ascii 1.0",
        "ascii 2.0",
        "line 2 of the PLY header: `format ascii 2.0` is not understood",
    );
    check_error(
        "format ascii 1.0\n",
        "",
        "the PLY header has no line `format ... 1.0`",
    );
    check_error(
        "float y",
        "quad y",
        "line 6 of the PLY header: unknown type `quad`; known are char, uchar, short, ushort, int, uint, float and double",
    );
    check_error(
        "float y",
        "float x",
        "line 6 of the PLY header: a second property `x` of `vertex`",
    );
    check_error(
        "face 1",
        "vertex 1",
        "line 8 of the PLY header: a second element `vertex`",
    );
    check_error(
        "face 1",
        "face -1",
        "line 8 of the PLY header: `-1` is not a number of elements",
    );
    check_error(
        "list uchar",
        "list float",
        "line 9 of the PLY header: the length of a list has to be of an integer type",
    );
    check_error(
        "end_header",
        "end",
        "line 10 of the PLY header: `end` is not understood",
    );
    let negative = TRIANGLE
        .replace("list uchar", "list char")
        .replace("3 0 1 2", "-3 0 1 2");
    let message = parse(negative.as_bytes()).unwrap_err().to_string();
    assert_eq!(message, "face 0: a list cannot have the length -3");
}

#[test]
fn absurd_counts_are_truncations_not_allocations() {
    for encoding in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let file = |vertices: &str, faces: &str| {
            TRIANGLE
                .replace("ascii", encoding)
                .replace("vertex 3", vertices)
                .replace("face 1", faces)
        };
        let vertices = file("vertex 4294967295", "face 1");
        let message = parse(vertices.as_bytes()).unwrap_err().to_string();
        assert!(
            message.starts_with("the file is truncated: it ends in vertex "),
            "{message}"
        );
        assert!(message.ends_with(" of 4294967295"), "{message}");
        parse(file("vertex 18446744073709551615", "face 1").as_bytes()).unwrap_err();
        parse(file("vertex 3", "face 18446744073709551615").as_bytes()).unwrap_err();
    }
    // A list that claims four billion items.
    let mut file = TRIANGLE
        .replace("ascii", "binary_little_endian")
        .replace("uchar int", "uint int");
    file.truncate(file.find("0 0 0").unwrap());
    let mut file = file.into_bytes();
    file.extend([0; 36]);
    file.extend([0xff; 4]);
    assert!(matches!(parse(&file), Err(MeshProblem::Truncated { .. })));
}

proptest! {
    #[test]
    fn arbitrary_bytes_never_panic(bytes in any::<Vec<u8>>()) {
        let _ = parse(&bytes);
        let _ = parse(&[b"ply\nformat ascii 1.0\n", &bytes[..]].concat());
    }

    #[test]
    fn damaged_files_never_panic(
        which in 0..3_usize,
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0..6_usize, any::<Vec<u8>>()), 1..4)
    ) {
        let encodings = [Encoding::Ascii, Encoding::BinaryLittleEndian, Encoding::BinaryBigEndian];
        let mut file = unusual(encodings[which]);
        for (start, length, replacement) in edits {
            let start = start.index(file.len().max(1)).min(file.len());
            let end = (start + length).min(file.len());
            file.splice(start..end, replacement.into_iter().take(6));
        }
        let _ = parse(&file);
    }

    #[test]
    fn what_is_written_is_read(
        positions in prop::collection::vec(prop::array::uniform3(-1e30_f32..1e30), 3..20),
        corners in prop::collection::vec(prop::array::uniform3(any::<prop::sample::Index>()), 1..20),
        with_normals in any::<bool>(),
    ) {
        let mesh = MeshData {
            attributes: Vec::new(),
            normals: with_normals.then(|| vec![[0.0, 0.0, -1.0]; positions.len()]),
            triangles: corners.iter().map(|corner| corner.map(|index| index.index(positions.len()) as u32)).collect(),
            positions,
            uvs: None,
        };
        let mut file = Vec::new();
        write_ply_to(&mut file, &mesh).unwrap();
        prop_assert_eq!(parse(&file).unwrap(), mesh);
    }
}
