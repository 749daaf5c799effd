//! The attributes of one element, with `$name` substituted and every one checked.

use roxmltree::Node;

use super::definitions::Definitions;
use super::position::{Cursor, advance};
use crate::scene::error::{Location, SceneError, list};

/// One element: its tag, where it stands and its attributes.
pub(super) struct Element<'a> {
    pub(super) tag: &'a str,
    pub(super) location: Location,
    /// From the beginning of the element on.
    text: &'a str,
    attributes: Vec<Attribute<'a>>,
}

struct Attribute<'a> {
    name: &'a str,
    value: String,
    /// Its place in bytes from the beginning of the element.
    offset: usize,
}

impl<'a> Element<'a> {
    /// Reads the attributes of `node`.
    pub(super) fn new(
        node: Node<'a, 'a>,
        cursor: &mut Cursor,
        definitions: &mut Definitions,
    ) -> Result<Self, SceneError> {
        let start = node.range().start;
        let mut element = Self {
            tag: node.tag_name().name(),
            location: cursor.location(node),
            text: &node.document().input_text()[start..],
            attributes: Vec::new(),
        };
        for attribute in node.attributes() {
            let offset = attribute.range().start - start;
            let value = definitions
                .substitute(attribute.value())
                .map_err(|message| SceneError::at(&element.place(offset), message))?;
            element.attributes.push(Attribute {
                name: attribute.name(),
                value,
                offset,
            });
        }
        Ok(element)
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
                return Err(SceneError::at(&self.place(attribute.offset), message));
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
        let offset = self.find(name).map_or(0, |attribute| attribute.offset);
        SceneError::at(&self.place(offset), message)
    }

    fn place(&self, offset: usize) -> Location {
        advance(&self.location, &self.text[..offset])
    }

    fn find(&self, name: &str) -> Option<&Attribute<'a>> {
        self.attributes
            .iter()
            .find(|attribute| attribute.name == name)
    }
}
