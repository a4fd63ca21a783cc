//! Samples described: moments that reach the precision of their inputs.

mod moments;

pub use moments::Moments;
