//! The crate against reference values.

mod distributions;
mod inference;
mod nist;
mod properties;
