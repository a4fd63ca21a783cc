//! One module a command.

pub mod animate;
mod drawing;
pub mod render;
pub mod scene;
pub mod serve;
pub mod stats;
pub mod study;
