//! What the answers of a study add up to: the paper's test, block by block.

use crate::answers::{Participant, compares, conditions, tallies};
use crate::definition::{Kind, StudyDefinition};
use crate::trials::TrialName;
use kelir_stats::inference::t_test_from_counts;
use kelir_stats::pairwise::{Scale, ScaleOptions, Wins, scale};
use serde::Serialize;
use std::collections::BTreeMap;
use utoipa::ToSchema;

/// A block's choices of the target per participant, and the paper's two-tailed one-sample t-test of them.
///
/// Who counts: participants who answered *all* of the block's pairs, whether or not they went on to finish the study.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct BlockSummary {
    /// Block's id.
    pub id: String,
    /// Block's title.
    pub title: String,
    /// How its trials ask.
    pub trial: TrialName,
    /// How the two pictures of its trials stand to each other, in words.
    pub layout: String,
    /// Stills or animations.
    pub kind: Kind,
    /// The two conditions.
    pub conditions: [String; 2],
    /// The condition whose choices are counted.
    pub target: String,
    /// Number of items.
    pub items: usize,
    /// Participants who answered all items, or went to the end of an adaptive procedure.
    pub n: u64,
    /// Participants who answered some but not all, left out.
    pub incomplete: u64,
    /// Number of target choices → number of participants, from 0 to `items`; empty for an adaptive block.
    pub counts: BTreeMap<u32, u64>,
    /// Mean number of target choices; null when n = 0.
    pub mean: Option<f64>,
    /// Sample standard deviation (n − 1); null when n < 2.
    pub sd: Option<f64>,
    /// Expected number of someone who cannot tell: half the pairs.
    pub mu: f64,
    /// (mean − mu) / (sd / √n); null when n < 2 or sd = 0.
    pub t: Option<f64>,
    /// Degrees of freedom n − 1; null when n < 2.
    pub df: Option<f64>,
    /// Two-sided p; null where t is.
    pub p: Option<f64>,
    /// Why a number is null.
    pub note: Option<String>,
}

/// Summaries of every block but catch blocks, in study order.
pub fn summarise(study: &StudyDefinition, participants: &[&Participant]) -> Vec<BlockSummary> {
    study
        .blocks
        .iter()
        .zip(tallies(study, participants))
        .filter(|(block, _)| !block.catch)
        .map(|(block, tally)| {
            let counts: BTreeMap<u32, u64> = (0..).zip(tally.complete).collect();
            let test = match block.adaptive {
                None => TTest::of_counts(&counts, block.mu()),
                Some(_) => TTest { n: tally.finished, note: Some(STEERED.to_owned()), ..TTest::default() },
            };
            BlockSummary {
                id: block.id.clone(),
                title: block.title.clone(),
                trial: block.trial.rules().name(),
                layout: block.trial.rules().layout().to_owned(),
                kind: block.kind,
                conditions: block.conditions.clone(),
                target: block.target.clone(),
                items: block.items.len(),
                n: test.n,
                incomplete: tally.incomplete,
                counts,
                mean: test.mean,
                sd: test.sd,
                mu: block.mu(),
                t: test.t,
                df: test.df,
                p: test.p,
                note: test.note,
            }
        })
        .collect()
}

/// All conditions on one axis in JOD, by maximum likelihood; its standard errors take the choices as independent, so that a report
/// resamples participants instead.
///
/// # Errors
/// Why there is no scale, as a sentence.
pub fn conditions_scale(study: &StudyDefinition, participants: &[&Participant]) -> Result<Scale, String> {
    let names = conditions(study);
    if names.len() < 3 {
        return Err(TOO_FEW_CONDITIONS.to_owned());
    }
    let place = |name: &str| names.iter().position(|known| known == name).unwrap_or_default();
    let mut wins = Wins::new(names.len());
    let compared = study.blocks.iter().zip(tallies(study, participants)).filter(|(block, _)| compares(block));
    compared
        .into_iter()
        .try_for_each(|(block, tally)| {
            let (target, other) = (place(&block.target), place(block.other()));
            wins.add(target, other, tally.hits)?;
            wins.add(other, target, tally.trials - tally.hits)
        })
        .and_then(|()| scale(&names, &wins, ScaleOptions::default()))
        .map_err(|error| format!("No scale: {error}."))
}

/// Why an adaptive block has no test of its counts.
pub(crate) const STEERED: &str =
    "the procedure steers how often the target is chosen: see the psychometric function";

/// Why two conditions have no scale.
pub(crate) const TOO_FEW_CONDITIONS: &str =
    "A scale needs three conditions; two are compared by their proportion.";

/// A two-tailed one-sample t-test of a table of counts; a number that is not defined is `None` and the note says why.
#[derive(Clone, Debug, Default, PartialEq, Serialize, ToSchema)]
pub struct TTest {
    /// Observations.
    pub n: u64,
    /// Their mean.
    pub mean: Option<f64>,
    /// Sample standard deviation (n − 1).
    pub sd: Option<f64>,
    /// (mean − mu) / (sd / √n).
    pub t: Option<f64>,
    /// n − 1.
    pub df: Option<f64>,
    /// Two-sided p.
    pub p: Option<f64>,
    /// Why a number is missing.
    pub note: Option<String>,
}

impl TTest {
    /// The test of `value → how many observations have it` against `mu`.
    pub fn of_counts(counts: &BTreeMap<u32, u64>, mu: f64) -> TTest {
        let table: Vec<(f64, u64)> = counts.iter().map(|(x, k)| (f64::from(*x), *k)).collect();
        if let Ok(test) = t_test_from_counts(&table, mu) {
            let (mean, sd) = (Some(test.mean), Some(test.sd));
            return TTest {
                n: test.n,
                mean,
                sd,
                t: Some(test.t),
                df: Some(test.df),
                p: Some(test.p),
                note: None,
            };
        }
        // What has no t still has what can be said of it.
        let n: u64 = counts.values().sum();
        let sum: u64 = counts.iter().map(|(x, k)| u64::from(*x) * k).sum();
        let mean = (n > 0).then(|| sum as f64 / n as f64);
        let (sd, note) = match n {
            0 => (None, "of the participants who are judged, none answered all pairs"),
            1 => (None, "one participant alone has no standard deviation"),
            _ => (Some(0.0), "all participants chose the same number: t is not defined"),
        };
        let df = (n > 1).then(|| (n - 1) as f64);
        TTest { n, mean, sd, t: None, df, p: None, note: Some(note.to_owned()) }
    }
}

#[cfg(test)]
mod tests;
