//! One plugin object: its parameters by name and type, its nested objects, and what nobody asked for.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use glam::{DMat4, DVec3};

use super::value::{SpectrumValue, Value};
use crate::scene::error::{Location, SceneError, list};

/// What kind of thing an object is, told by its element.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Class {
    /// `<scene>`
    Scene,
    /// `<shape>`
    Shape,
    /// `<bsdf>`
    Bsdf,
    /// `<emitter>`
    Emitter,
    /// `<sensor>`
    Sensor,
    /// `<film>`
    Film,
    /// `<rfilter>`
    ReconstructionFilter,
    /// `<sampler>`
    Sampler,
    /// `<integrator>`
    Integrator,
    /// `<texture>`, or `<spectrum type=...>`
    Texture,
    /// `<medium>`
    Medium,
    /// `<phase>`
    Phase,
    /// `<volume>`
    Volume,
}

impl Class {
    pub(super) const ALL: [Self; 13] = [
        Self::Scene,
        Self::Shape,
        Self::Bsdf,
        Self::Emitter,
        Self::Sensor,
        Self::Film,
        Self::ReconstructionFilter,
        Self::Sampler,
        Self::Integrator,
        Self::Texture,
        Self::Medium,
        Self::Phase,
        Self::Volume,
    ];

    /// The name of the element.
    pub fn tag(self) -> &'static str {
        match self {
            Self::Scene => "scene",
            Self::Shape => "shape",
            Self::Bsdf => "bsdf",
            Self::Emitter => "emitter",
            Self::Sensor => "sensor",
            Self::Film => "film",
            Self::ReconstructionFilter => "rfilter",
            Self::Sampler => "sampler",
            Self::Integrator => "integrator",
            Self::Texture => "texture",
            Self::Medium => "medium",
            Self::Phase => "phase",
            Self::Volume => "volume",
        }
    }

    pub(super) fn from_tag(tag: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|class| class.tag() == tag)
    }
}

impl fmt::Display for Class {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.tag())
    }
}

/// A parameter as it is written.
#[derive(Clone, Debug)]
pub(super) struct Parameter {
    pub(super) name: String,
    pub(super) value: Value,
    pub(super) location: Location,
}

/// An object nested in another, or referred to there.
#[derive(Clone, Debug)]
pub struct Child {
    /// The name under which it is nested, often empty.
    pub name: String,
    /// The object; every reference to one id gives the same `Arc`.
    pub object: Arc<Object>,
    /// Where it is nested, or where the reference stands.
    pub location: Location,
}

/// A spectrum that a parameter can have in several forms.
#[derive(Clone, Debug)]
pub enum SpectrumProperty {
    /// `<float>` or `<integer>`: for a reflectance the same at every wavelength, for an emission that much white.
    Number(f64),
    /// A constant `<spectrum>`: the same at every wavelength.
    Constant(f64),
    /// `<rgb>`: linear sRGB.
    Rgb([f64; 3]),
    /// `<spectrum>`: at least two pairs of wavelength (nm, strictly increasing) and value.
    List(Vec<[f64; 2]>),
    /// A nested `<texture>`.
    Texture(Arc<Object>),
}

/// A spectrum, or the name of one.
#[derive(Clone, Debug)]
pub enum NamedSpectrum<'o> {
    /// `<string>`: a name.
    Name(&'o str),
    /// The spectrum itself.
    Spectrum(SpectrumProperty),
}

/// An object of the scene file: a plugin, its parameters and nested objects.
///
/// The getters remember what they were asked for. When a plugin has asked for everything it knows,
/// [`Object::finish`] makes whatever is left an error.
#[derive(Debug)]
pub struct Object {
    /// What kind of thing it is.
    pub class: Class,
    /// The plugin, `type=` in the file.
    pub plugin: String,
    /// Its `id=`, if it has one.
    pub id: Option<String>,
    /// Where it is written.
    pub location: Location,
    pub(super) parameters: Vec<Parameter>,
    pub(super) children: Vec<Child>,
    pub(super) asked: Mutex<Asked>,
}

/// What a plugin supports, told by what it asked for, in that order.
#[derive(Debug, Default)]
pub(super) struct Asked {
    parameters: Vec<&'static str>,
    classes: Vec<Class>,
}

impl Object {
    /// A `<boolean>`.
    pub fn boolean(&self, name: &'static str) -> Result<Option<bool>, SceneError> {
        self.convert(name, "<boolean>", |value| match value {
            Value::Boolean(boolean) => Some(*boolean),
            _ => None,
        })
    }

