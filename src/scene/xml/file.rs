//! Whole files: the main one and those that it includes.

use std::path::Path;
use std::sync::Arc;
use std::{fs, io};

use roxmltree::Node;

use super::attributes::Element;
use super::object::Class;
use super::parser::{Parent, Parser, draft, link};
use super::position::Cursor;
use super::references::{DraftIndex, Target};
use super::search_path::SearchPath;
use crate::scene::error::{Location, SceneError};

/// How deep files can include each other, as in Mitsuba.
const MAX_INCLUDES: usize = 15;

/// How many files can be included in all: files that include each other several times multiply.
const MAX_FILES: usize = 1000;

/// A file that is being read.
pub(super) struct File {
    pub(super) path: Arc<Path>,
    pub(super) cursor: Cursor,
    /// Where the files that it names are looked for.
    pub(super) search_path: SearchPath,
    /// The files between the main one and this one, the main one first.
    included_from: Vec<Arc<Path>>,
}

impl File {
    pub(super) fn main(path: &Path, search_path: SearchPath) -> Self {
        Self::new(path, search_path, Vec::new())
    }

    fn included(&self, path: &Path) -> Self {
        let mut included_from = self.included_from.clone();
        included_from.push(self.path.clone());
        Self::new(path, self.search_path.clone(), included_from)
    }

    /// What the file names is looked for beside it first.
    fn new(path: &Path, mut search_path: SearchPath, included_from: Vec<Arc<Path>>) -> Self {
        if let Some(directory) = path.parent()
            && directory != Path::new("")
        {
            search_path.prepend(directory.to_owned());
        }
        let path: Arc<Path> = path.into();
        Self {
            cursor: Cursor::new(path.clone()),
            path,
            search_path,
            included_from,
        }
    }

    /// An error if including `path` here would not end.
    fn check_include(&self, path: &Path) -> Result<(), String> {
        let open = || self.included_from.iter().chain([&self.path]);
        let chain = || {
            let paths = open().map(|path| path.display().to_string());
            let paths: Vec<String> = paths.chain([path.display().to_string()]).collect();
            paths.join(" -> ")
        };
        let wanted = path.canonicalize().ok();
        if wanted.is_some() && open().any(|open| open.canonicalize().ok() == wanted) {
            return Err(format!("a file includes itself: {}", chain()));
        }
        if open().count() >= MAX_INCLUDES {
            return Err(format!(
                "files include each other more than {MAX_INCLUDES} deep: {}",
                chain()
            ));
        }
        Ok(())
    }
}

impl Parser {
    /// Reads the main file and returns its `<scene>`.
    pub(super) fn scene(&mut self, text: &str, file: &mut File) -> Result<DraftIndex, SceneError> {
        let document = read_xml(text, &file.path)?;
        let (node, element) = self.root(&document, file)?;
        if element.tag != Class::Scene.tag() {
            return Err(element.error(format!(
                "the root element has to be <scene version=\"3.0.0\">, not <{}>",
                element.tag
            )));
        }
        element.check(&["version"], &["type", "id", "name"])?;
        let index = self.drafts.add(draft(&element, Class::Scene))?;
        let parent = Parent {
            index,
            depth: 1,
            is_file_root: true,
        };
        self.children(node, parent, file)?;
        Ok(index)
    }

    /// Reads another file as if it stood here: the contents of its `<scene>`, or the one object that it holds.
    pub(super) fn include(
        &mut self,
        element: &Element,
        parent: Parent,
        file: &File,
    ) -> Result<(), SceneError> {
        element.check(&["filename"], &["name"])?;
        let path = element.convert("filename", |name| file.search_path.find(name))?;
        file.check_include(&path)
            .map_err(|message| element.error(message))?;
        self.included_files += 1;
        if self.included_files > MAX_FILES {
            let message = format!("too many files are included; there can be {MAX_FILES} in all");
            return Err(element.error(message));
        }
        let text = read_text(&path).map_err(|error| {
            element.attribute_error(
                "filename",
                format!("cannot read {}: {error}", path.display()),
            )
        })?;
        let mut file = file.included(&path);
        let document = read_xml(&text, &file.path)?;
        let (node, root) = self.root(&document, &mut file)?;
        let parent = match Class::from_tag(root.tag) {
            Some(Class::Scene) => {
                root.check(&["version"], &["type", "id", "name"])?;
                Parent {
                    is_file_root: true,
                    ..parent
                }
            }
            Some(class) => {
                root.check(&["version", "type"], &["id", "name"])?;
                let index = self.drafts.add(draft(&root, class))?;
                self.drafts
                    .add_link(parent.index, link(element, Target::Nested(index)))?;
                Parent {
                    index,
                    depth: parent.depth + 1,
                    is_file_root: true,
                }
            }
            None => {
                return Err(root.error(format!(
                    "<{}> cannot be the root of an included file; a <scene> or an object such as <bsdf> can",
                    root.tag
                )));
            }
        };
        self.children(node, parent, &mut file)
    }

    fn root<'a>(
        &mut self,
        document: &'a roxmltree::Document<'a>,
        file: &mut File,
    ) -> Result<(Node<'a, 'a>, Element<'a>), SceneError> {
        let node = document.root_element();
        let element = Element::new(node, &mut file.cursor, &mut self.definitions)?;
        if element.get("version").is_none() {
            return Err(element.error(format!(
                "the root element <{}> needs the attribute version=\"3.0.0\"",
                element.tag
            )));
        }
        element.convert("version", check_version)?;
        Ok((node, element))
    }
}

/// The text of a scene file.
pub(super) fn read_text(path: &Path) -> io::Result<String> {
    String::from_utf8(fs::read(path)?).map_err(|error| {
        let valid = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + valid.iter().filter(|&&byte| byte == b'\n').count();
        let message = format!("line {line} is not UTF-8, which a scene file has to be");
        io::Error::new(io::ErrorKind::InvalidData, message)
    })
}

fn read_xml<'a>(text: &'a str, path: &Arc<Path>) -> Result<roxmltree::Document<'a>, SceneError> {
    roxmltree::Document::parse(text).map_err(|error| {
        let position = error.pos();
        let location = Location {
            file: path.clone(),
            line: position.row,
            column: position.col,
        };
        SceneError::at(&location, format!("this is not well-formed XML: {error}"))
    })
}

fn check_version(version: &str) -> Result<(), String> {
    let parts: Option<Vec<u32>> = version.split('.').map(|part| part.parse().ok()).collect();
    match parts.as_deref() {
        Some([major, _, _]) if *major >= 2 => Ok(()),
        Some([_, _, _]) => Err(format!(
            "version {version} is older than Mitsuba 3; bring the file to version 3.0.0"
        )),
        _ => Err(format!(
            "`{version}` is not a version; write three numbers such as 3.0.0"
        )),
    }
}
