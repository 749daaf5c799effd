use proptest::prelude::*;

use super::*;

const VERTICES: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn read_text(faces: &str) -> Result<MeshData, MeshProblem> {
    parse(format!("{VERTICES}{faces}").as_bytes(), true)
}

#[track_caller]
fn check_error(faces: &str, expected: &str) {
    assert_eq!(read_text(faces).unwrap_err().to_string(), expected);
}

#[test]
fn polygons_become_fans_and_negative_indices_count_backwards() {
    let mesh = read_text("f 1 2 3 4\r\n").unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.positions[3], [0.0, 1.0, 0.0]);
    assert!(mesh.normals.is_none() && mesh.uvs.is_none());
    assert_eq!(read_text("f -4 -3 -2 -1\n").unwrap(), mesh);
}

#[test]
fn groups_are_merged_and_vertices_stand_in_the_order_of_use() {
    let mesh = read_text("o a\nf 4 1 2\ng b\nusemtl x\ns off\nf 4 2 3\nl 1 2\n").unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(mesh.positions[0], [0.0, 1.0, 0.0]);
}

#[test]
fn corners_with_other_texture_coordinates_or_normals_are_other_vertices() {
    let seam = "vt 0 0.25\nvt 1 0\nvn 0 0 2\nf 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/2/1 4/1/1\n";
    let mesh = read_text(seam).unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 3, 4]]);
    assert_eq!(mesh.uvs.unwrap()[0], [0.0, 0.75]);
    assert_eq!(mesh.normals.unwrap(), [[0.0, 0.0, 1.0]; 5]);
    let unflipped = parse(format!("{VERTICES}{seam}").as_bytes(), false).unwrap();
    assert_eq!(unflipped.uvs.unwrap()[0], [0.0, 0.25]);
    let only_normals = read_text("vn 0 0 1\nf 1//1 2//1 3//1\n").unwrap();
    assert!(only_normals.uvs.is_none() && only_normals.normals.is_some());
}

#[test]
fn mistakes_are_named_with_their_line() {
    check_error(
        "f 1 2 9\n",
        "line 5: the face refers to vertex 9, but there are 4 up to here, counted from 1",
    );
    check_error(
        "f 1 2 -5\n",
        "line 5: the face refers to vertex -5, but there are 4 up to here, counted from 1",
    );
    check_error(
        "f 0 1 2\n",
        "line 5: the face refers to vertex 0, but there are 4 up to here, counted from 1",
    );
    check_error(
        "f 1/3 2 3\n",
        "line 5: the face refers to texture coordinate 3, but there are 0 up to here, counted from 1",
    );
    check_error("f 1 2 x\n", "line 5: `x` is not the number of a vertex");
    check_error(
        "f 1/1/1/1 2 3\n",
        "line 5: the face refers to texture coordinate 1, but there are 0 up to here, counted from 1",
    );
    check_error(
        "f 1 2\n",
        "line 5: the face has 2 corners; it needs at least 3",
    );
    check_error("v 1 2\n", "line 5: 3 numbers are needed");
    check_error("v 1 2 y\n", "line 5: `y` is not a number");
    check_error(
        "vn 0 0 1\nf 1//1 2//1 3//1\nf 1 3 4\n",
        "line 7: only some of the corners have normals",
    );
    check_error(
        "vn 0 0 1\nf 1 3 4\nf 1//1 2//1 3//1\n",
        "line 7: only some of the corners have normals",
    );
    check_error("", "the mesh is empty: it has no triangles");
    check_error(
        "v nan 0 0\nf 1 2 5\n",
        "the position of vertex 2 is not finite",
    );
    check_error(
        "vn 0 0 0\nf 1//1 2//1 3//1\n",
        "the normal of vertex 0 has no direction",
    );
    assert!(matches!(
        parse(b"# nothing\n", true),
        Err(MeshProblem::NoVertices)
    ));
}

proptest! {
    #[test]
    fn arbitrary_files_never_panic(bytes in any::<Vec<u8>>(), lines in "([vf][nt]? [0-9/ .e-]{0,12}\n){0,12}") {
        let _ = parse(&bytes, true);
        let _ = read_text(&lines);
    }
}
