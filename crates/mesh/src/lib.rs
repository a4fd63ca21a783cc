//! Surfaces of triangles: read, checked, repaired, simplified and measured; and models made of arithmetic alone.
//!
//! Lengths are metres, right-handed, y up; counter-clockwise is outside. It does no IO: files come in as bytes.

mod check;
mod distance;
mod fault;
mod lod;
mod made;
mod mesh;
mod model;
mod nearest;
mod random;
mod read;
mod repair;
#[cfg(test)]
mod shapes;
mod topology;
mod write;

pub use check::{Report, check, check_model};
pub use distance::{Distance, Measured, OneWay, SAMPLES};
pub use fault::Fault;
pub use lod::{Attributes, LEAST, Level, Missed, Refused, ladder, levels, levels_key};
pub use made::Made;
pub use mesh::{Bounds, Mesh, sha256};
pub use model::{Animation, Channel, Model, Node, Part, Skin, Transform, Values};
pub use nearest::{Nearest, Surface};
pub use read::{Format, LIMIT, Unit, read};
pub use repair::{Repaired, repair, repair_model};
pub use write::write_glb;
