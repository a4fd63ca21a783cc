//! Surfaces of triangles: read, checked, repaired, simplified and measured; and models made of arithmetic alone.
//!
//! Lengths are metres, right-handed, y up; counter-clockwise is outside. It does no IO: files come in as bytes.

mod mesh;
#[cfg(test)]
mod shapes;

pub use mesh::{Bounds, Mesh};
