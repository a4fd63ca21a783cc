//! Equivalence: is a mean close enough to its null value?

use serde::Serialize;
use utoipa::ToSchema;

use super::{Interval, TTest};
use crate::distributions::StudentT;
use crate::{Result, StatsError};

/// What two one-sided tests say (TOST, Schuirmann 1987).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct Equivalence {
    /// Half the width of the equivalence range, in units of the values.
    pub half_width: f64,
    /// t against the lower bound, mean − mu > −half_width, and its one-sided p.
    pub t_lower: f64,
    /// P(T ≥ t_lower).
    pub p_lower: f64,
    /// t against the upper bound, mean − mu < half_width.
    pub t_upper: f64,
    /// P(T ≤ t_upper).
    pub p_upper: f64,
    /// The larger of the two p-values: below α, the mean is equivalent to mu within the bounds.
    pub p: f64,
    /// The interval of mean − mu whose level is 1 − 2α with α = 0.05: inside the bounds exactly when p < 0.05.
    pub interval_90: Interval,
}

/// Whether a share is equivalent to one half.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct ShareEquivalence {
    /// The bound: how far from ½ the share may lie.
    pub within: f64,
    /// The tests, in choices of one participant.
    pub tests: Equivalence,
}

/// [`equivalence`] of the number of choices out of `items` behind `test` with half of them, within a bound on the share.
///
/// # Errors
/// [`StatsError::Invalid`] unless the bound lies in (0, ½): no share is further from ½ than that.
pub fn share_equivalence(test: &TTest, items: u32, within: f64) -> Result<ShareEquivalence> {
    if !(within > 0.0 && within < 0.5) {
        return Err(StatsError::Invalid { name: "within", value: within, rule: "must lie in (0, 0.5)" });
    }
    Ok(ShareEquivalence { within, tests: equivalence(test, within * f64::from(items))? })
}

/// Two one-sided t-tests of the sample behind `test`: does its mean lie within `half_width` of mu, in units of the values?
///
/// # Errors
/// [`StatsError::Invalid`] unless `half_width` is finite and above 0.
pub fn equivalence(test: &TTest, half_width: f64) -> Result<Equivalence> {
    let half_width = StatsError::positive("half_width", half_width)?;
    let distribution = StudentT::new(test.df)?;
    let se = test.sd / (test.n as f64).sqrt();
    let shift = half_width / se;
    let (t_lower, t_upper) = (test.t + shift, test.t - shift);
    let (p_lower, p_upper) = (distribution.sf(t_lower)?, distribution.cdf(t_upper)?);
    let (mean, reach) = (test.t * se, distribution.quantile_sf(0.05)? * se);
    Ok(Equivalence {
        half_width,
        t_lower,
        p_lower,
        t_upper,
        p_upper,
        p: p_lower.max(p_upper),
        interval_90: Interval { low: mean - reach, high: mean + reach, level: 0.9 },
    })
}
