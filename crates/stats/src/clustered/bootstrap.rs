//! The cluster bootstrap: whole participants are drawn with replacement.

use crate::normal;
use crate::random::Random;
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// The fewest resamples an interval is taken from.
pub const MIN_REPLICATES: usize = 2000;

/// How the interval is read off the resampled statistics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, ToSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BootstrapMethod {
    /// The quantiles of the replicates.
    #[default]
    Percentile,
    /// Bias-corrected and accelerated (Efron 1987), with the jackknife over participants for the acceleration.
    BiasCorrected,
    /// The estimate ± a quantile of the replicates' distances from it (Hall 1988, J. R. Stat. Soc. B 50, 35): that within which t with one degree of
    /// freedom less than there are participants, times √(n/(n − 1)), has the level, as replicates of n scatter less than samples do and tell their own
    /// scatter only roughly (Hesterberg 2015, Am. Stat. 69, 371).
    Symmetric,
}

/// A bootstrap interval.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Bootstrap {
    /// The statistic of the sample itself.
    pub estimate: f64,
    /// Lower end, in the statistic's unit.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Confidence level, e.g. 0.95.
    pub level: f64,
    /// Standard deviation of the replicates.
    pub standard_error: f64,
    /// Resamples drawn.
    pub replicates: usize,
    /// Resamples in which the statistic was undefined, left out of the interval.
    pub undefined: usize,
    /// The seed that repeats it.
    pub seed: u64,
    /// How the interval was read.
    pub method: BootstrapMethod,
}

/// Resamples participants with replacement and recomputes `statistic` on each resample; deterministic for a seed.
///
/// `participants`: one item each, with everything that participant answered. `statistic` returns `None` where it is undefined.
/// Errors: fewer than two participants, fewer than [`MIN_REPLICATES`] replicates, a level outside (0, 1), a statistic undefined on the
/// sample itself or on more than half of the resamples, resamples that all agree. Source: Davison & Hinkley (1997), ch. 3.8 and 5.3.
pub fn bootstrap<T>(
    participants: &[T],
    replicates: usize,
    level: f64,
    seed: u64,
    method: BootstrapMethod,
    mut statistic: impl FnMut(&[&T]) -> Option<f64>,
) -> Result<Bootstrap> {
    StatsError::open_probability("level", level)?;
    if participants.len() < 2 {
        return Err(StatsError::TooFew { name: "participants", len: participants.len() as u64, needed: 2 });
    }
    check_replicates(replicates)?;
    let mut finite = |sample: &[&T]| statistic(sample).filter(|x| x.is_finite());
    let all: Vec<&T> = participants.iter().collect();
    let estimate = finite(&all).ok_or(StatsError::NoSolution {
        what: "the statistic",
        reason: "it is undefined on the sample itself",
    })?;

    let mut sample = all.clone();
    let mut values = Vec::with_capacity(replicates);
    for replicate in 0..replicates {
        let mut random = Random::stream(seed, replicate as u64);
        for slot in &mut sample {
            *slot = &participants[random.below(participants.len())];
        }
        values.extend(finite(&sample));
    }
    let undefined = replicates - values.len();
    if values.len() * 2 < replicates {
        return Err(StatsError::NoSolution {
            what: "the bootstrap interval",
            reason: "the statistic is undefined on more than half of the resamples",
        });
    }
    values.sort_by(f64::total_cmp);
    if values[0] == values[values.len() - 1] {
        return Err(StatsError::NoSolution {
            what: "the bootstrap interval",
            reason: "all resamples agree, which tells how few participants there are and not how far others would differ",
        });
    }

    let tail = (1.0 - level) / 2.0;
    let at = |low: f64, high: f64| (quantile(&values, low), quantile(&values, high));
    let (low, high) = match method {
        BootstrapMethod::Percentile => at(tail, 1.0 - tail),
        BootstrapMethod::Symmetric => {
            let n = participants.len() as f64;
            let reach = normal::t_quantile(1.0 - tail, n - 1.0) * (n / (n - 1.0)).sqrt();
            let mut distances: Vec<f64> = values.iter().map(|x| (x - estimate).abs()).collect();
            distances.sort_by(f64::total_cmp);
            let half = quantile(&distances, 1.0 - 2.0 * normal::cdf(-reach));
            (estimate - half, estimate + half)
        }
        BootstrapMethod::BiasCorrected => {
            let jackknife: Vec<f64> = (0..participants.len())
                .filter_map(|out| {
                    let rest: Vec<&T> =
                        all.iter().enumerate().filter(|&(i, _)| i != out).map(|(_, x)| *x).collect();
                    finite(&rest)
                })
                .collect();
            let (low, high) = corrected_tails(&values, estimate, &jackknife, tail);
            at(low, high)
        }
    };
    Ok(Bootstrap {
        estimate,
        low,
        high,
        level,
        standard_error: standard_deviation(&values),
        replicates,
        undefined,
        seed,
        method,
    })
}

fn check_replicates(replicates: usize) -> Result<()> {
    if replicates < MIN_REPLICATES {
        let rule = "must be at least 2000";
        return Err(StatsError::Invalid { name: "replicates", value: replicates as f64, rule });
    }
    Ok(())
}

/// The probabilities at which BCa reads the replicates.
fn corrected_tails(sorted: &[f64], estimate: f64, jackknife: &[f64], tail: f64) -> (f64, f64) {
    let n = sorted.len() as f64;
    // Ties count half, so that a discrete statistic isn't called biased.
    let below = sorted.partition_point(|&x| x < estimate) as f64;
    let upto = sorted.partition_point(|&x| x <= estimate) as f64;
    let share = ((below + upto) / (2.0 * n)).clamp(0.5 / n, 1.0 - 0.5 / n);
    let bias = normal::quantile(share);
    let mean = jackknife.iter().sum::<f64>() / jackknife.len().max(1) as f64;
    let (cubes, squares) = jackknife.iter().fold((0.0, 0.0), |(c, s), x| {
        let d = mean - x;
        (c + d * d * d, s + d * d)
    });
    let acceleration = if squares > 0.0 { cubes / (6.0 * squares.powf(1.5)) } else { 0.0 };
    let at = |z: f64| normal::cdf(bias + (bias + z) / (1.0 - acceleration * (bias + z)));
    let z = normal::quantile(tail);
    (at(z), at(-z))
}

/// The p-quantile of sorted values (R's type 7).
pub(crate) fn quantile(sorted: &[f64], p: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let at = p.clamp(0.0, 1.0) * last as f64;
    let i = (at.floor() as usize).min(last);
    let next = sorted[(i + 1).min(last)];
    sorted[i] + (at - i as f64) * (next - sorted[i])
}

fn standard_deviation(values: &[f64]) -> f64 {
    if values.len() < 2 {
        return 0.0;
    }
    let n = values.len() as f64;
    let mean = values[0] + values.iter().map(|x| x - values[0]).sum::<f64>() / n;
    (values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt()
}
