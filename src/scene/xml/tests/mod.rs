//! Tests of the XML reader by what it is asked to do; the expected numbers come from Mitsuba 3.9.1.

mod errors;
mod files;
mod objects;
mod robustness;
mod transforms;

use std::fs;
use std::path::{Path, PathBuf};

use super::*;
use crate::scene::error::SceneError;

/// A directory with `files` (name and text) in it; the first is the main one.
struct Files {
    directory: tempfile::TempDir,
    main: PathBuf,
}

impl Files {
    fn new(files: &[(&str, &str)]) -> Self {
        let directory = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = directory.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        let main = directory.path().join(files[0].0);
        Self { directory, main }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    fn parse(&self, definitions: &[(&str, &str)]) -> Result<Document, SceneError> {
        let definitions: Vec<_> = definitions
            .iter()
            .map(|(name, value)| (name.to_string(), value.to_string()))
            .collect();
        parse(&SceneSource::File(self.main.clone()), &definitions, &[])
    }

    /// The error's message with the directory taken out.
    fn error(&self, definitions: &[(&str, &str)]) -> String {
        let message = self.parse(definitions).unwrap_err().to_string();
        message.replace(&format!("{}/", self.directory.path().display()), "")
    }
}

fn scene(content: &str) -> Files {
    let text = format!("<scene version=\"3.0.0\">\n{content}\n</scene>");
    Files::new(&[("scene.xml", &text)])
}

fn parsed(content: &str) -> Document {
    scene(content).parse(&[]).unwrap()
}

/// The one object in a scene.
fn object(content: &str) -> std::sync::Arc<Object> {
    parsed(content).root.children[0].object.clone()
}

fn error(content: &str) -> String {
    scene(content).error(&[])
}

#[test]
fn reads_every_scene_of_the_suite() {
    let Some(suite) = std::env::var_os("COHORT_SUITE") else {
        eprintln!("SKIPPED: COHORT_SUITE does not name the Mitsuba test scenes");
        return;
    };
    let scenes = [
        "scenes/hello.xml",
        "scenes/cbox/cbox.xml",
        "scenes/cbox/cbox-rgb.xml",
        "scenes/cbox/cbox-spectral.xml",
        "scenes/matpreview/matpreview.xml",
    ];
    let mut paths: Vec<PathBuf> = scenes.map(|scene| Path::new(&suite).join(scene)).to_vec();
    for kind in fs::read_dir(Path::new(&suite).join("tests/scenes")).unwrap() {
        for entry in fs::read_dir(kind.unwrap().path()).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|extension| extension == "xml") {
                paths.push(path);
            }
        }
    }
    assert!(paths.len() > 15, "the suite has only {paths:?}");
    for path in paths {
        let document = parse(&SceneSource::File(path.clone()), &[], &[]).unwrap();
        assert!(!document.root.children(Class::Integrator).is_empty());
        assert!(
            !document.root.children(Class::Sensor).is_empty(),
            "{path:?}"
        );
        for shape in document.root.children(Class::Shape) {
            if let Some(name) = shape.object.string("filename").unwrap() {
                // Not every mesh is in this copy of the suite; those beside the scene are.
                let found = document.resolve(&shape.object, "filename", name);
                assert!(found.is_ok() || !path.ends_with("scenes/cbox/cbox.xml"));
            }
        }
    }
}
