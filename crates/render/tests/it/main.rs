//! Integration tests of the renderer.
#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

mod golden;
mod instruction_sets;
mod reference;
mod skips;
mod support;
