//! What is rendered: scene files, shapes, materials, lights and cameras.

pub mod mesh;
