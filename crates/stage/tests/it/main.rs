//! The stage crate from outside: scene files in, pictures out.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    missing_docs,
    reason = "a test that fails here says where, and prints what it measured"
)]

mod mitsuba;
