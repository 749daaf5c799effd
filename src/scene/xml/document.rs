//! A scene file with everything in it resolved.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::definitions::Definitions;
use super::file::{self, File};
use super::object::Object;
use super::parser::Parser;
use super::references::Drafts;
use super::search_path::SearchPath;
use crate::scene::error::SceneError;

/// Where the text of a scene comes from.
#[derive(Clone, Debug)]
pub enum SceneSource<'a> {
    /// A file.
    File(PathBuf),
    /// A text; the files that it names are looked for in the working directory.
    Text {
        /// What it is called in messages.
        name: &'a str,
        /// The XML.
        text: &'a str,
    },
}

/// A scene file, its includes and references resolved into a tree of objects.
#[derive(Debug)]
pub struct Document {
    /// The `<scene>`.
    pub root: Arc<Object>,
    search_path: SearchPath,
    /// What `$models` stands for in the scene.
    models: Option<String>,
}

impl Document {
    /// The file that a parameter of `object` names, looked for in the directories of `<path>` (the last one
    /// first), beside the scene file, and in the working directory.
    ///
    /// As in Mitsuba, neither the directory of an included file nor the `<path>`s in it count here.
    pub fn resolve(
        &self,
        object: &Object,
        parameter: &str,
        filename: &str,
    ) -> Result<PathBuf, SceneError> {
        self.search_path.find(filename).map_err(|message| {
            let in_models = |models: &String| Path::new(filename).starts_with(models);
            let hint = match self.models.as_ref().is_some_and(in_models) {
                true => "; `cohort models` downloads the models, and `--models DIR` or COHORT_MODELS says where they are",
                false => "",
            };
            object.parameter_error(parameter, message + hint)
        })
    }
}

/// Reads a scene, with `definitions` (name and value) for its `$name`s. `suggestions` take the place of the scene's
/// own `<default>`s; a scene may also have no use for them.
///
/// # Errors
/// When anything in it is not as Mitsuba 3 expects it, when a file cannot be read, and when the scene does not use
/// one of the definitions.
pub fn parse(
    source: &SceneSource,
    definitions: &[(String, String)],
    suggestions: &[(String, String)],
) -> Result<Document, SceneError> {
    let mut parser = Parser {
        definitions: Definitions::new(definitions, suggestions)?,
        drafts: Drafts::default(),
        included_files: 0,
    };
    let search_path = SearchPath::working_directory();
    let (text, mut file) = match source {
        SceneSource::File(path) => {
            let text = file::read_text(path).map_err(|error| SceneError::Unreadable {
                path: path.clone(),
                error,
            })?;
            (Cow::Owned(text), File::main(path, search_path))
        }
        SceneSource::Text { name, text } => {
            let path = PathBuf::from(format!("<{name}>"));
            (Cow::Borrowed(*text), File::main(&path, search_path))
        }
    };
    let scene = parser.scene(&text, &mut file)?;
    parser.definitions.check_used()?;
    Ok(Document {
        root: parser.drafts.connect(scene)?,
        search_path: file.search_path,
        models: parser.definitions.value("models").map(str::to_owned),
    })
}
