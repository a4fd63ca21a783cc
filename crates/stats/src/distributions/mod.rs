//! Probability distributions, with both tails, their logarithms and their quantiles.
//!
//! Every tail is computed for itself and keeps its relative precision down to 1e-300 (the measured errors are in
//! `tests/it/distributions.rs`). Parameters are checked when a distribution is made; a NaN argument is an error.
//!
//! A relative error can be no better than the input's own conditioning: these functions take every `f64` as exact, but
//! a caller whose t was rounded to 1 part in 1e16 gets a tail that is uncertain by 1e-16 · |d ln tail / d ln t|, which
//! is t² for the normal distribution (1e-13 at a tail of 1e-300).

pub mod beta;
pub mod binomial;
pub(crate) mod dd;
pub mod fisher_f;
pub mod gamma;
pub mod noncentral_t;
pub mod normal;
pub(crate) mod quadrature;
pub(crate) mod root;
pub(crate) mod special;
pub mod student_t;

pub use beta::Beta;
pub use binomial::Binomial;
pub use fisher_f::FisherF;
pub use gamma::ChiSquared;
pub use noncentral_t::NoncentralT;
pub use student_t::StudentT;
