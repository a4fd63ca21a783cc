//! The scene crate from outside: files in, theatres out.
#![allow(clippy::unwrap_used, missing_docs)]

mod assets;
mod fuzz;
mod good;
mod posed;
mod refused;
mod support;
