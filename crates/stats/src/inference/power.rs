//! How likely a test is to find an effect, and how many participants that takes.

use serde::Serialize;
use utoipa::ToSchema;

use super::binomial_test::{minimum_likelihood, partition};
use crate::distributions::{Binomial, NoncentralT, StudentT, normal, root};
use crate::{Result, StatsError};

/// The most participants that a plan may ask for.
const MOST: u64 = 1_000_000;

/// A one-sample or paired t-test that is planned.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct TPlan {
    /// Participants (pairs).
    pub n: u64,
    /// The true effect in standard deviations.
    pub d: f64,
    /// Level of the two-sided test.
    pub alpha: f64,
    /// Probability that the test rejects, in either direction.
    pub power: f64,
}

/// Power of a two-sided one-sample or paired t-test of level `alpha` when the true mean is `d` standard deviations from
/// the null value: both rejection regions counted (R's `power.t.test(strict = TRUE)`).
///
/// # Errors
/// [`StatsError::TooFew`] below two participants; [`StatsError::Invalid`] unless |d| √n ≤ 1e6 and alpha is in (0, 1).
pub fn power_t(n: u64, d: f64, alpha: f64) -> Result<TPlan> {
    if n < 2 {
        return Err(StatsError::TooFew { name: "participants", len: n, needed: 2 });
    }
    let alpha = StatsError::open_probability("alpha", alpha)?;
    let d = StatsError::finite("d", d)?;
    let df = n as f64 - 1.0;
    let critical = StudentT::new(df)?.quantile_sf(alpha / 2.0)?;
    let t = NoncentralT::new(df, d * (n as f64).sqrt())?;
    let power = (t.sf(critical)? + t.cdf(-critical)?).min(1.0);
    Ok(TPlan { n, d, alpha, power })
}

/// The fewest participants with at least the given power; see [`power_t`].
///
/// # Errors
/// As [`power_t`], and [`StatsError::NoSolution`] when more than a million would be needed (or the effect is 0).
pub fn sample_size_t(d: f64, alpha: f64, power: f64) -> Result<TPlan> {
    let power = StatsError::open_probability("power", power)?;
    let enough = |n: u64| Ok::<bool, StatsError>(power_t(n, d, alpha)?.power >= power);
    // Power grows with n: double until it is enough, then halve the gap.
    let mut high = 2;
    while !enough(high)? {
        if high >= MOST {
            return Err(StatsError::NoSolution {
                what: "the sample size",
                reason: "more than 1e6 would be needed",
            });
        }
        high *= 2;
    }
    let mut low = high / 2;
    while low + 1 < high {
        let middle = low + (high - low) / 2;
        if enough(middle)? { high = middle } else { low = middle }
    }
    power_t(high, d, alpha)
}

/// The smallest positive effect that a t-test of `n` participants finds with the given power.
///
/// # Errors
/// As [`power_t`]; [`StatsError::Invalid`] unless the power lies in (alpha, 1 − 1e-9].
pub fn detectable_effect_t(n: u64, alpha: f64, power: f64) -> Result<TPlan> {
    power_t(n, 0.0, alpha)?;
    if !(power > alpha && power <= 1.0 - 1e-9) {
        return Err(StatsError::Invalid {
            name: "power",
            value: power,
            rule: "must lie in (alpha, 1 − 1e-9]",
        });
    }
    let target = normal::inverse(power);
    let f =
        |d: f64| power_t(n, d, alpha).map_or(f64::NAN, |plan| normal::inverse(plan.power).min(40.0) - target);
    let mut high = 1.0;
    while f(high) < 0.0 {
        high *= 2.0;
    }
    power_t(n, root::increasing_by_differences(f, 0.0, high, high / 2.0), alpha)
}

/// An exact binomial test that is planned.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
pub struct BinomialPlan {
    /// Trials.
    pub n: u64,
    /// Probability of a success under the null hypothesis.
    pub p0: f64,
    /// The true probability.
    pub p1: f64,
    /// Level of the two-sided test.
    pub alpha: f64,
    /// The test rejects up to this many successes; `None` when it never does so below.
    pub reject_to: Option<u64>,
    /// The test rejects from this many successes; `None` when it never does so above.
    pub reject_from: Option<u64>,
    /// Probability of rejecting when p0 is true: at most alpha.
    pub size: f64,
    /// Probability of rejecting when p1 is true.
    pub power: f64,
}

