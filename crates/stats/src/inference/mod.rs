//! Tests, intervals, effect sizes, equivalence, Bayes factor, corrections for many tests, power.
//!
//! Tests are two-sided unless they say otherwise. Intervals hold their `level` in two equal tails.

mod agreement;
mod bayes;
mod binomial_test;
mod detection;
mod effect_size;
mod equivalence;
mod multiplicity;
mod power;
mod proportion;
mod ranks;
mod sign_flips;
mod t_test;

use serde::Serialize;
use utoipa::ToSchema;

use crate::{Result, StatsError};

pub use agreement::{FleissKappa, fleiss_kappa};
pub use bayes::{JzsBayesFactor, ORDINARY_PRIOR_SCALE, jzs_bayes_factor};
pub use binomial_test::{BinomialTest, binomial_test, sign_test};
pub use detection::{Dprime, ExtremeRates, dprime_2afc};
pub use effect_size::{EffectSize, effect_size};
pub use equivalence::{Equivalence, ShareEquivalence, equivalence, share_equivalence};
pub use multiplicity::{benjamini_hochberg, hochberg, holm};
pub use power::{
    BinomialPlan, TPlan, detectable_effect_t, power_binomial, power_t, sample_size_binomial, sample_size_t,
};
pub(crate) use proportion::score_interval;
pub use proportion::{clopper_pearson, jeffreys, wilson};
pub use ranks::{RankMethod, SignedRank, wilcoxon_signed_rank};
pub(crate) use sign_flips::flip;
pub use sign_flips::{EXACT_FLIPS_TO, Flipped, sign_flips};
pub use t_test::{TTest, t_test_from_counts, t_test_one_sample, t_test_paired};

/// A confidence (or credible) interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// The probability with which it covers, in (0, 1).
    pub level: f64,
}

/// (1 − level) / 2, the share left out at either end.
fn tail_of(level: f64) -> Result<f64> {
    Ok((1.0 - StatsError::open_probability("level", level)?) / 2.0)
}

/// `Ok` when successes ≤ n and n ≥ 1.
fn check_successes(successes: u64, n: u64) -> Result<()> {
    if n == 0 {
        return Err(StatsError::TooFew { name: "trials", len: 0, needed: 1 });
    }
    if n > 1 << 53 {
        return Err(StatsError::Invalid { name: "n", value: n as f64, rule: "must be at most 2^53" });
    }
    if successes > n {
        return Err(StatsError::Invalid {
            name: "successes",
            value: successes as f64,
            rule: "must not exceed the number of trials",
        });
    }
    Ok(())
}
