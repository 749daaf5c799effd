//! What is rendered: scene files, shapes, materials, lights and cameras.

pub mod error;
pub mod mesh;
pub mod xml;
