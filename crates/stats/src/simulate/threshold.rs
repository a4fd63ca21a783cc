//! How well thresholds are measured.

use super::{Rate, at_least, at_most_a_million, check_runs};
use crate::psychometric::{Curve, Level, Task, profile_intervals};
use crate::random::Random;
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Observers measured by the method of constant stimuli.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ThresholdDesign {
    /// The true curve of the average observer (its lapse rate and η included).
    pub curve: Curve,
    /// Standard deviation of observers' true thresholds, in the unit of x.
    #[serde(default)]
    pub threshold_sd: f64,
    /// The stimuli.
    pub levels: Vec<f64>,
    /// Trials at each.
    pub trials: u64,
    /// The curve that is fitted.
    #[serde(default)]
    pub task: Task,
    /// Confidence level of each observer's profile-likelihood interval.
    #[serde(default = "ninety_five")]
    pub level: f64,
}

fn ninety_five() -> f64 {
    0.95
}

/// How the estimated thresholds (unscaled, F = ½) lie around the true ones.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ThresholdPrecision {
    /// Mean error, in the unit of x.
    pub bias: f64,
    /// Standard deviation of the error.
    pub error_sd: f64,
    /// How often an observer's interval holds their true threshold; an open end holds everything on its side.
    pub coverage: Rate,
    /// Mean width of the intervals that are closed on both sides; `None` if none is.
    pub mean_interval: Option<f64>,
    /// Observers whose threshold or width ended on the edge of its range or is any number: their levels did not show the
    /// curve.
    pub at_bound: u64,
    /// Standard error of the mean threshold of n observers is this divided by √n: error and observers' differences together.
    pub sd_of_one_observer: f64,
}

/// Simulates `observers` observers and fits each. Errors: fewer than two levels, no trials, a fit's invalid task, no observers.
pub fn threshold_precision(
    design: &ThresholdDesign,
    observers: u64,
    seed: u64,
) -> Result<ThresholdPrecision> {
    check_runs(observers)?;
    at_least("trials", design.trials, 1)?;
    at_most_a_million("trials", design.trials)?;
    StatsError::finite("threshold_sd", design.threshold_sd)?;
    StatsError::positive("curve.width", design.curve.width)?;
    for (name, value) in [("curve.lapse", design.curve.lapse), ("curve.eta", design.curve.eta)] {
        StatsError::probability(name, value)?;
    }
    let (mut errors, mut inside, mut widths, mut at_bound) = (Vec::new(), Vec::new(), Vec::new(), 0);
    for observer in 0..observers {
        let mut random = Random::stream(seed, observer);
        let truth = design.curve.threshold + design.threshold_sd * random.normal();
        let curve = Curve { threshold: truth, ..design.curve };
        let levels: Vec<Level> = design
            .levels
            .iter()
            .map(|&x| {
                let p = random.beta(curve.proportion(x), curve.eta.powi(2));
                Level { x, correct: random.binomial(design.trials, p), trials: design.trials }
            })
            .collect();
        let found = match profile_intervals(&levels, &design.task, design.level) {
            Err(StatsError::NotConverged { .. }) => {
                inside.push(None);
                continue;
            }
            found => found?,
        };
        let bound = found.fit.at_bound.iter().any(|name| name == "threshold" || name == "width");
        at_bound += u64::from(bound || found.fit.standard_errors[0].is_none());
        errors.push(found.fit.curve.threshold - truth);
        let t = found.threshold;
        inside.push(Some(t.low.is_none_or(|low| low <= truth) && t.high.is_none_or(|high| truth <= high)));
        widths.extend(t.low.zip(t.high).map(|(low, high)| high - low));
    }
    let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len().max(1) as f64;
    let bias = mean(&errors);
    let variance = errors.iter().map(|e| (e - bias).powi(2)).sum::<f64>() / (errors.len().max(2) - 1) as f64;
    Ok(ThresholdPrecision {
        bias,
        error_sd: variance.sqrt(),
        coverage: Rate::of(inside),
        mean_interval: (!widths.is_empty()).then(|| mean(&widths)),
        at_bound,
        sd_of_one_observer: (variance + design.threshold_sd.powi(2)).sqrt(),
    })
}
