//! How often a difference on a scale is found.

use super::{Rate, at_least, at_most_a_million, check_runs};
use crate::pairwise::{Choice, Observer, ScaleOptions, observer_intervals};
use crate::random::Random;
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// Observers who judge every pair of conditions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
#[serde(deny_unknown_fields)]
pub struct ScaleDesign {
    /// The conditions' true positions, in JOD.
    pub jod: Vec<f64>,
    /// Standard deviation of an observer's own position of each condition about these, in JOD.
    #[serde(default)]
    pub observer_sd: f64,
    /// Observers.
    pub observers: u64,
    /// Times each observer judges each pair.
    pub repeats: u64,
    /// How the scale is fitted.
    #[serde(default)]
    pub options: ScaleOptions,
    /// Confidence level of the differences' intervals.
    #[serde(default = "ninety_five")]
    pub level: f64,
}

fn ninety_five() -> f64 {
    0.95
}

/// What the design shows of its conditions' differences.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct ScalePower {
    /// For each pair (i < j, row by row) how often the sign-flip test finds it at the level 1 − `level`.
    pub found: Vec<Rate>,
    /// How often an interval holds the true difference, over all pairs of all studies that have one. With `observer_sd` > 0 the truth of the pooled scale is
    /// slightly shrunk, which counts against it.
    pub coverage: Rate,
}

/// Random patterns of signs in each simulated study.
const FLIPS: usize = 1999;

/// Simulates `runs` studies. Errors: fewer than two conditions or observers, no repeats, positions
/// that aren't finite, no runs.
pub fn scale_power(design: &ScaleDesign, runs: u64, seed: u64) -> Result<ScalePower> {
    check_runs(runs)?;
    at_least("jod", design.jod.len() as u64, 2)?;
    at_least("observers", design.observers, 2)?;
    at_least("repeats", design.repeats, 1)?;
    at_most_a_million("repeats", design.repeats)?;
    at_most_a_million("observers", design.observers)?;
    StatsError::finite("observer_sd", design.observer_sd)?;
    for &x in &design.jod {
        StatsError::finite("jod", x)?;
    }
    let n = design.jod.len();
    let names: Vec<String> = (0..n).map(|i| i.to_string()).collect();
    let pairs: Vec<(usize, usize)> = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))).collect();
    let mut found = vec![Vec::new(); pairs.len()];
    let mut inside = Vec::new();
    for run in 0..runs {
        let mut random = Random::stream(seed, run);
        let observers: Vec<Observer> =
            (0..design.observers).map(|o| observe(design, &pairs, o, &mut random)).collect();
        let Ok(result) = observer_intervals(&names, &observers, design.options, FLIPS, design.level, run)
        else {
            found.iter_mut().for_each(|f| f.push(None));
            inside.extend(pairs.iter().map(|_| None));
            continue;
        };
        for ((found, d), &(i, j)) in found.iter_mut().zip(&result.differences).zip(&pairs) {
            let truth = design.jod[i] - design.jod[j];
            found.push(Some(d.p < 1.0 - design.level));
            inside.push(d.low.zip(d.high).map(|(low, high)| low <= truth && truth <= high));
        }
    }
    Ok(ScalePower { found: found.into_iter().map(Rate::of).collect(), coverage: Rate::of(inside) })
}

fn observe(design: &ScaleDesign, pairs: &[(usize, usize)], index: u64, random: &mut Random) -> Observer {
    let own: Vec<f64> = design.jod.iter().map(|x| x + design.observer_sd * random.normal()).collect();
    let mut choices = Vec::with_capacity(2 * pairs.len());
    for &(i, j) in pairs {
        let p = design.options.model.probability(own[i] - own[j]);
        let won = random.binomial(design.repeats, p);
        choices.push(Choice { winner: i, loser: j, times: won });
        choices.push(Choice { winner: j, loser: i, times: design.repeats - won });
    }
    Observer { id: index.to_string(), choices }
}
