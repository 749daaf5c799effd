//! The walk over the elements of a scene file.

use glam::DMat4;
use roxmltree::Node;

use super::attributes::Element;
use super::definitions::Definitions;
use super::file::File;
use super::object::{Class, Parameter};
use super::references::{Draft, DraftIndex, Drafts, Link, MAX_DEPTH, Target};
use super::transform;
use super::value::{self, SpectrumValue, Value};
use crate::scene::error::{SceneError, list};

/// What has been read of a scene so far.
pub(super) struct Parser {
    pub(super) definitions: Definitions,
    pub(super) drafts: Drafts,
    pub(super) included_files: usize,
}

/// The object whose children are being read.
#[derive(Clone, Copy)]
pub(super) struct Parent {
    pub(super) index: DraftIndex,
    /// How many objects stand around its children.
    pub(super) depth: usize,
    /// Whether it is the root element of its file, the one place where `<path>` may stand.
    pub(super) is_file_root: bool,
}

impl Parser {
    /// Reads what stands inside the element of `parent`.
    pub(super) fn children(
        &mut self,
        node: Node,
        parent: Parent,
        file: &mut File,
    ) -> Result<(), SceneError> {
        for child in node.children() {
            if child.is_element() {
                let element = Element::new(child, &mut file.cursor, &mut self.definitions)?;
                self.element(child, &element, parent, file)?;
            } else {
                check_no_text(child, file)?;
            }
        }
        Ok(())
    }

    fn element(
        &mut self,
        node: Node,
        element: &Element,
        parent: Parent,
        file: &mut File,
    ) -> Result<(), SceneError> {
        let class = match element.tag {
            "spectrum" if element.get("type").is_some() => Some(Class::Texture),
            tag => Class::from_tag(tag),
        };
        if let Some(class) = class {
            element.check(&["type"], &["id", "name"])?;
            return self.object(node, element, class, parent, file);
        }
        if element.tag == "transform" {
            element.check(&["name"], &[])?;
            let matrix = self.transform(node, file)?;
            return self.parameter(element, parent, Value::Transform(matrix));
        }
        check_no_children(node, element, file)?;
        match element.tag {
            "include" => self.include(element, parent, file),
            "ref" => {
                element.check(&["id"], &["name"])?;
                let target = Target::Id(element.name("id")?.to_owned());
                self.drafts.add_link(parent.index, link(element, target))
            }
            "alias" => {
                element.check(&["id", "as"], &[])?;
                let (id, alias) = (element.name("id")?, element.name("as")?);
                self.drafts.alias(id, alias, &element.location)
            }
            "default" => {
                element.check(&["name", "value"], &[])?;
                self.definitions
                    .add_default(element.name("name")?, element.value("value"));
                Ok(())
            }
            "path" => search_directory(element, parent, file),
            _ => {
                let value = parse_value(element, file)?;
                self.parameter(element, parent, value)
            }
        }
    }

    fn object(
        &mut self,
        node: Node,
        element: &Element,
        class: Class,
        parent: Parent,
        file: &mut File,
    ) -> Result<(), SceneError> {
        if class == Class::Scene {
            return Err(element.error("a <scene> cannot stand inside another object"));
        }
        if parent.depth >= MAX_DEPTH {
            return Err(element.error(format!("objects are nested more than {MAX_DEPTH} deep")));
        }
        element.name("type")?;
        let index = self.drafts.add(draft(element, class))?;
        self.drafts
            .add_link(parent.index, link(element, Target::Nested(index)))?;
        let parent = Parent {
            index,
            depth: parent.depth + 1,
            is_file_root: false,
        };
        self.children(node, parent, file)
    }

    fn parameter(
        &mut self,
        element: &Element,
        parent: Parent,
        value: Value,
    ) -> Result<(), SceneError> {
        let parameter = Parameter {
            name: element.name("name")?.to_owned(),
            value,
            location: element.location.clone(),
        };
        self.drafts.add_parameter(parent.index, parameter)
    }

    fn transform(&mut self, node: Node, file: &mut File) -> Result<DMat4, SceneError> {
        let mut matrix = DMat4::IDENTITY;
        for child in node.children() {
            if !child.is_element() {
                check_no_text(child, file)?;
                continue;
            }
            let element = Element::new(child, &mut file.cursor, &mut self.definitions)?;
            matrix = transform::step(&element)? * matrix;
            check_no_children(child, &element, file)?;
            if !matrix.is_finite() {
                return Err(element.error("the numbers of the transform are too large"));
            }
        }
        Ok(matrix)
    }
}

