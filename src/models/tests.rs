//! Models against a server on this machine.

use std::fs;
use std::io::Write;
use std::net::TcpListener;
use std::path::{Path, PathBuf};

use flate2::{Compression, write::GzEncoder};
use sha2::{Digest, Sha256};
use tempfile::TempDir;

use super::test_server::{ok, serve};
use super::*;
use crate::scene::mesh::knot::knot;
use crate::scene::mesh::{MeshData, ply};

fn provider(folder: &Path, base_url: String) -> Provider {
    Provider {
        directories: ModelDirectories::in_order(Some(folder.to_owned()), None),
        base_url,
        force: false,
    }
}

fn gzip(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes).expect("in memory");
    encoder.finish().expect("in memory")
}

fn tar_with(name: &str, bytes: &[u8]) -> Vec<u8> {
    let mut archive = tar::Builder::new(Vec::new());
    for (name, bytes) in [("README", b"read me".as_slice()), (name, bytes)] {
        let mut header = tar::Header::new_gnu();
        header.set_size(bytes.len() as u64);
        header.set_mode(0o644);
        archive
            .append_data(&mut header, name, bytes)
            .expect("in memory");
    }
    archive.into_inner().expect("in memory")
}

/// A mesh as the Armadillo comes: binary big-endian.
fn big_endian_ply(mesh: &MeshData) -> Vec<u8> {
    let mut bytes = format!(
        "ply\nformat binary_big_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\n\
         property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        mesh.positions.len(),
        mesh.triangles.len()
    )
    .into_bytes();
    for number in mesh.positions.as_flattened() {
        bytes.extend(number.to_be_bytes());
    }
    for triangle in &mesh.triangles {
        bytes.push(3);
        bytes.extend(triangle.iter().flat_map(|index| index.to_be_bytes()));
    }
    bytes
}

fn sha256(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A packed mesh, and its entry in the books (without a digest).
fn packed(triangles: usize, wanted: Option<usize>) -> (Vec<u8>, MeshData, Original<'static>) {
    let mesh = knot(triangles);
    let ply = big_endian_ply(&mesh);
    let (body, packing) = match wanted {
        Some(_) => (gzip(&tar_with("lucy.ply", &ply)), Packing::TarGzip),
        None => (gzip(&ply), Packing::Gzip),
    };
    let original = Original {
        path: "/data/mesh.gz",
        bytes: body.len() as u64,
        sha256: None,
        packing,
        triangles: mesh.triangles.len(),
        wanted_triangles: wanted.unwrap_or(mesh.triangles.len()),
    };
    (body, mesh, original)
}

/// Fetches `original` from a server that gives `answer`, into a folder that has an older file.
/// When that fails, the older file must be all there is.
fn fetch(original: &Original, answer: Vec<u8>) -> Result<(Origin, MeshData), ModelsError> {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("mesh.ply");
    fs::write(&path, "older").expect("a file");
    let fetched = provider(folder.path(), serve(answer)).fetch(original, &path);
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1);
    if fetched.is_err() {
        assert_eq!(fs::read(&path).expect("the older file"), b"older");
    }
    fetched.map(|origin| (origin, ply::read(&path).expect("a mesh")))
}

#[test]
fn a_checked_download_becomes_a_little_endian_ply() {
    let (body, mesh, mut original) = packed(2_000, None);
    let digest = sha256(&body);
    original.sha256 = Some(&digest);
    // Servers label .gz files so; the checksum is still of the compressed bytes.
    let answer = ok("Content-Encoding: gzip\r\n", &body);
    let (origin, read) = fetch(&original, answer).expect("a model");
    assert_eq!(read, mesh);
    let Origin::Downloaded {
        sha256, verified, ..
    } = origin
    else {
        panic!("{origin:?}");
    };
    assert!(verified && sha256 == digest);
}

#[test]
fn a_wrong_checksum_is_an_error_that_names_both() {
    let (body, _, mut original) = packed(2_000, None);
    let expected = "0".repeat(64);
    original.sha256 = Some(&expected);
    let error = fetch(&original, ok("", &body))
        .expect_err("wrong")
        .to_string();
    assert!(
        error.contains(&expected) && error.contains(&sha256(&body)),
        "{error}"
    );
}

#[test]
fn a_truncated_download_is_an_error() {
    let (body, _, original) = packed(2_000, None);
    let mut answer = ok("", &body);
    answer.truncate(answer.len() - 1_000);
    let error = fetch(&original, answer).expect_err("truncated");
    assert!(matches!(error, ModelsError::BrokeOff { received, .. } if received < original.bytes));
}

#[test]
fn another_size_is_an_error() {
    let (body, _, mut original) = packed(2_000, None);
    for wrong in [original.bytes - 1, original.bytes + 1] {
        original.bytes = wrong;
        let error = fetch(&original, ok("", &body)).expect_err("wrong size");
        assert!(matches!(error, ModelsError::WrongSize { .. }), "{error}");
    }
}

#[test]
fn a_missing_page_is_an_error_with_its_status() {
    let (_, _, original) = packed(2_000, None);
    let answer = b"HTTP/1.1 404 Not Found\r\nContent-Length: 4\r\nConnection: close\r\n\r\ngone";
    let error = fetch(&original, answer.to_vec()).expect_err("missing");
    assert!(
        matches!(error, ModelsError::Refused { status: 404, .. }),
        "{error}"
    );
}

