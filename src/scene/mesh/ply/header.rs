//! The header of a PLY file.

use crate::scene::mesh::MeshProblem;

/// How the numbers behind the header are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    BinaryLittleEndian,
    BinaryBigEndian,
}

/// The type of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    /// Its size in binary files, in bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }

    fn from_name(name: &str) -> Result<Self, String> {
        Ok(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => {
                return Err(format!(
                    "unknown type `{name}`; known are char, uchar, short, ushort, int, uint, float and double"
                ));
            }
        })
    }
}

/// What a property holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) kind: Kind,
}

/// A kind of element, such as "vertex", and how many of them there are.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

impl Element {
    /// The number of the property called `name`.
    pub(super) fn position(&self, name: &str) -> Option<usize> {
        self.properties
            .iter()
            .position(|property| property.name == name)
    }

    /// The fewest bytes that one such element takes.
    pub(super) fn smallest_size(&self, encoding: Encoding) -> usize {
        let size = |property: &Property| match (encoding, property.kind) {
            // A digit and the space behind it, which the very last one can lack.
            (Encoding::Ascii, _) => 2,
            (_, Kind::Scalar(scalar)) => scalar.size(),
            (_, Kind::List { count, .. }) => count.size(),
        };
        self.properties.iter().map(size).sum()
    }
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
}

/// Reads the header at the beginning of `bytes`. Returns it and what is behind it.
pub(super) fn read(bytes: &[u8]) -> Result<(Header, &[u8]), MeshProblem> {
    let mut lines = Lines { rest: bytes };
    if lines.next().as_deref() != Some("ply") {
        let message = "this is not a PLY file: the first line has to be `ply`";
        return Err(MeshProblem::Format(message.to_owned()));
    }
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut number = 1;
    loop {
        number += 1;
        let in_line = |message: String| {
            MeshProblem::Format(format!("line {number} of the PLY header: {message}"))
        };
        let Some(line) = lines.next() else {
            return Err(in_line("the file ends without `end_header`".to_owned()));
        };
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match words[..] {
            [] | ["comment" | "obj_info", ..] => {}
            ["format", name, "1.0"] => encoding = Some(format(name).map_err(in_line)?),
            ["element", name, count] => {
                elements.push(element(name, count, &elements).map_err(in_line)?);
            }
            ["property", ref words @ ..] => {
                let element = elements.last_mut().ok_or_else(|| {
                    in_line("a `property` has to follow its `element`".to_owned())
                })?;
                add_property(words, element).map_err(in_line)?;
            }
            ["end_header"] => break,
            _ => return Err(in_line(format!("`{}` is not understood", line.trim()))),
        }
    }
    let encoding = encoding.ok_or_else(|| {
        MeshProblem::Format("the PLY header has no line `format ... 1.0`".to_owned())
    })?;
    Ok((Header { encoding, elements }, lines.rest))
}

fn format(name: &str) -> Result<Encoding, String> {
    match name {
        "ascii" => Ok(Encoding::Ascii),
        "binary_little_endian" => Ok(Encoding::BinaryLittleEndian),
        "binary_big_endian" => Ok(Encoding::BinaryBigEndian),
        _ => Err(format!(
            "unknown format `{name}`; known are ascii, binary_little_endian and binary_big_endian"
        )),
    }
}

fn element(name: &str, count: &str, elements: &[Element]) -> Result<Element, String> {
    if elements.iter().any(|element| element.name == name) {
        return Err(format!("a second element `{name}`"));
    }
    Ok(Element {
        name: name.to_owned(),
        count: count
            .parse()
            .map_err(|_| format!("`{count}` is not a number of elements"))?,
        properties: Vec::new(),
    })
}

fn add_property(words: &[&str], element: &mut Element) -> Result<(), String> {
    let (kind, name) = match *words {
        ["list", count, item, name] => {
            let (count, item) = (Scalar::from_name(count)?, Scalar::from_name(item)?);
            if !count.is_integer() {
                return Err("the length of a list has to be of an integer type".to_owned());
            }
            (Kind::List { count, item }, name)
        }
        [scalar, name] if scalar != "list" => (Kind::Scalar(Scalar::from_name(scalar)?), name),
        _ => {
            return Err(
                "a property has to be `property TYPE NAME` or `property list TYPE TYPE NAME`"
                    .to_owned(),
            );
        }
    };
    if element.position(name).is_some() {
        return Err(format!("a second property `{name}` of `{}`", element.name));
    }
    element.properties.push(Property {
        name: name.to_owned(),
        kind,
    });
    Ok(())
}

/// The lines of the header; they can end with a carriage return.
struct Lines<'a> {
    rest: &'a [u8],
}

impl Iterator for Lines<'_> {
    type Item = String;

    fn next(&mut self) -> Option<String> {
        let end = self.rest.iter().position(|&byte| byte == b'\n')?;
        let line = String::from_utf8_lossy(&self.rest[..end]);
        let line = line.trim_end_matches('\r').to_owned();
        self.rest = &self.rest[end + 1..];
        Some(line)
    }
}
