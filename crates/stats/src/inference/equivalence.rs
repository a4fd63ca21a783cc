//! Equivalence: is a mean close enough to its null value?

use serde::Serialize;
use utoipa::ToSchema;

use super::{Interval, TTest};
use crate::distributions::StudentT;
use crate::{Result, StatsError};

/// How far a mean may lie from its null value and still count as equivalent to it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Bounds {
    /// ± so many units of the values.
    Points(f64),
    /// ± so many standard deviations of the sample.
    Sd(f64),
}

/// What two one-sided tests say (TOST, Schuirmann 1987).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct Equivalence {
    /// The bounds as asked for.
    pub bounds: Bounds,
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

/// Two one-sided t-tests of the sample behind `test`.
///
/// # Errors
/// [`StatsError::Invalid`] unless the bound is finite and above 0.
pub fn equivalence(test: &TTest, bounds: Bounds) -> Result<Equivalence> {
    let half_width = match bounds {
        Bounds::Points(points) => StatsError::positive("bounds (points)", points)?,
        Bounds::Sd(sds) => StatsError::positive("bounds (sd)", sds)? * test.sd,
    };
    let distribution = StudentT::new(test.df)?;
    let se = test.sd / (test.n as f64).sqrt();
    let shift = half_width / se;
    let (t_lower, t_upper) = (test.t + shift, test.t - shift);
    let (p_lower, p_upper) = (distribution.sf(t_lower)?, distribution.cdf(t_upper)?);
    let (mean, reach) = (test.t * se, distribution.quantile_sf(0.05)? * se);
    Ok(Equivalence {
        bounds,
        half_width,
        t_lower,
        p_lower,
        t_upper,
        p_upper,
        p: p_lower.max(p_upper),
        interval_90: Interval { low: mean - reach, high: mean + reach, level: 0.9 },
    })
}
