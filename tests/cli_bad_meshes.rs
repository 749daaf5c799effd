//! Meshes that cannot be rendered.

mod cli_support;

use cli_support::{Folder, SCENE, with};

const HEADER: &str = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
                      element face 1\nproperty list uchar int vertex_index\nend_header\n";
const VERTICES: &str = "0 0 0\n1 0 0\n0 1 0\n";

/// What is said of a scene with the mesh file `name` of this content.
fn refusal_of(name: &str, content: &[u8]) -> String {
    let folder = Folder::new();
    folder.write(name, content);
    let kind = name.rsplit('.').next().unwrap();
    folder.refusal(&scene(kind, name), [])
}

fn scene(kind: &str, filename: &str) -> String {
    let shape = format!(r#"<shape type="{kind}"><string name="filename" value="{filename}"/>"#);
    with(SCENE, r#"<shape type="sphere">"#, &shape)
}

#[track_caller]
fn check(content: &str, message: &str) {
    let said = refusal_of("mesh.ply", content.as_bytes());
    assert_eq!(said, format!("cohort: scene.xml:8:19: mesh.ply: {message}"));
}

#[test]
fn the_mesh_that_the_others_spoil_is_right() {
    let folder = Folder::new();
    folder.write("mesh.ply", format!("{HEADER}{VERTICES}3 0 1 2\n"));
    let output = folder.render(&scene("ply", "mesh.ply"), []);
    assert!(output.status.success(), "{output:?}");
}

#[test]
fn spoilt_plys() {
    check(
        &format!("{HEADER}{VERTICES}"),
        "the file is truncated: it ends in face 0 of 1",
    );
    check(
        &format!("{HEADER}0 0 0\n1 0"),
        "the file is truncated: it ends in vertex 1 of 3",
    );
    check(
        &format!("{HEADER}{VERTICES}3 0 1 3\n"),
        "face 0 refers to vertex 3, but there are 3 vertices, counted from 0",
    );
    check(
        &format!("{HEADER}{VERTICES}3 0 1 -1\n"),
        "face 0 refers to vertex -1, but there are 3 vertices, counted from 0",
    );
    check(
        &format!("{HEADER}0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"),
        "the position of vertex 1 is not finite",
    );
    check(
        &format!("{HEADER}{VERTICES}2 0 1\n"),
        "face 0 has 2 corners; it needs at least 3",
    );
    check(
        &HEADER.replace("vertex 3", "vertex 0"),
        "the mesh is empty: it has no vertices",
    );
    check(
        &format!("{}{VERTICES}", HEADER.replace("face 1", "face 0")),
        "the mesh is empty: it has no triangles",
    );
    for huge in ["4000000000", "18446744073709551615", "99999999999999999999"] {
        let content = HEADER.replace("vertex 3", &format!("vertex {huge}"));
        let said = refusal_of("mesh.ply", content.as_bytes());
        assert!(said.contains("mesh.ply: "), "{said}");
    }
    assert!(refusal_of("mesh.ply", b"").contains("mesh.ply: "));
    assert!(refusal_of("mesh.ply", b"\x89PNG\r\n").contains("mesh.ply: "));
}

#[test]
fn truncated_binary_ply() {
    let mut content = HEADER.replace("ascii", "binary_little_endian").into_bytes();
    content.extend([0_u8; 3 * 12]);
    content.extend([3, 0, 0, 0, 0, 1, 0]);
    assert_eq!(
        refusal_of("mesh.ply", &content),
        "cohort: scene.xml:8:19: mesh.ply: the file is truncated: it ends in face 0 of 1"
    );
}

#[test]
fn spoilt_objs() {
    for (content, message) in [
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "vertex"),
        ("v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n", "not finite"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\n", "no triangles"),
        ("", "empty"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -9\n", "mesh.obj: "),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "mesh.obj: "),
    ] {
        let said = refusal_of("mesh.obj", content.as_bytes());
        assert!(said.contains(message), "{content:?}: {said}");
        assert!(
            said.starts_with("cohort: scene.xml:8:19: mesh.obj: "),
            "{said}"
        );
    }
}

#[test]
fn meshes_that_are_not_there() {
    let folder = Folder::new();
    let said = folder.refusal(&scene("ply", "missing.ply"), []);
    assert!(
        said.starts_with("cohort: scene.xml:8:19: `missing.ply` does not exist"),
        "{said}"
    );
    assert!(!said.contains("--models"), "{said}");
    std::fs::create_dir(folder.path().join("folder.ply")).unwrap();
    let said = folder.refusal(&scene("ply", "folder.ply"), []);
    assert!(said.contains("directory"), "{said}");
}

#[test]
fn models_that_are_not_there_can_be_downloaded() {
    let folder = Folder::new();
    let models = with(
        &scene("ply", "$models/armadillo.ply"),
        "<integrator",
        r#"<default name="models" value="models"/><integrator"#,
    );
    let hint = "; `cohort models` downloads the models, and `--models DIR` or COHORT_MODELS says where they are";
    let said = folder.refusal(&models, []);
    assert!(
        said.contains("`models/armadillo.ply` does not exist"),
        "{said}"
    );
    assert!(said.ends_with(hint), "{said}");
    let said = folder.refusal(&models, ["--models", "elsewhere"]);
    assert!(
        said.contains("`elsewhere/armadillo.ply` does not exist"),
        "{said}"
    );
    assert!(said.ends_with(hint), "{said}");
    let said = folder.refusal(&models, ["-D", "models=there"]);
    assert!(
        said.contains("`there/armadillo.ply` does not exist"),
        "{said}"
    );
}

#[test]
fn a_light_needs_an_area() {
    let folder = Folder::new();
    folder.write(
        "mesh.ply",
        format!("{HEADER}0 0 0\n0 0 0\n0 0 0\n3 0 1 2\n"),
    );
    let light = r#"<emitter type="area"><float name="radiance" value="1"/></emitter></shape>"#;
    let said = folder.refusal(&with(&scene("ply", "mesh.ply"), "</shape>", light), []);
    assert!(
        said.ends_with("this shape cannot be a light: it has no area"),
        "{said}"
    );
}
