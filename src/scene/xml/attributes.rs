//! The attributes of one element, with `$name` substituted and every one checked.

use std::path::Path;
use std::sync::Arc;

use roxmltree::Node;

use super::definitions::Definitions;
use crate::scene::error::{Location, SceneError, list};

/// One element: its tag, where it stands and its attributes.
pub(super) struct Element<'a> {
    pub(super) tag: &'a str,
    pub(super) location: Location,
    attributes: Vec<Attribute<'a>>,
}

struct Attribute<'a> {
    name: &'a str,
    value: String,
    location: Location,
}

impl<'a> Element<'a> {
    /// Reads the attributes of `node`.
    pub(super) fn new(
        node: Node<'a, 'a>,
        file: &Arc<Path>,
        definitions: &mut Definitions,
    ) -> Result<Self, SceneError> {
        let location = location(node, node.range().start, file);
        let mut attributes = Vec::new();
        for attribute in node.attributes() {
            let location = self::location(node, attribute.range().start, file);
            let value = definitions
                .substitute(attribute.value())
                .map_err(|message| SceneError::at(&location, message))?;
            attributes.push(Attribute {
                name: attribute.name(),
                value,
                location,
            });
        }
        Ok(Self {
            tag: node.tag_name().name(),
            location,
            attributes,
        })
    }

    /// An error unless all of `required` and nothing but those and `optional` are there.
    pub(super) fn check(&self, required: &[&str], optional: &[&str]) -> Result<(), SceneError> {
        for attribute in &self.attributes {
            if !required.contains(&attribute.name) && !optional.contains(&attribute.name) {
                let allowed = list(required.iter().chain(optional));
                let message = format!(
                    "<{}> has no attribute `{}`; it has: {allowed}",
                    self.tag, attribute.name
                );
                return Err(SceneError::at(&attribute.location, message));
            }
        }
        match required.iter().find(|name| self.get(name).is_none()) {
            Some(name) => Err(self.error(format!("<{}> needs the attribute `{name}`", self.tag))),
            None => Ok(()),
        }
    }

    /// The value of an attribute, if it is there.
    pub(super) fn get(&self, name: &str) -> Option<&str> {
        self.find(name).map(|attribute| attribute.value.as_str())
    }

    /// The value of an attribute that [`Self::check`] required, or that is empty otherwise.
    pub(super) fn value(&self, name: &str) -> &str {
        self.get(name).unwrap_or_default()
    }

    /// An attribute that has to name something.
    pub(super) fn name(&self, attribute: &str) -> Result<&str, SceneError> {
        match self.value(attribute) {
            "" => Err(self.error(format!(
                "the attribute `{attribute}` of <{}> is empty; give it a name",
                self.tag
            ))),
            name => Ok(name),
        }
    }

    /// The attribute converted by `convert`; its message becomes an error at the attribute.
    pub(super) fn convert<T>(
        &self,
        attribute: &str,
        convert: impl FnOnce(&str) -> Result<T, String>,
    ) -> Result<T, SceneError> {
        convert(self.value(attribute)).map_err(|message| self.attribute_error(attribute, message))
    }

    /// An error in this element.
    pub(super) fn error(&self, message: impl Into<String>) -> SceneError {
        SceneError::at(&self.location, message)
    }

    /// An error in one attribute of this element.
    pub(super) fn attribute_error(&self, name: &str, message: impl Into<String>) -> SceneError {
        let location = self
            .find(name)
            .map_or(&self.location, |found| &found.location);
        SceneError::at(location, message)
    }

    fn find(&self, name: &str) -> Option<&Attribute<'a>> {
        self.attributes
            .iter()
            .find(|attribute| attribute.name == name)
    }
}

/// The place of byte `offset` of the file that `node` is in.
pub(super) fn location(node: Node<'_, '_>, offset: usize, file: &Arc<Path>) -> Location {
    let position = node.document().text_pos_at(offset);
    Location {
        file: file.clone(),
        line: position.row,
        column: position.col,
    }
}
