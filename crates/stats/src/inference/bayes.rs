//! The Bayes factor of a one-sample t-test.

use serde::Serialize;
use utoipa::ToSchema;

use super::TTest;
use crate::distributions::quadrature::integrate_peak;
use crate::{Result, StatsError};

/// √2 / 2, the "medium" scale of R's BayesFactor package.
pub const ORDINARY_PRIOR_SCALE: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// How much likelier the data are under one hypothesis than under the other.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct JzsBayesFactor {
    /// Scale of the Cauchy prior on the standardised effect.
    pub prior_scale: f64,
    /// P(data | effect) / P(data | no effect); may overflow to infinity or underflow to 0 where `ln_bf10` does not.
    pub bf10: f64,
    /// 1 / bf10: evidence for no effect.
    pub bf01: f64,
    /// ln bf10.
    pub ln_bf10: f64,
}

/// The Bayes factor of Jeffreys, Zellner and Siow for a one-sample or paired t-test: no effect against an effect in
/// standard deviations with a Cauchy prior of the given scale (Rouder et al. 2009, eq. 1 with scale r).
///
/// # Errors
/// [`StatsError::Invalid`] unless the scale lies in [1e-3, 1e3] and |t| ≤ 1e100.
pub fn jzs_bayes_factor(test: &TTest, prior_scale: f64) -> Result<JzsBayesFactor> {
    if !(1e-3..=1e3).contains(&prior_scale) {
        return Err(StatsError::Invalid {
            name: "prior_scale",
            value: prior_scale,
            rule: "must lie in [1e-3, 1e3]",
        });
    }
    let t = StatsError::finite("t", test.t)?;
    if t.abs() > 1e100 {
        return Err(StatsError::Invalid { name: "t", value: t, rule: "must lie in [-1e100, 1e100]" });
    }
    let (n, df) = (test.n as f64, test.df);
    let share = t * t / df;
    // Over v = ln g, g being the variance of the effect: inverse gamma(½, r²/2), times the ratio of likelihoods.
    let integrand = |v: f64| {
        let spread = 1.0 + n * v.exp();
        let shrinkage = if spread.is_finite() { n * v.exp() / spread } else { 1.0 };
        // ln((1 + share) / (1 + share / spread)) without cancellation.
        let gain = (share * shrinkage / (1.0 + share / spread)).ln_1p();
        -0.5 * v - prior_scale * prior_scale / 2.0 * (-v).exp() - 0.5 * spread.ln() + (df + 1.0) / 2.0 * gain
    };
    let (height, sum) = integrate_peak(integrand, 0.0, 1.0);
    let ln_bf10 = height + (sum * prior_scale / std::f64::consts::TAU.sqrt()).ln();
    Ok(JzsBayesFactor { prior_scale, bf10: ln_bf10.exp(), bf01: (-ln_bf10).exp(), ln_bf10 })
}
