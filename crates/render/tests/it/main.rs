//! Integration tests of the renderer.
#![allow(clippy::unwrap_used)]

mod golden;
mod skips;
mod support;
