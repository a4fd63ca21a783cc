//! The crate against reference values.

mod coverage;
mod distributions;
mod inference;
mod nist;
mod properties;