fn parse_value(element: &Element, file: &File) -> Result<Value, SceneError> {
    if !matches!(element.tag, "point" | "vector" | "spectrum") {
        check_parameter_tag(element)?;
        element.check(&["name", "value"], &[])?;
    }
    match element.tag {
        "boolean" => element.convert("value", value::boolean).map(Value::Boolean),
        "integer" => element.convert("value", value::integer).map(Value::Integer),
        "float" => element.convert("value", value::number).map(Value::Float),
        "string" => Ok(Value::String(element.value("value").to_owned())),
        "rgb" => element.convert("value", value::rgb).map(Value::Rgb),
        "spectrum" => parse_spectrum(element, file).map(Value::Spectrum),
        _ => {
            if element.get("value").is_none() {
                element.check(&["name", "x", "y", "z"], &[])?;
            }
            transform::components(element, &["name"], 0.0).map(Value::Vector)
        }
    }
}

fn parse_spectrum(element: &Element, file: &File) -> Result<SpectrumValue, SceneError> {
    element.check(&["name"], &["value", "filename"])?;
    match (element.get("value"), element.get("filename")) {
        (Some(_), None) => element.convert("value", value::spectrum),
        (None, Some(_)) => element.convert("filename", |name| {
            value::spectrum_file(&file.search_path.find(name)?)
        }),
        _ => Err(element.error("<spectrum> needs either `value` or `filename`")),
    }
}

fn search_directory(element: &Element, parent: Parent, file: &mut File) -> Result<(), SceneError> {
    element.check(&["value"], &[])?;
    if !parent.is_file_root {
        return Err(element.error("<path> can only stand directly inside the root element"));
    }
    let directory = element.convert("value", |name| match file.search_path.find(name)? {
        directory if directory.is_dir() => Ok(directory),
        _ => Err(format!("`{name}` is not a directory")),
    })?;
    file.search_path.prepend(directory);
    Ok(())
}

/// The object that `element` begins.
pub(super) fn draft(element: &Element, class: Class) -> Draft {
    Draft {
        class,
        plugin: element.get("type").unwrap_or(class.tag()).to_owned(),
        id: element
            .get("id")
            .filter(|id| !id.is_empty())
            .map(str::to_owned),
        location: element.location.clone(),
        parameters: Vec::new(),
        links: Vec::new(),
    }
}

/// The place where `element` nests or names an object.
pub(super) fn link(element: &Element, target: Target) -> Link {
    Link {
        name: element.value("name").to_owned(),
        location: element.location.clone(),
        target,
    }
}

fn check_parameter_tag(element: &Element) -> Result<(), SceneError> {
    const PARAMETERS: [&str; 9] = [
        "boolean",
        "integer",
        "float",
        "string",
        "point",
        "vector",
        "rgb",
        "spectrum",
        "transform",
    ];
    const STEPS: [&str; 5] = ["translate", "rotate", "scale", "matrix", "lookat"];
    let tag = element.tag;
    if PARAMETERS.contains(&tag) {
        return Ok(());
    }
    if STEPS.contains(&tag) {
        return Err(element.error(format!("<{tag}> can only stand inside a <transform>")));
    }
    Err(element.error(format!(
        "unknown element <{tag}>; parameters are: {}; objects are: {}; besides: ref, alias, default, include, path",
        list(PARAMETERS),
        list(Class::ALL)
    )))
}

fn check_no_children(node: Node, element: &Element, file: &mut File) -> Result<(), SceneError> {
    for child in node.children() {
        if child.is_element() {
            let place = file.cursor.location(child);
            let message = format!("nothing can stand inside <{}>", element.tag);
            return Err(SceneError::at(&place, message));
        }
        check_no_text(child, file)?;
    }
    Ok(())
}

fn check_no_text(node: Node, file: &mut File) -> Result<(), SceneError> {
    let text = match node.is_text() {
        true => node.text().unwrap_or_default(),
        false => "",
    };
    if text.trim().is_empty() {
        return Ok(());
    }
    let place = file.cursor.location(node);
    let message = format!("the text `{}` has no meaning here", text.trim());
    Err(SceneError::at(&place, message))
}
