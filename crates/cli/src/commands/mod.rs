//! One module a command.

pub mod animate;
pub mod bench;
mod drawing;
pub mod paper;
pub mod power;
pub mod render;
pub mod report;
pub mod scene;
pub mod serve;
pub mod stats;
pub mod study;
