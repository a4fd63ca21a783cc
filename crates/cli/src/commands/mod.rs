//! One module a command.

pub mod animate;
pub mod bench;
pub mod chain;
mod checked;
mod drawing;
pub mod export;
mod knobs;
pub mod new;
pub mod paper;
pub mod power;
pub mod render;
pub mod report;
pub mod scene;
pub mod serve;
pub mod stats;
mod stored;
pub mod study;
pub mod technique;
