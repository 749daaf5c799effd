//! `<default name value>` and `$name`.

use crate::scene::error::{SceneError, list};

/// The names that `$name` stands for, longest first.
pub(super) struct Definitions {
    entries: Vec<Definition>,
}

struct Definition {
    name: String,
    value: String,
    given_by_caller: bool,
    used: bool,
}

impl Definitions {
    /// The caller's definitions, which win over every `<default>` and must be used, and its suggestions, which only
    /// win over a `<default>`.
    pub(super) fn new(
        given: &[(String, String)],
        suggestions: &[(String, String)],
    ) -> Result<Self, SceneError> {
        let mut definitions = Self {
            entries: Vec::new(),
        };
        for (name, value) in given {
            if name.is_empty() {
                return Err(SceneError::Definition(format!(
                    "the definition `={value}` has no name; it has to be name=value"
                )));
            }
            if definitions.entries.iter().any(|entry| entry.name == *name) {
                return Err(SceneError::Definition(format!(
                    "`{name}` is defined twice; define it once"
                )));
            }
            definitions.insert(name, value, true);
        }
        for (name, value) in suggestions {
            definitions.add_default(name, value);
        }
        Ok(definitions)
    }

    /// Gives `name` a value unless it has one.
    pub(super) fn add_default(&mut self, name: &str, value: &str) {
        if !self.entries.iter().any(|entry| entry.name == name) {
            self.insert(name, value, false);
        }
    }

    fn insert(&mut self, name: &str, value: &str, given_by_caller: bool) {
        let place = self
            .entries
            .partition_point(|entry| entry.name.len() >= name.len());
        let definition = Definition {
            name: name.to_owned(),
            value: value.to_owned(),
            given_by_caller,
            used: false,
        };
        self.entries.insert(place, definition);
    }

    /// What `name` stands for.
    pub(super) fn value(&self, name: &str) -> Option<&str> {
        let entry = self.entries.iter().find(|entry| entry.name == name);
        entry.map(|entry| entry.value.as_str())
    }

    /// `text` with every `$name` replaced by the longest name that fits, and `\$` by a dollar sign.
    /// Values are not searched for further names. The error is the message.
    pub(super) fn substitute(&mut self, text: &str) -> Result<String, String> {
        let mut result = String::with_capacity(text.len());
        let mut rest = text;
        while let Some(position) = rest.find('$') {
            let (before, from_dollar) = rest.split_at(position);
            let after = &from_dollar[1..];
            if let Some(before) = before.strip_suffix('\\') {
                result.push_str(before);
                result.push('$');
                rest = after;
                continue;
            }
            result.push_str(before);
            let Some(entry) = self
                .entries
                .iter_mut()
                .find(|entry| after.starts_with(&entry.name))
            else {
                return Err(self.undefined(after));
            };
            entry.used = true;
            result.push_str(&entry.value);
            rest = &after[entry.name.len()..];
        }
        result.push_str(rest);
        Ok(result)
    }

    fn undefined(&self, after_dollar: &str) -> String {
        let end = after_dollar
            .find(|c: char| !c.is_alphanumeric() && c != '_')
            .unwrap_or(after_dollar.len());
        format!(
            "`${}` is not defined; defined up to here: {} (write \\$ for a dollar sign)",
            &after_dollar[..end],
            list(self.names(|_| true))
        )
    }

    /// An error when the scene used not every definition of the caller.
    pub(super) fn check_used(&self) -> Result<(), SceneError> {
        let unused = self.names(|entry| entry.given_by_caller && !entry.used);
        if unused.is_empty() {
            return Ok(());
        }
        Err(SceneError::Definition(format!(
            "the scene does not use the definition {}; it uses: {}",
            list(unused),
            list(self.names(|entry| entry.used))
        )))
    }

    fn names(&self, wanted: impl Fn(&Definition) -> bool) -> Vec<&str> {
        let mut names: Vec<&str> = self
            .entries
            .iter()
            .filter(|entry| wanted(entry))
            .map(|entry| entry.name.as_str())
            .collect();
        names.sort_unstable();
        names
    }
}
