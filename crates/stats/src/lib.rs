//! Numbers judged: the statistics of forced-choice studies, in plain `f64`, with no dependency on the rest of
//! the workspace.
//!
//! | module | what is in it |
//! |---|---|
//! | [`distributions`] | normal, Student t, noncentral t, beta, gamma and χ², F, binomial |
//! | [`descriptive`] | mean, variance, autocorrelation, one-way analysis of variance |
//! | [`inference`] | tests, intervals, effect sizes, equivalence, Bayes factor, corrections, power |
//! | [`clustered`] | choices of participants × pairs: intraclass correlation, the share's interval, bootstrap, robust and mixed logit; whether pairs differ, a logit with pairs random too, slopes within participants |
//! | [`pairwise`] | Bradley–Terry and Thurstone scaling in JOD, circular triads, odd observers |
//! | [`psychometric`] | psychometric functions: maximum likelihood, posterior, goodness of fit |
//! | [`simulate`] | simulated observers: power, precision, coverage |
//! | [`random`] | the seeded generator behind every resampling |
//! | [`paper`] | the paper's tests computed again, and what it left out |
//! | [`numerics`] | how exact all of this is, measured |
//!
//! Invalid input is an `Err` ([`StatsError`]) that names the field, the value and the rule. NaN is always invalid
//! input: no function takes or returns one in silence. What is a *finding* is a value.
#![warn(missing_docs)]

mod betabinomial;
pub mod clustered;
pub mod descriptive;
pub mod distributions;
mod error;
pub mod inference;
mod linalg;
mod normal;
pub mod numerics;
mod optimise;
pub mod pairwise;
pub mod paper;
pub mod psychometric;
pub mod random;
pub mod simulate;

pub use error::{Result, StatsError};
