//! The binomial distribution.

use super::beta::{self, Tails, ln_density_core};
use super::dd::Dd;
use crate::{Result, StatsError};

/// The number of successes in n independent trials of probability p.
///
/// Relative error ≤ 1e-13 for n ≤ 1000 and ≤ 1e-12 up to 1e6, down to 1e-300.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Binomial {
    n: u64,
    p: f64,
}

impl Binomial {
    /// `n` up to 2^53, `p` in [0, 1].
    ///
    /// # Errors
    /// [`StatsError::Invalid`] for anything else.
    pub fn new(n: u64, p: f64) -> Result<Self> {
        if n > 1 << 53 {
            return Err(StatsError::Invalid { name: "n", value: n as f64, rule: "must be at most 2^53" });
        }
        Ok(Self { n, p: StatsError::probability("p", p)? })
    }

    /// P(X = k); 0 above n.
    pub fn pmf(&self, k: u64) -> f64 {
        let (exponent, factor) = self.pmf_parts(k);
        exponent.exp() * factor
    }

    /// ln P(X = k); −∞ where that is impossible.
    pub fn ln_pmf(&self, k: u64) -> f64 {
        let (exponent, factor) = self.pmf_parts(k);
        if factor == 0.0 { f64::NEG_INFINITY } else { exponent.value() + factor.ln() }
    }

    /// P(X ≤ k) = I_{1−p}(n − k, k + 1).
    pub fn cdf(&self, k: u64) -> f64 {
        self.tails(k).lower
    }

    /// P(X > k) = I_p(k + 1, n − k).
    pub fn sf(&self, k: u64) -> f64 {
        self.tails(k).upper
    }

    /// P(X ≥ k).
    pub fn at_least(&self, k: u64) -> f64 {
        if k == 0 { 1.0 } else { self.sf(k - 1) }
    }

    fn tails(&self, k: u64) -> Tails {
        if k >= self.n {
            return Tails::NOTHING_BELOW.swapped();
        }
        beta::tails((self.n - k) as f64, k as f64 + 1.0, Dd::sum(1.0, -self.p), self.p.into())
    }

    /// The pmf as e^exponent · factor (Loader 2000).
    fn pmf_parts(&self, k: u64) -> (Dd, f64) {
        let zero = (Dd::from(0.0), 0.0);
        let (p, q) = (Dd::from(self.p), Dd::sum(1.0, -self.p));
        if k > self.n {
            return zero;
        }
        let (n, hits, misses) = (self.n as f64, k as f64, (self.n - k) as f64);
        // 0⁰ = 1: an impossible outcome that did not occur.
        let certain = |share: Dd, count: f64| {
            if count == 0.0 {
                (Dd::from(0.0), 1.0)
            } else if share.hi <= 0.0 {
                zero
            } else {
                (share.ln() * count.into(), 1.0)
            }
        };
        if k == 0 {
            return certain(q, n);
        }
        if k == self.n {
            return certain(p, n);
        }
        if self.p == 0.0 || self.p == 1.0 {
            return zero;
        }
        let lambda = q * hits.into() - p * misses.into();
        (ln_density_core(hits, misses, p, q, lambda), (n / hits / misses / std::f64::consts::TAU).sqrt())
    }
}
