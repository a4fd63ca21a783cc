//! The scene crate from outside: files in, theatres out.
#![allow(clippy::unwrap_used, missing_docs)]

mod good;
mod posed;
mod refused;
mod support;
