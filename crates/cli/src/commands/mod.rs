//! One module a command.

pub(crate) mod animate;
pub(crate) mod bench;
pub(crate) mod chain;
mod checked;
mod drawing;
pub(crate) mod export;
mod knobs;
pub(crate) mod mesh;
pub(crate) mod new;
pub(crate) mod paper;
pub(crate) mod power;
pub(crate) mod render;
pub(crate) mod report;
pub(crate) mod scene;
pub(crate) mod serve;
pub(crate) mod stats;
mod stored;
pub(crate) mod study;
pub(crate) mod technique;
