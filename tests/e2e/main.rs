//! End to end: the real binary, a real browser, a real database.
#![allow(clippy::unwrap_used, reason = "a test that fails here says where")]

mod adaptive;
mod check;
mod cli;
mod doors;
mod drawings;
mod film;
mod front;
mod gpu;
mod invariants;
mod kinds;
mod late;
mod licences;
mod mesh;
mod outputs;
mod report;
mod soak;
mod stage;
mod survey;
mod trouble;
mod trying;
mod versions;
mod widths;
