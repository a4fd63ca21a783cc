//! Standardised mean differences.

use serde::Serialize;
use utoipa::ToSchema;

use super::{Interval, TTest, tail_of};
use crate::Result;
use crate::distributions::NoncentralT;
use crate::distributions::special::ln_gamma;

/// How far a mean lies from its null value, in standard deviations.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct EffectSize {
    /// Cohen's d = (mean − mu) / sd, with its sign. (For pairs: of the differences, also written d_z.)
    pub d: f64,
    /// Its interval, from the noncentral t distribution of t (Steiger & Fouladi 1997).
    pub d_interval: Interval,
    /// Hedges' g = J d, unbiased: J = Γ(ν/2) / (√(ν/2) Γ((ν − 1)/2)) with ν = n − 1 (Hedges 1981).
    pub g: f64,
    /// J times the interval of d.
    pub g_interval: Interval,
}

/// The effect size of a one-sample or paired t-test, with intervals of the given level, such as 0.95.
///
/// For n = 2 no unbiased estimate exists: J, and with it g and its interval, is 0.
///
/// # Errors
/// [`crate::StatsError::Invalid`] unless `level` is in (0, 1) and |t| ≤ 1e5.
pub fn effect_size(test: &TTest, level: f64) -> Result<EffectSize> {
    let tail = tail_of(level)?;
    let root_n = (test.n as f64).sqrt();
    let d_interval = Interval {
        low: NoncentralT::delta_with_sf(test.df, test.t, tail)? / root_n,
        high: NoncentralT::delta_with_sf(test.df, test.t, 1.0 - tail)? / root_n,
        level,
    };
    let d = test.t / root_n;
    let j = small_sample_correction(test.df);
    let g_interval = Interval { low: j * d_interval.low, high: j * d_interval.high, level };
    Ok(EffectSize { d, d_interval, g: j * d, g_interval })
}

/// Hedges' J.
fn small_sample_correction(df: f64) -> f64 {
    if df <= 1.0 {
        return 0.0;
    }
    let half = df / 2.0;
    if df > 1e4 {
        // ln Γ loses digits by subtraction; this series' next term is below 1e-17.
        let r = 1.0 / df;
        return 1.0 - r * (0.75 + r * (7.0 / 32.0 + r * (-9.0 / 128.0 - r * 59.0 / 2048.0)));
    }
    (ln_gamma(half) - ln_gamma(half - 0.5)).exp() / half.sqrt()
}
