//! The crate against reference values.

mod distributions;
mod nist;
