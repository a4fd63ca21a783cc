//! The scene crate from outside: files in, theatres out.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    missing_docs,
    reason = "a test that fails here says where, and prints what it measured"
)]

mod assets;
mod cloth;
mod drawings;
mod fuzz;
mod good;
mod mended;
mod minute;
mod parts;
mod posed;
mod refused;
mod resampled;
mod shipped;
mod stage;
mod support;
mod threads;
