//! What the crate promises of whole files.

mod bunny;
mod hostile;
