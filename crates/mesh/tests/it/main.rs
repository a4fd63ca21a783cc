//! What the crate promises of whole files.

mod hostile;
