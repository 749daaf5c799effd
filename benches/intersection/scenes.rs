//! The scenes: the built-in one, and those whose models are there.

use std::error::Error;
use std::path::Path;
use std::sync::Arc;

use cohort::models::{DIRECTORY_VARIABLE, Model, ModelDirectories};
use cohort::{LoadOptions, Scene};

use crate::effort::Effort;

/// A scene under its name.
pub struct Subject {
    pub name: &'static str,
    pub scene: Arc<Scene>,
}

/// The scenes to measure; says which ones are left out for want of their model.
pub fn subjects(effort: Effort) -> Result<Vec<Subject>, Box<dyn Error>> {
    let mut subjects = vec![Subject {
        name: "cornell-knot",
        scene: Scene::built_in(&LoadOptions::default())?.into(),
    }];
    if effort == Effort::Test {
        return Ok(subjects);
    }
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let directories = ModelDirectories::new(None);
    for (name, model) in [
        ("cornell-armadillo", Model::Armadillo),
        ("cornell-lucy", Model::Lucy),
    ] {
        let Some(file) = directories.find(model) else {
            eprintln!(
                "{name} is left out: {DIRECTORY_VARIABLE} names no folder with {}",
                model.file_name()
            );
            continue;
        };
        let options = LoadOptions {
            models: file.parent().map(Path::to_owned),
            ..LoadOptions::default()
        };
        let scene = Scene::load(folder.join(format!("{name}.xml")), &options)?;
        subjects.push(Subject {
            name,
            scene: scene.into(),
        });
    }
    Ok(subjects)
}