#[test]
fn an_unreachable_server_is_an_error_with_the_address() {
    let folder = TempDir::new().expect("a folder");
    let free = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let url = format!("http://{}", free.local_addr().expect("its address"));
    drop(free);
    let error = provider(folder.path(), url.clone()).provide(Model::Armadillo);
    let error = error.expect_err("nobody there");
    assert!(matches!(error, ModelsError::Unreachable { .. }));
    assert!(error.to_string().contains(&url), "{error}");
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0);
}

#[test]
fn a_file_that_is_no_archive_and_an_archive_without_a_mesh_are_errors() {
    let (_, _, original) = packed(2_000, Some(1_000));
    for body in [
        b"<html>sorry</html>".to_vec(),
        gzip(&tar_with("lucy.txt", b"?")),
    ] {
        let bytes = body.len() as u64;
        let error = fetch(&Original { bytes, ..original }, ok("", &body)).expect_err("useless");
        assert!(matches!(error, ModelsError::Unpack { .. }), "{error}");
    }
}

#[test]
fn another_mesh_is_an_error() {
    let (body, _, mut original) = packed(2_000, None);
    original.triangles += 1;
    let error = fetch(&original, ok("", &body)).expect_err("another mesh");
    assert!(
        matches!(error, ModelsError::TriangleCount { .. }),
        "{error}"
    );
}

#[test]
fn an_archive_is_unpacked_and_simplified() {
    let (body, mesh, original) = packed(50_000, Some(10_000));
    let (origin, read) = fetch(&original, ok("", &body)).expect("a model");
    let count = read.triangles.len();
    assert!((9_900..=10_100).contains(&count), "{count} triangles");
    let Origin::Downloaded {
        verified,
        triangles,
        ..
    } = origin
    else {
        panic!("{origin:?}");
    };
    assert!(!verified && triangles == count);

    let mut used = vec![false; read.positions.len()];
    let mut volume = 0.0;
    for triangle in &read.triangles {
        let [a, b, c] = triangle.map(|index| {
            used[index as usize] = true;
            glam::Vec3::from(read.positions[index as usize]).as_dvec3()
        });
        assert!((b - a).cross(c - a).length() > 0.0);
        volume += a.dot(b.cross(c)) / 6.0;
    }
    assert!(used.iter().all(|used| *used));
    let original_volume: f64 = mesh
        .triangles
        .iter()
        .map(|t| t.map(|i| glam::Vec3::from(mesh.positions[i as usize]).as_dvec3()))
        .map(|[a, b, c]| a.dot(b.cross(c)) / 6.0)
        .sum();
    assert!(
        (volume / original_volume - 1.0).abs() < 0.02,
        "{volume} of {original_volume}"
    );
}

#[test]
fn folders_are_searched_in_order() {
    let (first, second) = (TempDir::new().expect("one"), TempDir::new().expect("two"));
    let (one, two) = (first.path().to_owned(), second.path().to_owned());
    let directories = ModelDirectories::in_order(Some(one.clone()), Some(two.clone()));
    assert_eq!(directories.destination(), one);
    assert_eq!(directories.find(Model::Lucy), None);
    fs::write(two.join("lucy.ply"), "2").expect("a file");
    assert_eq!(directories.find(Model::Lucy), Some(two.join("lucy.ply")));
    fs::write(one.join("lucy.ply"), "1").expect("a file");
    assert_eq!(directories.find(Model::Lucy), Some(one.join("lucy.ply")));

    let by_default = ModelDirectories::in_order(None, Some(PathBuf::new()));
    assert_eq!(by_default.destination(), Path::new(DEFAULT_DIRECTORY));
}

#[test]
fn nothing_is_downloaded_where_the_model_lies_unless_forced() {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("armadillo.ply");
    fs::write(&path, "mine").expect("a file");
    let mut provider = provider(folder.path(), "http://127.0.0.1:1".to_owned());
    let found = provider.provide(Model::Armadillo).expect("it is there");
    assert_eq!(
        found,
        Provided {
            path: path.clone(),
            origin: Origin::Found
        }
    );
    provider.force = true;
    provider
        .provide(Model::Armadillo)
        .expect_err("nobody there");
    assert_eq!(fs::read(&path).expect("still there"), b"mine");
}

#[test]
fn the_knot_is_made_in_a_folder_that_is_made() {
    let folder = TempDir::new().expect("a folder");
    let provider = provider(&folder.path().join("a/b"), String::new());
    let made = provider.provide(Model::Knot).expect("a knot");
    let read = ply::read(&made.path).expect("a mesh");
    assert_eq!(read, knot(crate::scene::mesh::knot::DEFAULT_TRIANGLES));
    let again = provider.provide(Model::Knot).expect("a knot");
    assert_eq!(again.origin, Origin::Found);
}

#[test]
fn a_folder_that_cannot_be_made_is_an_error() {
    let file = tempfile::NamedTempFile::new().expect("a file");
    let error = provider(file.path(), String::new()).provide(Model::Knot);
    assert!(matches!(error, Err(ModelsError::Write { .. })));
}