    /// A `<boolean>`, or `default` if it is not there.
    pub fn boolean_or(&self, name: &'static str, default: bool) -> Result<bool, SceneError> {
        Ok(self.boolean(name)?.unwrap_or(default))
    }

    /// An `<integer>`.
    pub fn integer(&self, name: &'static str) -> Result<Option<i64>, SceneError> {
        self.convert(name, "<integer>", |value| match value {
            Value::Integer(integer) => Some(*integer),
            _ => None,
        })
    }

    /// An `<integer>`, or `default` if it is not there.
    pub fn integer_or(&self, name: &'static str, default: i64) -> Result<i64, SceneError> {
        Ok(self.integer(name)?.unwrap_or(default))
    }

    /// A `<float>`; an `<integer>` will do. Always finite.
    pub fn float(&self, name: &'static str) -> Result<Option<f64>, SceneError> {
        self.convert(name, "<float> or <integer>", |value| match value {
            Value::Float(float) => Some(*float),
            Value::Integer(integer) => Some(*integer as f64),
            _ => None,
        })
    }

    /// A `<float>` or `<integer>`, or `default` if it is not there.
    pub fn float_or(&self, name: &'static str, default: f64) -> Result<f64, SceneError> {
        Ok(self.float(name)?.unwrap_or(default))
    }

    /// A `<string>`.
    pub fn string(&self, name: &'static str) -> Result<Option<&str>, SceneError> {
        self.convert(name, "<string>", |value| match value {
            Value::String(string) => Some(string.as_str()),
            _ => None,
        })
    }

