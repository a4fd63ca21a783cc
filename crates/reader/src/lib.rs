//! A file that somebody wrote, read value by value: every problem is found, and named by place, field, value and rule.
//!
//! TOML whose keys are asked for one by one. What breaks its rule, is missing, is of another type or was never asked for is collected in a
//! [`Reading`], with its path and its text as written, and the reading goes on. What a file means is its room's: this one knows nothing of it,
//! does no IO and compiles for browsers.

mod asked;
mod canonical;
mod fields;
mod node;
mod place;
mod problem;
mod source;
#[cfg(test)]
mod tests;
mod words;
mod written;

pub use asked::{Asked, Key};
pub use fields::Fields;
pub use node::Node;
pub use place::Place;
pub use problem::{Problem, Problems};
pub use source::{Reading, Source};
pub use words::{did_you_mean, list, shorten};