/// Power of the exact two-sided (minimum likelihood) binomial test of `p0` when the truth is `p1`.
///
/// # Errors
/// [`StatsError::TooFew`] without a trial; [`StatsError::Invalid`] for n above 1e6, p0 or alpha outside (0, 1), or p1
/// outside [0, 1].
pub fn power_binomial(n: u64, p0: f64, p1: f64, alpha: f64) -> Result<BinomialPlan> {
    if n == 0 {
        return Err(StatsError::TooFew { name: "trials", len: 0, needed: 1 });
    }
    if n > MOST {
        return Err(StatsError::Invalid { name: "n", value: n as f64, rule: "must be at most 1e6" });
    }
    let p0 = StatsError::open_probability("p0", p0)?;
    let alpha = StatsError::open_probability("alpha", alpha)?;
    let null = Binomial::new(n, p0)?;
    let truth = Binomial::new(n, p1)?;
    let rejects = |k: u64| minimum_likelihood(&null, k, n, p0) <= alpha;
    let floor = (n as f64 * p0).floor() as u64;
    // Away from the mean the p-value falls: rejection begins at a boundary on either side.
    let down = partition(0, floor + 1, |step| rejects(floor - step));
    let reject_to = (down <= floor).then(|| floor - down);
    let from = partition(floor + 1, n + 1, rejects);
    let reject_from = (from <= n).then_some(from);
    let share = |d: &Binomial| {
        (reject_to.map_or(0.0, |k| d.cdf(k)) + reject_from.map_or(0.0, |k| d.at_least(k))).min(1.0)
    };
    Ok(BinomialPlan { n, p0, p1, alpha, reject_to, reject_from, size: share(&null), power: share(&truth) })
}

/// The number of trials from which on the power stays at or above the given one. (The power of an exact test is a saw: it
/// falls a little between the numbers at which a rejection boundary moves. Fewer trials may reach it by luck of n.)
///
/// # Errors
/// As [`power_binomial`]; [`StatsError::Invalid`] for p0 outside [0.001, 0.999]; [`StatsError::NoSolution`] when p1 = p0, or when more than 20,000 trials would be needed.
pub fn sample_size_binomial(p0: f64, p1: f64, alpha: f64, power: f64) -> Result<BinomialPlan> {
    const MOST_TRIALS: f64 = 20_000.0;
    let target = StatsError::open_probability("power", power)?;
    power_binomial(1, p0, p1, alpha)?;
    if !(0.001..=0.999).contains(&p0) {
        return Err(StatsError::Invalid { name: "p0", value: p0, rule: "must lie in [0.001, 0.999]" });
    }
    if p1 == p0 {
        return Err(StatsError::NoSolution { what: "the sample size", reason: "p1 equals p0" });
    }
    // The normal approximation says where to look; the saw is some √n wide.
    let (z_alpha, z_beta) = (-normal::inverse(alpha / 2.0), normal::inverse(target));
    let spread = |p: f64| (p * (1.0 - p)).sqrt();
    let guess = ((z_alpha * spread(p0) + z_beta * spread(p1)).max(0.5 * spread(p0)) / (p1 - p0)).powi(2);
    if guess > MOST_TRIALS {
        return Err(StatsError::NoSolution {
            what: "the sample size",
            reason: "more than 20,000 would be needed",
        });
    }
    let tooth = 1.0 / p0.min(1.0 - p0);
    let mut n = (guess + 6.0 * guess.sqrt() + 30.0 + 4.0 * tooth).ceil() as u64;
    let mut plan = power_binomial(n, p0, p1, alpha)?;
    if plan.power < target {
        return Err(StatsError::NoSolution { what: "the sample size", reason: "the power stays below it" });
    }
    while n > 1 {
        let fewer = power_binomial(n - 1, p0, p1, alpha)?;
        if fewer.power < target {
            break;
        }
        (n, plan) = (n - 1, fewer);
    }
    Ok(plan)
}
