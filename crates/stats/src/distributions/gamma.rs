//! The gamma distribution, and χ² which is a special case.
//!
//! P(a, x) = x^a e^−x / Γ(a) · ∫₀^∞ exp(−as + x (1 − e^−s)) ds and Q(a, x) = x^a e^−x / Γ(a) · ∫₀^∞ e^(−xs) (1 + s)^(a−1) ds
//! (substitute t = x e^−s and t = x (1 + s) in DLMF 8.2.1–2): the same scheme as for the beta distribution.

use super::beta::{self, Tails, shape};
use super::dd::Dd;
use super::quadrature::integrate_decay;
use super::root;
use super::special::{deviance, exp_m1_minus, ln_1p_minus, ln_gamma, stirling_error};
use crate::{Result, StatsError};

/// χ² with `df` degrees of freedom.
///
/// Relative error of both tails ≤ 1e-13 for df ≤ 1000 and ≤ 1e-12 up to 1e6, down to 1e-300.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChiSquared {
    df: f64,
}

impl ChiSquared {
    /// `df` in [1e-280, 1e280].
    ///
    /// # Errors
    /// [`StatsError::Invalid`] for anything else.
    pub fn new(df: f64) -> Result<Self> {
        Ok(Self { df: shape("df", df)? })
    }

    /// P(X ≤ x).
    ///
    /// # Errors
    /// [`StatsError::Invalid`] unless x ≥ 0.
    pub fn cdf(&self, x: f64) -> Result<f64> {
        Ok(self.tails(x)?.lower)
    }

    /// P(X > x).
    ///
    /// # Errors
    /// [`StatsError::Invalid`] unless x ≥ 0.
    pub fn sf(&self, x: f64) -> Result<f64> {
        Ok(self.tails(x)?.upper)
    }

    /// The x below which a share `p` lies.
    ///
    /// # Errors
    /// [`StatsError::Invalid`] unless p is in [0, 1].
    pub fn quantile(&self, p: f64) -> Result<f64> {
        let p = StatsError::probability("p", p)?;
        Ok(self.inverse(p, false))
    }

    /// The x above which a share `q` lies.
    ///
    /// # Errors
    /// [`StatsError::Invalid`] unless q is in [0, 1].
    pub fn quantile_sf(&self, q: f64) -> Result<f64> {
        let q = StatsError::probability("q", q)?;
        Ok(self.inverse(q, true))
    }

    fn tails(&self, x: f64) -> Result<Tails> {
        if x >= 0.0 {
            Ok(tails(self.df / 2.0, x / 2.0))
        } else {
            Err(StatsError::Invalid { name: "x", value: x, rule: "must be at least 0" })
        }
    }

    fn inverse(&self, share: f64, upper: bool) -> f64 {
        if share == 0.0 || share == 1.0 {
            return if (share == 0.0) == upper { f64::INFINITY } else { 0.0 };
        }
        // The smaller tail says more; 1 − share is exact above ½.
        let (share, upper) = if share > 0.5 { (1.0 - share, !upper) } else { (share, upper) };
        let a = self.df / 2.0;
        let f = |x: f64| {
            let tails = tails(a, x);
            if upper {
                -root::ln_ratio(tails.upper, tails.ln_upper, share)
            } else {
                root::ln_ratio(tails.lower, tails.ln_lower, share)
            }
        };
        2.0 * root::in_logarithm(f, 1e300, a)
    }
}

/// P(a, x) and Q(a, x), for a in [1e-280, 1e280] and x ≥ 0.
pub(crate) fn tails(a: f64, x: f64) -> Tails {
    if x == 0.0 {
        return Tails::NOTHING_BELOW;
    }
    if x > 1e290 {
        return Tails::NOTHING_BELOW.swapped();
    }
    if x < beta::NEGLIGIBLE {
        // x^a / Γ(a + 1): e^−x is 1.
        let ln_lower = Dd::from(x).ln() * a.into() - ln_gamma(a + 1.0).into();
        let lower = ln_lower.exp().min(1.0);
        let ln_lower = ln_lower.value().min(0.0);
        let upper = -ln_lower.exp_m1();
        return Tails { lower, upper, ln_lower, ln_upper: upper.ln() };
    }
    let excess = Dd::sum(x, -a);
    let exponent = -deviance(a, x.into(), excess) - stirling_error(a);
    let tail = |integral: f64| {
        let factor = (a / std::f64::consts::TAU).sqrt() * integral;
        let half = Dd { hi: exponent.hi / 2.0, lo: exponent.lo / 2.0 }.exp();
        (half * factor * half, exponent.value() + factor.ln())
    };
    let upper = || {
        let slope = excess.value() + 1.0;
        let rate = slope + (a - 1.0).max(0.0).sqrt();
        let g = |s: f64| {
            if a < 1.0 { (a - 1.0) * s.ln_1p() - x * s } else { (a - 1.0) * ln_1p_minus(s) - slope * s }
        };
        let (p, ln_p) = tail(integrate_decay(g, slope, rate));
        Tails::from_lower(p, ln_p).swapped()
    };
    if excess.hi > 0.0 {
        return upper();
    }
    let slope = -excess.value();
    let g = |s: f64| -slope * s - x * exp_m1_minus(-s);
    let (p, ln_p) = tail(integrate_decay(g, slope, slope + x.sqrt()));
    if p > 0.7 && a < 1.0 { upper() } else { Tails::from_lower(p, ln_p) }
}