    /// A `<string>`, or `default` if it is not there.
    pub fn string_or<'a>(
        &'a self,
        name: &'static str,
        default: &'a str,
    ) -> Result<&'a str, SceneError> {
        Ok(self.string(name)?.unwrap_or(default))
    }

    /// A `<point>` or `<vector>`.
    pub fn vector(&self, name: &'static str) -> Result<Option<DVec3>, SceneError> {
        self.convert(name, "<point> or <vector>", |value| match value {
            Value::Vector(vector) => Some(*vector),
            _ => None,
        })
    }

    /// A `<transform>`, affine; it may be singular.
    pub fn transform(&self, name: &'static str) -> Result<Option<DMat4>, SceneError> {
        self.convert(name, "<transform>", |value| match value {
            Value::Transform(matrix) => Some(*matrix),
            _ => None,
        })
    }

    /// A spectrum in any of its forms.
    pub fn spectrum(&self, name: &'static str) -> Result<Option<SpectrumProperty>, SceneError> {
        let expected = "<float>, <rgb>, <spectrum> or <texture>";
        if let Some(child) = self.child_named(name) {
            if child.object.class != Class::Texture {
                return Err(self.wrong_type(name, expected, child.object.class.tag()));
            }
            return Ok(Some(SpectrumProperty::Texture(child.object.clone())));
        }
        self.convert(name, expected, |value| match value {
            Value::Float(float) => Some(SpectrumProperty::Number(*float)),
            Value::Integer(integer) => Some(SpectrumProperty::Number(*integer as f64)),
            Value::Rgb(rgb) => Some(SpectrumProperty::Rgb(*rgb)),
            Value::Spectrum(SpectrumValue::Constant(constant)) => {
                Some(SpectrumProperty::Constant(*constant))
            }
            Value::Spectrum(SpectrumValue::List(list)) => {
                Some(SpectrumProperty::List(list.clone()))
            }
            _ => None,
        })
    }

    /// Whether there is a parameter or a nested object called `name`; asking does not make it a known one.
    pub fn has(&self, name: &str) -> bool {
        self.parameters.iter().any(|found| found.name == name)
            || self.children.iter().any(|child| child.name == name)
    }

    /// A spectrum in any of its forms, or the name of one that is known.
    pub fn named_spectrum(
        &self,
        name: &'static str,
    ) -> Result<Option<NamedSpectrum<'_>>, SceneError> {
        let parameter = self.parameters.iter().find(|found| found.name == name);
        if let Some(Value::String(known)) = parameter.map(|found| &found.value) {
            self.ask_parameter(name);
            return Ok(Some(NamedSpectrum::Name(known)));
        }
        Ok(self.spectrum(name)?.map(NamedSpectrum::Spectrum))
    }

    /// The nested object of `class`; more than one is an error.
    pub fn child(&self, class: Class) -> Result<Option<&Child>, SceneError> {
        let children = self.children(class);
        if let Some(second) = children.get(1) {
            let message = format!("the {self} has more than one <{class}>; it can have one");
            return Err(SceneError::at(&second.location, message));
        }
        Ok(children.first().copied())
    }

    /// The nested objects of `class` in the order of the file.
    pub fn children(&self, class: Class) -> Vec<&Child> {
        self.ask(|asked| {
            if !asked.classes.contains(&class) {
                asked.classes.push(class);
            }
        });
        self.children
            .iter()
            .filter(|child| child.object.class == class)
            .collect()
    }

    /// The object nested under `name`.
    pub fn child_named(&self, name: &'static str) -> Option<&Child> {
        self.ask_parameter(name);
        self.children.iter().find(|child| child.name == name)
    }

    /// An error for every parameter and nested object that no getter was asked for.
    pub fn finish(&self) -> Result<(), SceneError> {
        let asked = self.asked.lock().unwrap_or_else(PoisonError::into_inner);
        let known = |name: &str| asked.parameters.contains(&name);
        if let Some(parameter) = self.parameters.iter().find(|found| !known(&found.name)) {
            let message = format!(
                "`{}` has no parameter `{}`; it has: {}",
                self.plugin,
                parameter.name,
                list(&asked.parameters)
            );
            return Err(SceneError::at(&parameter.location, message));
        }
        let unknown = self
            .children
            .iter()
            .find(|child| !asked.classes.contains(&child.object.class) && !known(&child.name));
        let Some(child) = unknown else {
            return Ok(());
        };
        let name = match child.name.as_str() {
            "" => String::new(),
            name => format!(" called `{name}`"),
        };
        let message = format!(
            "`{}` takes no {}{name}; it takes the objects: {}; and the parameters: {}",
            self.plugin,
            child.object.class,
            list(&asked.classes),
            list(&asked.parameters)
        );
        Err(SceneError::at(&child.location, message))
    }

    /// The error that this plugin is not one of `supported`.
    pub fn unsupported(&self, supported: &[&str]) -> SceneError {
        self.error(format!(
            "the {self} is not supported; supported are: {}",
            list(supported)
        ))
    }

    /// The error that a parameter which has no default is missing.
    pub fn missing(&self, name: &str) -> SceneError {
        self.error(format!("the {self} needs the parameter `{name}`"))
    }

    /// An error in this object.
    pub fn error(&self, message: impl Into<String>) -> SceneError {
        SceneError::at(&self.location, message)
    }

    /// An error in one parameter of this object, or in the object if the parameter is not there.
    pub fn parameter_error(&self, name: &str, message: impl Into<String>) -> SceneError {
        SceneError::at(self.parameter_location(name), message)
    }

    /// Where a parameter or the object nested under that name is written; the object's own place if it is not there.
    pub fn parameter_location(&self, name: &str) -> &Location {
        let parameter = self.parameters.iter().find(|found| found.name == name);
        let child = self.children.iter().find(|child| child.name == name);
        parameter
            .map(|found| &found.location)
            .or(child.map(|child| &child.location))
            .unwrap_or(&self.location)
    }

    fn convert<'a, T>(
        &'a self,
        name: &'static str,
        expected: &str,
        convert: impl FnOnce(&'a Value) -> Option<T>,
    ) -> Result<Option<T>, SceneError> {
        self.ask_parameter(name);
        if let Some(parameter) = self.parameters.iter().find(|found| found.name == name) {
            return match convert(&parameter.value) {
                Some(value) => Ok(Some(value)),
                None => Err(self.wrong_type(name, expected, parameter.value.tag())),
            };
        }
        match self.children.iter().find(|child| child.name == name) {
            Some(child) => Err(self.wrong_type(name, expected, child.object.class.tag())),
            None => Ok(None),
        }
    }

    fn wrong_type(&self, name: &str, expected: &str, found: &str) -> SceneError {
        self.parameter_error(
            name,
            format!(
                "`{name}` of `{}` has to be {expected}, not <{found}>",
                self.plugin
            ),
        )
    }

    fn ask_parameter(&self, name: &'static str) {
        self.ask(|asked| {
            if !asked.parameters.contains(&name) {
                asked.parameters.push(name);
            }
        });
    }

    fn ask(&self, ask: impl FnOnce(&mut Asked)) {
        ask(&mut self.asked.lock().unwrap_or_else(PoisonError::into_inner));
    }
}

/// "bsdf `diffuse`"
impl fmt::Display for Object {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} `{}`", self.class, self.plugin)
    }
}
