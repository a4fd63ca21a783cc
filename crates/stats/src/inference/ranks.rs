//! Wilcoxon's signed-rank test.

use serde::Serialize;
use utoipa::ToSchema;

use crate::distributions::normal;
use crate::{Result, StatsError};

/// How a p-value was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum RankMethod {
    /// From all 2ⁿ signs, ties included.
    Exact,
    /// Normal approximation with the variance of the tied ranks and a continuity correction, above 500 values.
    Normal,
}

/// What Wilcoxon's signed-rank test says.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct SignedRank {
    /// Values that differ from mu; the others are left out, as Wilcoxon did.
    pub n: u64,
    /// Sum of the (mid)ranks of the values above mu.
    pub v: f64,
    /// Two-sided p: twice the smaller tail, at most 1.
    pub p: f64,
    /// How it was found.
    pub method: RankMethod,
}

/// Up to here the distribution is built exactly, at a cost of n³.
const EXACT_TO: usize = 500;

/// Tests whether values are symmetric about `mu`. Distances that are equal but for rounding share the mean of their ranks, and the exact
/// distribution is that of the tied ranks (R's and scipy's exact p-values assume that there are no ties).
///
/// # Errors
/// [`StatsError::TooFew`] when no value differs from `mu`; [`StatsError::InvalidElement`], [`StatsError::Invalid`] for
/// what is not finite.
pub fn wilcoxon_signed_rank(values: &[f64], mu: f64) -> Result<SignedRank> {
    let mu = StatsError::finite("mu", mu)?;
    if let Some(index) = values.iter().position(|v| !v.is_finite()) {
        let value = values[index];
        return Err(StatsError::InvalidElement { name: "values", index, value, rule: "must be finite" });
    }
    // 0.3 − 0.2 and 0.2 − 0.1 are one distance that rounding tells apart: each goes with what its rounding can be.
    let distance = |&v: &f64| (v - mu, 8.0 * f64::EPSILON * v.abs().max(mu.abs()));
    let mut distances: Vec<(f64, f64)> =
        values.iter().map(distance).filter(|(d, rounding)| d.abs() > *rounding).collect();
    if distances.is_empty() {
        return Err(StatsError::TooFew { name: "values other than mu", len: 0, needed: 1 });
    }
    distances.sort_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
    let doubled_ranks = doubled_midranks(&distances);
    let above: u64 = distances.iter().zip(&doubled_ranks).filter(|(d, _)| d.0 > 0.0).map(|(_, r)| r).sum();
    let total: u64 = doubled_ranks.iter().sum();
    let n = distances.len();
    let smaller = above.min(total - above);
    let (p, method) = if n <= EXACT_TO {
        (exact_tail(&doubled_ranks, smaller), RankMethod::Exact)
    } else {
        let variance: f64 = doubled_ranks.iter().map(|&r| (r as f64 / 4.0).powi(2)).sum();
        let below_mean = ((total as f64 / 2.0 - smaller as f64) / 2.0 - 0.5).max(0.0);
        (normal::sf(below_mean / variance.sqrt())?, RankMethod::Normal)
    };
    Ok(SignedRank { n: n as u64, v: above as f64 / 2.0, p: (2.0 * p).min(1.0), method })
}

/// Twice the midranks of distances sorted by size, so that they are whole; neighbours no further apart than rounding share theirs.
fn doubled_midranks(sorted: &[(f64, f64)]) -> Vec<u64> {
    let mut ranks = Vec::with_capacity(sorted.len());
    for group in sorted.chunk_by(|a, b| b.0.abs() - a.0.abs() <= a.1.max(b.1)) {
        let first = ranks.len() as u64 + 1;
        let last = first + group.len() as u64 - 1;
        ranks.extend(std::iter::repeat_n(first + last, group.len()));
    }
    ranks
}

/// P(sum of ranks with random signs ≤ at), with each rank in or out with probability ½.
fn exact_tail(doubled_ranks: &[u64], at: u64) -> f64 {
    let at = at as usize;
    let mut share = vec![0.0; at + 1];
    share[0] = 1.0;
    for &rank in doubled_ranks {
        let rank = rank as usize;
        for sum in (0..=at).rev() {
            let with = if sum >= rank { share[sum - rank] } else { 0.0 };
            share[sum] = 0.5 * (share[sum] + with);
        }
    }
    share.iter().sum()
}
