//! Intervals of a scale from resampled observers.

use super::scale::{fit, positions};
use super::{Estimator, Observer, Scale, ScaleOptions, graph, pool, scale};
use crate::clustered::{check_replicates, quantile, standard_deviation};
use crate::random::Random;
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// A scale with what its observers' differences do to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ScaleIntervals {
    /// The scale of all observers.
    pub scale: Scale,
    /// One interval a condition, in the scale's order.
    pub conditions: Vec<ConditionInterval>,
    /// One interval a pair of conditions: read significance here, not from overlaps above.
    pub differences: Vec<DifferenceInterval>,
    /// Confidence level.
    pub level: f64,
    /// Resamples drawn.
    pub replicates: usize,
    /// Resamples whose comparisons fell apart, left out.
    pub undefined: usize,
    /// Resamples that were separated and so fitted with Jeffreys' prior.
    pub penalised: usize,
    /// Observers with choices.
    pub observers: usize,
    /// The seed that repeats it.
    pub seed: u64,
}

/// A condition's percentile interval, in JOD.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ConditionInterval {
    /// Its name.
    pub condition: String,
    /// Position.
    pub jod: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Standard deviation of the replicates.
    pub standard_error: f64,
}

/// The percentile interval of a difference of two conditions, in JOD.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct DifferenceInterval {
    /// The condition subtracted from.
    pub a: String,
    /// The condition subtracted.
    pub b: String,
    /// a − b.
    pub jod: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Two-sided achieved level of "no difference": (1 + twice the smaller share of replicates on one side of 0)/(1 + replicates), uncorrected
    /// for the number of pairs.
    pub p: f64,
}

/// Scales the pooled choices and resamples observers with replacement for the intervals; deterministic for a seed.
///
/// Errors: those of [`scale`](fn@scale); fewer than two observers with choices; fewer than 2,000 replicates; a level outside (0, 1);
/// more than half of the resamples falling apart.
pub fn observer_intervals(
    names: &[String],
    observers: &[Observer],
    options: ScaleOptions,
    replicates: usize,
    level: f64,
    seed: u64,
) -> Result<ScaleIntervals> {
    StatsError::open_probability("level", level)?;
    check_replicates(replicates)?;
    let n = names.len();
    let answered: Vec<&Observer> =
        observers.iter().filter(|o| o.choices.iter().any(|c| c.times > 0)).collect();
    let whole = scale(names, &pool(n, answered.iter().copied())?, options)?;
    if answered.len() < 2 {
        return Err(StatsError::TooFew { name: "observers", len: answered.len() as u64, needed: 2 });
    }
    // From the whole's scale a resample's is two or three Newton steps away.
    let start: Vec<f64> = whole.jod[1..].iter().map(|x| (x - whole.jod[0]) / options.model.jod()).collect();

    let mut values = vec![Vec::with_capacity(replicates); n];
    let (mut undefined, mut penalised) = (0, 0);
    for replicate in 0..replicates {
        let mut random = Random::stream(seed, replicate as u64);
        let drawn = (0..answered.len()).map(|_| answered[random.below(answered.len())]);
        let wins = pool(n, drawn)?;
        let estimator = match options.estimator {
            Estimator::Jeffreys => Estimator::Jeffreys,
            _ if graph::unbeaten(&wins).is_none() => Estimator::MaximumLikelihood,
            _ => Estimator::Jeffreys,
        };
        if graph::components(&wins).len() > 1 {
            undefined += 1;
            continue;
        }
        penalised += usize::from(estimator == Estimator::Jeffreys);
        let Ok(found) = fit(&wins, options.model, estimator, &start) else {
            undefined += 1;
            continue;
        };
        for (values, x) in values.iter_mut().zip(positions(&found.at, options.model, options.origin)) {
            values.push(x);
        }
    }
    if undefined * 2 > replicates {
        return Err(StatsError::NoSolution {
            what: "the observers' intervals",
            reason: "most resamples of observers leave conditions without a link",
        });
    }

    let tail = (1.0 - level) / 2.0;
    let interval = |mut v: Vec<f64>| {
        v.sort_by(f64::total_cmp);
        (quantile(&v, tail), quantile(&v, 1.0 - tail))
    };
    let mut differences = Vec::new();
    for a in 0..n {
        for b in a + 1..n {
            let d: Vec<f64> = values[a].iter().zip(&values[b]).map(|(x, y)| x - y).collect();
            let above = d.iter().filter(|x| **x >= 0.0).count();
            let below = d.iter().filter(|x| **x <= 0.0).count();
            let p = (1.0 + 2.0 * above.min(below) as f64) / (1.0 + d.len() as f64);
            let (low, high) = interval(d);
            differences.push(DifferenceInterval {
                a: names[a].clone(),
                b: names[b].clone(),
                jod: whole.jod[a] - whole.jod[b],
                low,
                high,
                p: p.min(1.0),
            });
        }
    }
    let conditions = (0..n)
        .map(|i| {
            let standard_error = standard_deviation(&values[i]);
            let (low, high) = interval(values[i].clone());
            ConditionInterval { condition: names[i].clone(), jod: whole.jod[i], low, high, standard_error }
        })
        .collect();
    Ok(ScaleIntervals {
        scale: whole,
        conditions,
        differences,
        level,
        replicates,
        undefined,
        penalised,
        observers: answered.len(),
        seed,
    })
}
