//! Simulated observers: what a design finds, how often, and how well its intervals cover.
//!
//! Every simulation draws observers from stated truths, runs the crate's own analysis on their answers, and counts. [`rate`] is the loop for any
//! other design; [`preference_power`], [`threshold_precision`] and [`scale_power`] are the three of this field, and [`coverage`](fn@coverage) holds every interval
//! of a report to its truth. Deterministic for a seed.

mod coverage;
mod preference;
mod scaling;
#[cfg(test)]
mod tests;
mod threshold;

pub use coverage::{CELLS, Coverage, CoverageCell, Shown, coverage, shortfalls};
pub use preference::{PreferenceDesign, PreferencePower, participants_needed, preference_power};
pub use scaling::{ScaleDesign, ScalePower, scale_power};
pub use threshold::{ThresholdDesign, ThresholdPrecision, threshold_precision};

use crate::normal;
use crate::random::Random;
use crate::{Result, StatsError};
use serde::{Deserialize, Serialize};
use utoipa::ToSchema;

/// A proportion of simulated studies, with the simulation's own uncertainty.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, ToSchema)]
pub struct Rate {
    /// hits / runs.
    pub rate: f64,
    /// Lower end of its 95% Wilson interval.
    pub low: f64,
    /// Upper end.
    pub high: f64,
    /// Studies in which it happened.
    pub hits: u64,
    /// Studies in which it could be told.
    pub runs: u64,
    /// Studies whose analysis was undefined (everybody alike, say), not counted.
    pub undefined: u64,
}

impl Rate {
    /// The rate of `hits` ≤ `runs` in `runs` simulated studies that could be told and `undefined` that couldn't; 0 in [0, 1] for no runs.
    pub fn new(hits: u64, runs: u64, undefined: u64) -> Self {
        let n = runs as f64;
        if runs == 0 {
            return Self { rate: 0.0, low: 0.0, high: 1.0, hits, runs, undefined };
        }
        let p = hits as f64 / n;
        let z2 = normal::quantile(0.975).powi(2);
        let centre = (p + z2 / (2.0 * n)) / (1.0 + z2 / n);
        let half = (z2 * (p * (1.0 - p) / n + z2 / (4.0 * n * n))).sqrt() / (1.0 + z2 / n);
        let (low, high) = ((centre - half).max(0.0), (centre + half).min(1.0));
        Self { rate: p, low, high, hits, runs, undefined }
    }

    /// Adds up what happened; `None` is undefined.
    fn of(outcomes: impl IntoIterator<Item = Option<bool>>) -> Self {
        let (mut hits, mut runs, mut undefined) = (0, 0, 0);
        for outcome in outcomes {
            match outcome {
                Some(hit) => {
                    runs += 1;
                    hits += u64::from(hit);
                }
                None => undefined += 1,
            }
        }
        Self::new(hits, runs, undefined)
    }
}

/// How often `study` says yes over `runs` simulated studies, each with its own stream of `seed`; `None` is an undefined analysis.
///
/// Errors: no runs.
pub fn rate(runs: u64, seed: u64, mut study: impl FnMut(&mut Random) -> Option<bool>) -> Result<Rate> {
    check_runs(runs)?;
    Ok(Rate::of((0..runs).map(|run| study(&mut Random::stream(seed, run)))))
}

fn check_runs(runs: u64) -> Result<()> {
    if runs == 0 { Err(StatsError::TooFew { name: "runs", len: 0, needed: 1 }) } else { Ok(()) }
}

fn at_least(name: &'static str, value: u64, needed: u64) -> Result<()> {
    if value < needed { Err(StatsError::TooFew { name, len: value, needed }) } else { Ok(()) }
}

/// Simulated one by one, so there is an end to how many.
fn at_most_a_million(name: &'static str, value: u64) -> Result<()> {
    let rule = "must not exceed a million";
    if value > 1_000_000 { Err(StatsError::Invalid { name, value: value as f64, rule }) } else { Ok(()) }
}
