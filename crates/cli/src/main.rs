//! The kelir command.
fn main() {}
