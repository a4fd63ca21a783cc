//! The normal and reference distributions the fits use, for arguments already checked.

use crate::distributions::gamma::ChiSquared;
use crate::distributions::normal;
use crate::distributions::student_t::StudentT;

pub(crate) use normal::{inverse as quantile, ln_lower as ln_cdf, lower as cdf};

/// P(χ² > x) with `df` > 0 degrees of freedom; 1 for df = 0.
pub(crate) fn chi_squared_sf(x: f64, df: f64) -> f64 {
    if df == 0.0 || x <= 0.0 {
        return 1.0;
    }
    ChiSquared::new(df).and_then(|d| d.sf(x)).unwrap_or(f64::NAN)
}

/// The p-quantile of Student's t, for p in [0, 1] and df ≥ 1.
pub(crate) fn t_quantile(p: f64, df: f64) -> f64 {
    StudentT::new(df).and_then(|t| t.quantile(p)).unwrap_or(f64::NAN)
}

/// P(|t| > |x|).
pub(crate) fn t_two_sided(x: f64, df: f64) -> f64 {
    StudentT::new(df).and_then(|t| t.two_sided(x)).unwrap_or(f64::NAN)
}
