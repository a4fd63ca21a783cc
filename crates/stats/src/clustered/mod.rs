//! Choices that come in clusters: several trials from each participant are not independent.
//!
//! A participant who prefers one technique prefers it in every pair, so n trials of m participants carry less than n answers. Here are
//! the size of that dependence ([`intraclass`](fn@intraclass)), the share of all choices over participants ([`share_interval`]), and what else to do
//! about it: resample participants ([`bootstrap`](fn@bootstrap)), keep the per-trial
//! model but take its standard errors from the clusters ([`robust_logit`]), or model the participants ([`mixed_logit`]), the pairs too ([`crossed_logit`]).
//! [`heterogeneity`](fn@heterogeneity) tests whether pairs differ at all, [`within_slope`] what goes with place or time.
//! [`independence_warning`] says when a per-trial test is not to be believed.

mod bootstrap;
mod crossed;
mod heterogeneity;
mod intraclass;
mod logit;
mod mixed;
mod share;
#[cfg(test)]
mod tests;
mod within;

pub(crate) use bootstrap::quantile;
pub use bootstrap::{Bootstrap, BootstrapMethod, MIN_REPLICATES, bootstrap};
pub use crossed::{CrossedLogit, ENOUGH_PAIRS, crossed_logit};
pub use heterogeneity::{Heterogeneity, heterogeneity};
pub use intraclass::{IccEstimator, IndependenceWarning, Intraclass, independence_warning, intraclass};
pub use logit::{Coefficient, Correction, RobustLogit, Row, robust_logit};
pub(crate) use logit::{logistic, softplus};
pub use mixed::{MixedLogit, mixed_logit};
pub use share::{ShareInterval, ShareMethod, share_interval};
pub use within::{Groups, WithinSlope, within_slope};

use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// One participant's forced choices: how many of `trials` went to the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct Cluster {
    /// Choices of the target, ≤ `trials`.
    pub successes: u64,
    /// Choices made.
    pub trials: u64,
}

impl Cluster {
    /// The clusters of a survey in which everybody saw the same number of pairs: `counts[k]` participants chose the target k times,
    /// of `counts.len() − 1` pairs. (12, 14, 6) is the paper's first block.
    pub fn from_counts(counts: &[u64]) -> Vec<Self> {
        let trials = counts.len().saturating_sub(1) as u64;
        (0..)
            .zip(counts)
            .flat_map(|(successes, &n)| (0..n).map(move |_| Self { successes, trials }))
            .collect()
    }
}

/// How many pairs rows of choices, one a participant, are of. Errors: rows of unequal length.
fn pairs_of(choices: &[Vec<Option<bool>>]) -> Result<usize> {
    let pairs = choices.first().map_or(0, Vec::len);
    match choices.iter().find(|row| row.len() != pairs) {
        None => Ok(pairs),
        Some(row) => Err(StatsError::LengthMismatch {
            first: "choices[0]",
            first_len: pairs,
            second: "another participant's choices",
            second_len: row.len(),
        }),
    }
}

/// The clusters that have trials, checked.
fn answered(clusters: &[Cluster]) -> Result<Vec<Cluster>> {
    for (index, cluster) in clusters.iter().enumerate() {
        if cluster.successes > cluster.trials {
            return Err(StatsError::InvalidElement {
                name: "clusters.successes",
                index,
                value: cluster.successes as f64,
                rule: "must not exceed trials",
            });
        }
    }
    Ok(clusters.iter().copied().filter(|c| c.trials > 0).collect())
}
