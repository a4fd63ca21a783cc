//! How a stage of meshes is drawn.
//!
//! [`raytrace`] is the truth that everything else is held to.

pub mod exposure;
pub mod raytrace;
