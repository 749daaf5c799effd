//! From bytes of a text to lines and columns.

use std::path::Path;
use std::sync::Arc;

use roxmltree::Node;

use crate::scene::error::Location;

/// Turns byte offsets into locations, in linear time altogether as long as the offsets increase.
pub(super) struct Cursor {
    offset: usize,
    location: Location,
}

impl Cursor {
    /// At the beginning of `file`.
    pub(super) fn new(file: Arc<Path>) -> Self {
        Self {
            offset: 0,
            location: Location {
                file,
                line: 1,
                column: 1,
            },
        }
    }

    /// Where `node` begins.
    pub(super) fn location(&mut self, node: Node) -> Location {
        let offset = node.range().start;
        if offset < self.offset {
            *self = Self::new(self.location.file.clone());
        }
        let passed = &node.document().input_text()[self.offset..offset];
        self.location = advance(&self.location, passed);
        self.offset = offset;
        self.location.clone()
    }
}

/// The location behind `text`, which begins at `from`.
pub(super) fn advance(from: &Location, text: &str) -> Location {
    let mut location = from.clone();
    for character in text.chars() {
        if character == '\n' {
            location.line += 1;
            location.column = 1;
        } else {
            location.column += 1;
        }
    }
    location
}
