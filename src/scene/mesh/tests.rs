use std::path::{Path, PathBuf};
use std::time::Instant;

use super::*;

const TETRAHEDRON: [[f32; 3]; 4] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
];
const FACES: [[u32; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

#[track_caller]
fn check_normals(normals: &[[f32; 3]], expected: &[[f32; 3]]) {
    assert_eq!(normals.len(), expected.len());
    for (normal, expected) in normals.iter().zip(expected) {
        for (a, b) in normal.iter().zip(expected) {
            assert!((a - b).abs() < 1e-6, "{normals:?} instead of {expected:?}");
        }
    }
}

#[test]
fn smooth_normals_are_those_of_mitsuba() {
    let (a, b, c) = (-0.577_350_26, 0.921_024_44, -0.275_421_47);
    check_normals(
        &smooth_normals(&TETRAHEDRON, &FACES),
        &[[a, a, a], [b, c, c], [c, b, c], [c, c, b]],
    );
    let stretched = TETRAHEDRON.map(|[x, y, z]| [x, 2.0 * y, 3.0 * z]);
    check_normals(
        &smooth_normals(&stretched, &FACES),
        &[
            [a, a, a],
            [0.791_601_1, -0.411_490_02, -0.451_711_83],
            [-0.167_379_47, 0.927_008_3, -0.335_618_23],
            [-0.110_320_605, -0.198_251_93, 0.973_922_8],
        ],
    );
}

#[test]
fn vertices_without_a_surface_have_the_normal_that_mitsuba_gives_them() {
    let x = [1.0, 0.0, 0.0];
    let down = [0.0, 0.0, -1.0];
    // Vertex 3 has only a triangle without area.
    let normals = smooth_normals(&TETRAHEDRON, &[[0, 2, 1], [0, 0, 3]]);
    check_normals(&normals, &[down, down, down, x]);
    // Two triangles back to back.
    check_normals(
        &smooth_normals(&TETRAHEDRON, &[[0, 1, 2], [0, 2, 1]]),
        &[x; 4],
    );
    // So small that the squared area is zero in single precision.
    let tiny = TETRAHEDRON.map(|corner| corner.map(|number| number * 1e-20));
    check_normals(&smooth_normals(&tiny, &[[0, 1, 2]]), &[x; 4]);
}

#[test]
fn files_that_are_not_there_are_named() {
    let message = ply::read(Path::new("no/such.ply")).unwrap_err().to_string();
    assert!(
        message.starts_with("no/such.ply: No such file"),
        "{message}"
    );
    let message = obj::read(Path::new("no/such.obj"), true)
        .unwrap_err()
        .to_string();
    assert!(
        message.starts_with("no/such.obj: No such file"),
        "{message}"
    );
    let mesh = MeshData::default();
    let message = write_ply(Path::new("no/such/place.ply"), &mesh)
        .unwrap_err()
        .to_string();
    assert!(
        message.starts_with("no/such/place.ply: No such file"),
        "{message}"
    );
}

#[test]
fn the_armadillo_is_read_fast() {
    let Some(models) = std::env::var_os("COHORT_MODELS") else {
        eprintln!("SKIPPED: COHORT_MODELS does not name the directory of the models");
        return;
    };
    let path = PathBuf::from(models).join("armadillo.ply");
    // The best of some attempts, as other programs may be running.
    let timed = || {
        let start = Instant::now();
        let mesh = ply::read(&path).unwrap();
        (start.elapsed().as_secs_f64(), mesh)
    };
    let attempts = [timed(), timed(), timed()];
    let seconds = attempts
        .iter()
        .map(|attempt| attempt.0)
        .fold(f64::INFINITY, f64::min);
    let mesh = &attempts[0].1;
    assert_eq!(
        (mesh.positions.len(), mesh.triangles.len()),
        (172_974, 345_944)
    );
    assert!(seconds < 0.3, "reading took {seconds:.3} s");
    // Mitsuba 3.9.1's first three.
    check_normals(
        &smooth_normals(&mesh.positions, &mesh.triangles)[..3],
        &[
            [-0.449_320_26, 0.699_077_5, -0.556_238_95],
            [0.622_874_4, -0.208_049_2, -0.754_150_45],
            [-0.367_971_57, 0.329_589_16, -0.869_464_1],
        ],
    );
}
