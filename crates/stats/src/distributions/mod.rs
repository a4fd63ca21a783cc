//! Probability distributions, with both tails, their logarithms and their quantiles.

pub mod beta;
pub(crate) mod dd;
pub mod normal;
mod root;
pub(crate) mod special;
pub mod student_t;
