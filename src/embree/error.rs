//! What can go wrong in Embree, and in what is handed to it.

use std::fmt;

use thiserror::Error;

use super::raw;

/// Why a device, a mesh or a scene could not be made, or what happened while it was traced.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum EmbreeError {
    /// The library refused.
    #[error("Embree could not {doing}: {message} ({kind})")]
    Library {
        /// What was asked of it, as the end of "could not …".
        doing: &'static str,
        /// The kind of error it reported.
        kind: ErrorKind,
        /// Its own explanation.
        message: String,
    },
    /// A mesh without quads.
    #[error("a mesh needs at least one triangle")]
    EmptyMesh,
    /// More primitives than Embree can number.
    #[error("{count} primitives in one geometry are more than Embree can number (2³² - 2)")]
    TooManyPrimitives {
        /// How many there were.
        count: usize,
    },
    /// A vertex that is not a number, is infinite, or is too large for Embree, which would leave
    /// out its quads without a word.
    #[error(
        "vertex {vertex} is at ({}, {}, {}); coordinates must be finite and below 1.8e18",
        position[0], position[1], position[2]
    )]
    BadVertex {
        /// Which vertex, from 0.
        vertex: usize,
        /// Its position.
        position: [f32; 3],
    },
    /// A quad that refers to a vertex which is not there.
    #[error("quad {quad} refers to vertex {index}, but there are only {vertices} vertices")]
    IndexOutOfRange {
        /// Which quad, from 0.
        quad: usize,
        /// The index it holds.
        index: u32,
        /// How many vertices there are.
        vertices: usize,
    },
    /// The bounds of a user primitive are not finite, too large, or inside out.
    #[error(
        "the bounds of primitive {primitive} of geometry {geometry} must be finite, below 1.8e18 \
         and the right way round, not {min:?} to {max:?}"
    )]
    BadBounds {
        /// The geometry's number in the scene.
        geometry: u32,
        /// The primitive's number in the geometry.
        primitive: u32,
        /// The lower corner.
        min: [f32; 3],
        /// The upper corner.
        max: [f32; 3],
    },
    /// An instance of a scene that has instances itself.
    #[error("an instance cannot stand in a scene that is instanced itself")]
    NestedInstance,
    /// An instance of a scene of another device.
    #[error("a scene can hold instances of scenes of its own device only")]
    OtherDevice,
    /// A map of an instance that single precision cannot invert.
    #[error("the transform of an instance has no inverse in single precision")]
    NoInverse,
    /// A user geometry panicked while a ray was intersected with it. The ray was taken to miss.
    #[error("primitive {primitive} of geometry {geometry} panicked when a ray met it: {message}")]
    UserPanic {
        /// The geometry's number in the scene.
        geometry: u32,
        /// The primitive's number in the geometry.
        primitive: u32,
        /// What the panic said.
        message: String,
    },
}

/// The kinds of error that Embree tells apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorKind {
    /// Anything that has no kind of its own.
    Unknown,
    /// An argument that is not allowed.
    InvalidArgument,
    /// An operation that is not allowed in this state or by this object.
    InvalidOperation,
    /// No memory is left.
    OutOfMemory,
    /// The processor lacks instructions that Embree needs.
    UnsupportedCpu,
    /// The operation was cancelled.
    Cancelled,
}

impl From<raw::RTCError> for ErrorKind {
    fn from(code: raw::RTCError) -> Self {
        match code {
            raw::RTCError::INVALID_ARGUMENT => Self::InvalidArgument,
            raw::RTCError::INVALID_OPERATION => Self::InvalidOperation,
            raw::RTCError::OUT_OF_MEMORY => Self::OutOfMemory,
            raw::RTCError::UNSUPPORTED_CPU => Self::UnsupportedCpu,
            raw::RTCError::CANCELLED => Self::Cancelled,
            raw::RTCError::NONE | raw::RTCError::UNKNOWN => Self::Unknown,
        }
    }
}

impl fmt::Display for ErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Unknown => "unknown error",
            Self::InvalidArgument => "invalid argument",
            Self::InvalidOperation => "invalid operation",
            Self::OutOfMemory => "out of memory",
            Self::UnsupportedCpu => "this processor is not supported",
            Self::Cancelled => "cancelled",
        })
    }
}
