//! The exact binomial test, and the sign test which is one.

use serde::Serialize;
use utoipa::ToSchema;

use super::check_successes;
use crate::distributions::Binomial;
use crate::{Result, StatsError};

/// What an exact binomial test says.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct BinomialTest {
    /// Trials.
    pub n: u64,
    /// Successes among them.
    pub successes: u64,
    /// successes / n.
    pub proportion: f64,
    /// The probability of a success under the null hypothesis.
    pub p0: f64,
    /// Two-sided p-value: the probability of all outcomes that are no likelier than this one (minimum likelihood; R's
    /// `binom.test`, with its tolerance of 1e-7 for equal likelihoods). It isn't twice a tail.
    pub p: f64,
    /// P(X ≤ successes) under the null hypothesis.
    pub p_less: f64,
    /// P(X ≥ successes) under the null hypothesis.
    pub p_greater: f64,
}

/// Tests whether independent trials succeed with probability `p0`.
///
/// # Errors
/// [`StatsError::TooFew`] without a trial, [`StatsError::Invalid`] for more successes than trials or p0 outside [0, 1].
pub fn binomial_test(successes: u64, n: u64, p0: f64) -> Result<BinomialTest> {
    check_successes(successes, n)?;
    let null = Binomial::new(n, p0)?;
    Ok(BinomialTest {
        n,
        successes,
        proportion: successes as f64 / n as f64,
        p0,
        p: minimum_likelihood(&null, successes, n, p0),
        p_less: null.cdf(successes),
        p_greater: null.at_least(successes),
    })
}

/// Tests whether values are above `mu` as often as below: values equal to it are left out.
///
/// # Errors
/// [`StatsError::TooFew`] when no value differs from `mu`; [`StatsError::InvalidElement`], [`StatsError::Invalid`] for
/// what is not finite.
pub fn sign_test(values: &[f64], mu: f64) -> Result<BinomialTest> {
    let mu = StatsError::finite("mu", mu)?;
    if let Some(index) = values.iter().position(|v| !v.is_finite()) {
        let value = values[index];
        return Err(StatsError::InvalidElement { name: "values", index, value, rule: "must be finite" });
    }
    let above = values.iter().filter(|&&v| v > mu).count() as u64;
    let below = values.iter().filter(|&&v| v < mu).count() as u64;
    if above + below == 0 {
        return Err(StatsError::TooFew { name: "values other than mu", len: 0, needed: 1 });
    }
    binomial_test(above, above + below, 0.5)
}

/// P(pmf(X) ≤ pmf(successes)).
pub(super) fn minimum_likelihood(null: &Binomial, successes: u64, n: u64, p0: f64) -> f64 {
    if p0 == 0.0 || p0 == 1.0 {
        return if (successes == n) == (p0 == 1.0) && (successes == 0) == (p0 == 0.0) { 1.0 } else { 0.0 };
    }
    // Likelihoods as equal as rounding can tell.
    let as_likely = null.ln_pmf(successes) + 1e-7_f64.ln_1p();
    let mean = n as f64 * p0;
    let x = successes as f64;
    if x == mean {
        return 1.0;
    }
    // On either side of the mean the likelihood falls away from it: the other tail begins at a boundary.
    let p = if x < mean {
        let first = partition((mean.ceil() as u64).min(n), n + 1, |k| null.ln_pmf(k) <= as_likely);
        null.cdf(successes) + null.at_least(first)
    } else {
        let floor = mean.floor() as u64;
        // Counting down from the mean.
        let steps = partition(0, floor + 1, |step| null.ln_pmf(floor - step) <= as_likely);
        let lower = if steps > floor { 0.0 } else { null.cdf(floor - steps) };
        null.at_least(successes) + lower
    };
    p.min(1.0)
}

/// The first k in low .. high for which a condition holds that goes on holding; high if there is none.
pub(super) fn partition(mut low: u64, mut high: u64, holds: impl Fn(u64) -> bool) -> u64 {
    while low < high {
        let middle = low + (high - low) / 2;
        if holds(middle) { high = middle } else { low = middle + 1 }
    }
    low
}
