//! Samples described.
