//! Integration tests of the renderer.
#![allow(clippy::unwrap_used)]

mod golden;
mod reference;
mod skips;
mod support;
