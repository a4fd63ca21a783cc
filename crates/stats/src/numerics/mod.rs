//! How exact this crate is, measured against reference values that travel with it.

mod grid;
mod nist;

pub use grid::{GridPoint, WorstError, grid, worst_errors};
pub use nist::{Certified, nist};
