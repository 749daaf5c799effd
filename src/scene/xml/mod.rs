//! Mitsuba 3's XML, from text to a tree of plugin objects with everything resolved.
//!
//! Nothing here knows what a plugin means. [`parse`] substitutes `$name`, follows `<include>`, checks every
//! element and attribute, composes transforms and connects references; [`Object`] then hands out parameters
//! by name and type, and names those that nobody asked for.
//!
//! The semantics are those of Mitsuba 3.9.1, found by experiment. It is stricter where Mitsuba would let a mistake
//! pass in silence: numbers have to be finite, two nested objects cannot have one name, and stray text is an error.

mod attributes;
mod definitions;
mod document;
mod file;
mod object;
mod parser;
mod position;
mod references;
mod search_path;
mod transform;
mod value;

pub use document::{Document, SceneSource, parse};
pub use object::{Child, Class, NamedSpectrum, Object, SpectrumProperty};
pub use value::{SpectrumValue, Value};

#[cfg(test)]
mod tests;
